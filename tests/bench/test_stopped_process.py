"""A loop whose process is really stopped for 2 s, as by a debugger or a sleeping laptop, drives the emulated board."""

import contextlib
import os
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
from until import until

from ir50p_lab.bench import Recording, SerialBench
from ir50p_lab.errors import PauseError, PortError
from ir50p_lab.modelling import IR50P

pytest.importorskip("termios", reason="Windows has no pseudo-terminals")
from tests.emulator.board_process import BoardProcess

PUSH = 30.0  # PWM counts for joint 1: less than breaks it away, so a held arm is no runaway

NINE_LINES = """
    from ir50p_lab.bench import SerialBench
    from ir50p_lab.modelling import IR50P

    bench = SerialBench({port!r}, arm=IR50P, record_to={folder!r}).open()
    try:
        for k, sample in enumerate(bench.run(60)):
            bench.drive([{push}, 0, 0])
            if k == 50:
                print("drives:", bench.recording.path, flush=True)
    except Exception as error:
        print("ended:", type(error).__name__, flush=True)
    input()  # the bench stays open: nothing but the stop keeps the drive off
"""


IN_BACKGROUND = """
    import time
    import numpy as np
    from ir50p_lab.bench import SerialBench
    from ir50p_lab.modelling import IR50P

    class Push:
        def step(self, t, measured, reference):
            return np.array([{push}, 0, 0])

    run = SerialBench({port!r}, arm=IR50P, record_to={folder!r}).open().start(Push(), None)
    while run.statistics().cycles < 30:
        time.sleep(0.01)
    print("drives:", run._process.pid, flush=True)
    input()
"""


class Push:
    def step(self, t, measured, reference):
        return np.array([PUSH, 0.0, 0.0])


@pytest.fixture
def board(tmp_path):
    with BoardProcess(tmp_path) as board:
        yield board


def stop_for_two_seconds(process_id):
    """Stop the process and let it go on. Returns when it went on, s of the monotonic clock."""
    os.kill(process_id, signal.SIGSTOP)
    try:
        time.sleep(2.0)
    finally:
        woken = time.monotonic()
        os.kill(process_id, signal.SIGCONT)
    return woken


def said(cell, what):
    """What the cell printed after `what`; a busy machine prints of cuts before it."""
    return next(line for line in cell.stdout if line.startswith(what)).removeprefix(what).strip()


def assert_off_since(board, woken):
    before = [change for change in board.changes() if change.monotonic <= woken]
    assert any(any(change.pins.pwm) for change in before)
    assert not any(before[-1].pins.pwm)  # the board had cut
    assert not any(any(change.pins.pwm) for change in board.changes()[len(before) :])


def assert_recorded(recording):
    assert PUSH in recording.u[:-1, 0]
    assert recording.u[-1].tolist() == [0, 0, 0] and recording.t[-1] - recording.t[-2] > 1.9
    when, said = recording.events[-1]
    assert recording.t[-2] < when < recording.t[-1]
    assert "the drive was cut: no command for 2." in said and "the run was ended" in said


@contextlib.contextmanager
def cell_that_drives(board, folder, code=NINE_LINES):
    """The process of a notebook whose cell drives."""
    code = textwrap.dedent(code.format(port=board.port, folder=str(folder), push=PUSH))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", code], env=environment, **pipes) as cell:
        try:
            yield cell
        finally:
            cell.kill()


def test_a_stopped_cell_drives_nothing_when_it_goes_on(board, tmp_path):
    with cell_that_drives(board, tmp_path) as cell:
        path = said(cell, "drives: ")
        woken = stop_for_two_seconds(cell.pid)
        assert said(cell, "ended: ") == "PauseError"
        time.sleep(0.2)
        assert_off_since(board, woken)
        assert board.cut_after_last_command() < 0.110
    assert_recorded(Recording.load(path))


def test_a_kernel_killed_in_the_cell_leaves_the_drive_on_for_no_more_than_110_ms(board, tmp_path):
    with cell_that_drives(board, tmp_path) as cell:
        said(cell, "drives: ")
        cell.kill()
        assert board.cut_after_last_command() < 0.110


@pytest.mark.parametrize("victim", ["notebook", "loop"])
def test_a_loop_in_the_background_is_cut_when_it_or_its_notebook_is_killed(board, tmp_path, victim):
    with cell_that_drives(board, tmp_path, IN_BACKGROUND) as cell:
        loop = int(said(cell, "drives: "))
        until(lambda: any(board.changes()[-1].pins.pwm))
        os.kill(cell.pid if victim == "notebook" else loop, signal.SIGKILL)
        assert board.cut_after_last_command() < 0.110


def test_a_second_client_is_refused_and_changes_nothing(board, tmp_path):
    with cell_that_drives(board, tmp_path) as cell:
        said(cell, "drives: ")
        before = board.changes()
        with pytest.raises(PortError, match="busy"):
            SerialBench(board.port, arm=IR50P, record_to=False).open()
        time.sleep(0.3)
        assert board.changes() == before and any(before[-1].pins.pwm)
        cell.send_signal(signal.SIGINT)
        assert board.cut_after_last_command() < 0.110


def test_a_stopped_loop_in_the_background_drives_nothing_when_it_goes_on(board, tmp_path):
    bench = SerialBench(board.port, arm=IR50P, record_to=tmp_path).open()
    try:
        run = bench.start(Push(), None)
        while run.alive and run.statistics().cycles < 50:
            time.sleep(0.01)
        woken = stop_for_two_seconds(run._process.pid)
        with pytest.raises(PauseError, match=r"no command for 2\.\d s.*new run"):
            run.join(20)
        assert_off_since(board, woken)
        assert board.cut_after_last_command() < 0.110
        assert_recorded(run.recording)
    finally:
        bench.abort()
