"""In real time, with pyserial, on a pseudo-terminal: a computer that is killed while it drives."""

import subprocess
import sys
import time
from pathlib import Path

import pytest
import serial

from ir50p_lab.bench.protocol import BAUD, HELLO_NEEDED, WATCHDOG_MS
from tests.emulator.talk import Talk

pytest.importorskip("termios", reason="Windows has no pseudo-terminals")
from tests.emulator.board_process import BoardProcess

ROOT = Path(__file__).parents[2]

DRIVER = """
import sys, time, serial
from ir50p_lab.bench.protocol import BAUD
from tests.emulator.talk import Talk
talk = Talk(serial.Serial(sys.argv[1], BAUD, timeout=0.1))
talk.hello()
print("driving", flush=True)
while True:
    talk.drive(150, -150, 150)
    time.sleep(0.008)
"""


@pytest.fixture
def board(tmp_path):
    with BoardProcess(tmp_path) as board:
        yield board


def greet(port):
    """The board resets when its port is opened: the first hello may come too early."""
    talk = Talk(port)
    for _ in range(20):
        if talk.hello():
            return talk
    raise AssertionError("no answer to hello")


def test_opening_the_port_resets_the_board(board):
    with serial.Serial(board.port, BAUD, timeout=0.2) as port:
        greet(port).drive(10, 10, 10)
    time.sleep(0.3)  # until the other side has surely seen it closed
    with serial.Serial(board.port, BAUD, timeout=0.2) as port:
        talk = Talk(port)
        reply = next(reply for reply in (talk.drive(1, 1, 1) for _ in range(20)) if reply)
        assert reply.status & HELLO_NEEDED


def test_a_killed_computer_lets_the_arm_brake_within_110_ms(board):
    driver = subprocess.Popen([sys.executable, "-c", DRIVER, board.port], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    try:
        assert driver.stdout.readline() == "driving\n"
        time.sleep(0.3)
    finally:
        driver.kill()
        driver.wait()
        driver.stdout.close()
    braked = board.cut_after_last_command()
    print(f"braked {1e3 * braked:.1f} ms after the last command")
    assert all(board.changes()[-1].pins.enable)
    assert braked < (WATCHDOG_MS + 10) / 1000
