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

OFF = ("has been cut", "was cut", "is off", "stays off")  # ways to say so


def fail(board, bench):
    raise ZeroDivisionError


def interrupt(board, bench):
    signal.raise_signal(signal.SIGINT)


def hold_joint(board, bench):
    board.plant = HeldArm(board.plant.counts())


def tear_a_wire(board, bench):
    board.plant = HeldArm((0, 512, 512))


def sleep_long(board, bench):
    board.sleep(2.0)


def command_nothing(board, bench):
    bench.drive((np.nan, 0, 0))


STOPS = [fail, interrupt, hold_joint, tear_a_wire, sleep_long, command_nothing, None]


class Wire:
    """An emulated board, and all frames that it was sent: `frames`, a list of (t, Command)."""

    def __init__(self):
        self.board = VirtualBoard(SimulatedArm(IR50P, q0=rest_pose(IR50P)))
        self.frames, self._parser, self.board.to_board = [], CommandParser(), self._on_the_way

    def _on_the_way(self, data):
        self.frames += [(self.board.now(), command) for command in self._parser.feed(data)]
        return data

    def run(self, stop, dead):
        """Drive until `stop` at a sample; dead: from then on no answer comes back. Returns what is said."""
        signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with SerialBench(self.board, arm=IR50P, clock=self.board, record_to=False) as bench:
                for k, _ in enumerate(bench.run(3.0)):
                    bench.drive((100, -10, 0))
                    if k == 20:
                        self.board.to_host = (lambda data: b"") if dead else bytes
                        if stop is None:  # the end of `with`
                            break
                        stop(self.board, bench)
        except (ZeroDivisionError, KeyboardInterrupt, BenchError, InputError) as error:
            return str(error)
        return ""


@pytest.mark.parametrize("dead", [False, True], ids=["answered", "unanswered"])
@pytest.mark.parametrize("stop", STOPS)
def test_the_last_frames_drive_nothing_and_off_is_said_after_the_echo(stop, dead):
    wire = Wire()
    said = wire.run(stop, dead)
    last = max(k for k, (_, frame) in enumerate(wire.frames) if frame.type == protocol.DRIVE and any(frame.pwm))
    count, after = len(wire.frames), wire.frames[last + 1 :]
    assert protocol.STOP in [frame.type for _, frame in after]
    wire.board.sleep(0.3)
    assert len(wire.frames) == count and wire.board.pins().pwm == (0, 0, 0)
    changes = wire.board.changes
    off, _ = changes[1 + max(k for k, (_, pins) in enumerate(changes) if any(pins.pwm))]
    assert off - wire.frames[last][0] < (0.110 if dead or stop is sleep_long else 0.013)
    assert not (dead and any(words in said for words in OFF)), said
    assert ("brakes by itself" in said) == (dead and stop not in (fail, interrupt)), said
