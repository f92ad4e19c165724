"""After every kind of stop: what went over the wire to the emulated board, what its pins do, and what is said of it."""

import signal

import numpy as np
import pytest
from board_frames import CommandParser

from ir50p_lab.bench import SerialBench, protocol
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.modelling import IR50P
from tests.emulator.virtual import HeldArm, VirtualBoard

STOPS = {
    "error": lambda board, bench: 1 / 0,
    "Ctrl-C": lambda board, bench: signal.raise_signal(signal.SIGINT),
    "no number": lambda board, bench: bench.drive((np.nan, 0, 0)),
    "held joint": lambda board, bench: setattr(board, "plant", HeldArm(board.plant.counts())),  # the guard's
    "torn wire": lambda board, bench: setattr(board, "plant", HeldArm((0, 512, 512))),
    "pause": lambda board, bench: board.sleep(2.0),
    "end": None,
}


def drive_until(stop, board, dead):
    """Drive an emulated board until `stop`; dead: from then on no answer comes back. Returns what is said."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with SerialBench(board, arm=IR50P, clock=board, record_to=False) as bench:
            for k, _ in enumerate(bench.run(3.0)):
                bench.drive((100, -10, 0))
                if k == 20:
                    board.to_host = (lambda data: b"") if dead else bytes
                    if STOPS[stop] is None:
                        break
                    STOPS[stop](board, bench)
    except (ZeroDivisionError, KeyboardInterrupt, BenchError, InputError) as error:
        return str(error)
    return ""


@pytest.mark.parametrize("dead", [False, True], ids=["answered", "unanswered"])
@pytest.mark.parametrize("stop", STOPS)
def test_the_last_frames_drive_nothing_and_off_is_said_after_the_echo(stop, dead):
    board, parser, frames = VirtualBoard(SimulatedArm(IR50P, q0=rest_pose(IR50P))), CommandParser(), []
    board.to_board = lambda data: frames.extend((board.now(), frame) for frame in parser.feed(data)) or data
    said = drive_until(stop, board, dead)
    driven = [k for k, (_, frame) in enumerate(frames) if frame.type == protocol.DRIVE and any(frame.pwm)]
    after = [frame.type for _, frame in frames[driven[-1] + 1 :]]
    board.sleep(0.3)
    assert protocol.STOP in after and len(frames) == driven[-1] + 1 + len(after)
    assert board.pins().pwm == (0, 0, 0)
    on = [k for k, (_, pins) in enumerate(board.changes) if any(pins.pwm)]
    off, _ = board.changes[on[-1] + 1]
    assert off - frames[driven[-1]][0] < (0.110 if dead or stop == "pause" else 0.013)
    assert not (dead and any(words in said for words in ("has been cut", "was cut", "is off"))), said
    assert ("brakes by itself" in said) == (dead and stop not in ("error", "Ctrl-C")), said
