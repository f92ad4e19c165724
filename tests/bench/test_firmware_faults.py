"""The gravest faults once more, with the compiled firmware in the emulator: what the pins of the board do.

Times are virtual: read from the emulated processor, the same in every run.
"""

import numpy as np
import pytest

from ir50p_lab.bench import SerialBench, protocol
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.errors import BoardLostError
from ir50p_lab.modelling import IR50P
from tests.emulator.virtual import VirtualBoard

REST = rest_pose(IR50P)
DRIVE = (60, -40, 20)
WATCHDOG = 0.001 * protocol.WATCHDOG_MS


@pytest.fixture
def board():
    return VirtualBoard(SimulatedArm(IR50P, q0=REST))


def bench_of(board):
    return SerialBench(board, arm=IR50P, clock=board, record_to=False)


def run_until(board, happen, at=20, seconds=2.0):
    """Drive until `happen` at a sample; returns the error and when the fault was."""
    with pytest.raises(BoardLostError) as caught, bench_of(board) as bench:
        for k, _ in enumerate(bench.run(seconds)):
            bench.drive(DRIVE)
            if k == at:
                board.sleep(0.002)
                assert_driving(board)
                when = board.now()
                happen()
    return str(caught.value), when


def assert_driving(board):
    np.testing.assert_allclose(board.pins().pwm, DRIVE, atol=0.6)


def off_since(board):
    """When the drive went off, s; it must be off now."""
    assert board.pins().pwm == (0, 0, 0)
    last = max(k for k, (_, pins) in enumerate(board.changes) if pins.pwm != (0, 0, 0))
    return board.changes[last + 1][0]


def test_cable_pulled(board):
    text, when = run_until(board, board.unplug)
    assert "is gone" in text
    assert board.now() - when < 0.02  # the student is told at once
    board.sleep(0.2)
    assert 0.9 * WATCHDOG < off_since(board) - when < 1.1 * WATCHDOG
    assert board.pins().enable == (1, 1, 1)  # the bridges brake


def test_board_reset_in_the_run(board):
    text, when = run_until(board, board.reset)
    assert "has restarted in the middle of the run" in text
    assert board.now() - when < 0.05
    assert off_since(board) - when < 1e-3
    board.sleep(0.3)
    assert board.pins().pwm == (0, 0, 0)
