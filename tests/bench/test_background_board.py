"""The loop in the background on the emulated board: killing the notebook or the loop cuts the drive at the pins."""

import os
import signal
import subprocess
import sys
import textwrap

import pytest
from until import until

from tests.emulator.board_process import BoardProcess


@pytest.fixture
def board(tmp_path):
    with BoardProcess(tmp_path) as board:
        yield board


def driven(pins):
    """Whether a bridge drives: a cut brakes, with both inputs low."""
    return any(pins.pwm)


NOTEBOOK = """
    import time
    import numpy as np
    from ir50p_lab.bench import SerialBench
    from ir50p_lab.modelling import IR50P

    class Push:
        def step(self, t, measured, reference):
            return np.array([30.0, -30.0, 30.0])  # less than breaks a joint away: the held arm is no runaway

    bench = SerialBench({port!r}, arm=IR50P, record_to=False).open()
    run = bench.start(Push(), None)
    while run.statistics().cycles < 30:
        time.sleep(0.01)
    print(run._process.pid, flush=True)
    time.sleep(600)
"""


@pytest.mark.parametrize("victim", ["notebook", "loop"])
def test_a_kill_cuts_the_drive_within_110_ms(board, victim):
    code = textwrap.dedent(NOTEBOOK.format(port=board.port))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, env=environment) as notebook:
        try:
            loop = int(notebook.stdout.readline().split(b"\r")[-1])  # behind the line about the boot loader
            until(lambda: driven(board.changes()[-1].pins))
            os.kill(notebook.pid if victim == "notebook" else loop, signal.SIGKILL)
            cut = board.cut_after_last_command()
        finally:
            notebook.kill()
    print(f"{victim} killed: pins off {1e3 * cut:.1f} ms after the last command")
    assert cut < 0.110
