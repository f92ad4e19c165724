"""A smoke run in real time: SerialBench and pyserial on a pseudo-terminal, the emulated board in a process of its own.

What takes its time here is the clock itself; everything that can be tried on virtual time is in test_contract.py.
"""

import time

import numpy as np
import pytest

from ir50p_lab.bench import SerialBench, connect, serial_bench
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.controllers import PID
from ir50p_lab.errors import BoardLostError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold
from tests.emulator.board_process import BoardProcess

PUSH = (30, -30, 30)  # PWM counts: less than breaks a joint away, so the held arm is no runaway


@pytest.fixture
def board(tmp_path):
    with BoardProcess(tmp_path) as board:  # its arm is held: 512 counts, whatever it is told
        yield board


def bench_of(board, **options):
    return SerialBench(board.port, arm=IR50P, record_to=False, **options)


def test_the_loop_of_the_lesson_and_the_way_to_the_rest_pose(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("IR50P_ARM", raising=False)
    monkeypatch.setattr(serial_bench, "BOOT_LOADER", 0.0)  # the emulated board has none, and its arm would sink
    with BoardProcess(tmp_path, plant="simulated") as board:
        monkeypatch.setenv("IR50P_BENCH", board.port)
        pid = PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)
        target = hold([0.8, 1.57, -1.05])
        with connect(record_to=tmp_path) as bench:
            for sample in bench.run(seconds=3):
                bench.drive(pid.step(sample.t, sample.q, target(sample.t)))
            statistics = bench.statistics
        assert f"asked for by IR50P_BENCH={board.port}" in capsys.readouterr().out
        recording = bench.recording
        assert 2.8 < recording.t[-1] < 3.05  # a busy machine leaves cycles out: the run is no longer
        assert len(recording) + int(recording.header["late_cycles"]) >= 300
        assert statistics.bad_replies == 0
        np.testing.assert_allclose(recording.q[-1], [0.8, 1.2, -1.05], atol=0.5)
        board.cut_after_last_command()
        again = bench_of(board).open()  # opening restarts the board; the arm stays where it was left
        sample = next(again.run(0.1))
        again.abort()
        np.testing.assert_allclose(sample.q, rest_pose(IR50P), atol=0.3)


def test_an_error_in_the_body_cuts_at_once(board):
    with pytest.raises(ZeroDivisionError), bench_of(board) as bench:
        for k, _ in enumerate(bench.run(20)):
            bench.drive(PUSH)
            if k == 20:
                raise ZeroDivisionError
    assert board.cut_after_last_command() < 0.05  # the host's own command, long before the watchdog


def test_cable_pulled(board):
    with pytest.raises(BoardLostError, match=r"is gone|has not answered"), bench_of(board) as bench:
        for k, _ in enumerate(bench.run(20)):
            bench.drive(PUSH)
            if k == 20:
                when = time.monotonic()
                board.process.kill()
    assert time.monotonic() - when < 0.5
