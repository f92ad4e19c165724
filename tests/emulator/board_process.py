"""The emulated board as a process of its own, in real time, on a pseudo-terminal: to pull, kill and crash computers at.

    with BoardProcess(folder) as board:                    # or by hand: python -m tests.emulator.board_process --help
        serial.Serial(board.port, 500000, timeout=0.1)     # board.port: path of a link to the pseudo-terminal
        board.changes()                                    # every change at the pins so far, oldest first

Opening the port resets the board, as on a real Mega. Each change of the pins is one line of the log, stamped with the
system's monotonic clock (time.monotonic(), the same in all processes) when it was seen.
"""

import argparse
import contextlib
import ctypes
import json
import os
import pty
import select
import subprocess
import sys
import time
import tty
from pathlib import Path
from typing import NamedTuple

from tests.emulator.build import firmware
from tests.emulator.mega import Pins
from tests.emulator.virtual import VirtualBoard

_PAUSE, _BUSY_PAUSE, _BUSY = 200e-6, 20e-6, 3e-3  # s between two looks at the clock; the same soon after a command
_SET_TIMER_SLACK = 29  # of prctl
_LATE = 0.05  # s: so late the board gives the lost time up instead of racing after it


class Change(NamedTuple):
    """monotonic: s, time.monotonic() when seen; seconds: the board's own time since power-on; pins: Pins;
    received: s of the board's own time, when it was last sent something."""

    monotonic: float
    seconds: float
    pins: Pins
    received: float


class BoardProcess:
    """Starts and ends the process. plant: "held" or "simulated" (the IR50P's SimulatedArm); boot: s the boot loader takes."""

    def __init__(self, folder, *, plant="held", boot=0.0):
        self.port, self.log = str(Path(folder, "ttyBOARD")), Path(folder, "pins.jsonl")
        self._options = ["--link", self.port, "--log", str(self.log), "--plant", plant, "--boot", str(boot)]

    def __enter__(self):
        firmware()  # compile before the clock runs; skips where the compiler is absent
        command = [sys.executable, "-m", "tests.emulator.board_process", *self._options]
        root = Path(__file__).parents[2]
        self.process = subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, text=True)
        if not self.process.stdout.readline().startswith("ready"):
            self.__exit__()
            raise RuntimeError("the emulated board did not start")
        return self

    def __exit__(self, *_):
        """Also what pulling the cable looks like: the port is gone."""
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def changes(self):
        """The Changes so far, oldest first."""
        lines = self.log.read_text().splitlines()
        return [Change(t, seconds, Pins(*pins), received) for t, seconds, pins, received in map(json.loads, lines)]

    def wait_until_off(self, timeout=5.0):
        """The Change after which no bridge drives."""
        until = time.monotonic() + timeout
        while any((last := self.changes()[-1]).pins.pwm):
            if time.monotonic() > until:
                raise TimeoutError(f"the bridges still drive after {timeout} s: {last.pins.pwm}")
            time.sleep(0.01)
        return last

    def cut_after_last_command(self):
        """Seconds of the board's own time from the last command to the cut; waits for it. No busy computer stretches it."""
        last = self.wait_until_off()
        if not any(any(change.pins.pwm) for change in self.changes()):
            raise ValueError("the bridges never drove: there was nothing to cut")
        return last.seconds - last.received


def _open_terminal(link):
    master, slave = pty.openpty()
    tty.setraw(slave)
    name = os.ttyname(slave)
    os.close(slave)
    os.set_blocking(master, False)
    with contextlib.suppress(FileNotFoundError):
        os.unlink(link)
    os.symlink(name, link)
    return master


def serve(board, link, log, boot=0.0):
    """Run the board for ever: its virtual time follows the clock, its line is the pseudo-terminal."""
    master = _open_terminal(link)
    poller = select.poll()
    poller.register(master, select.POLLIN)
    board.timeout = 0
    board.sleep(0.01)  # the arm's compiled code is loaded now, not while somebody waits for an answer
    begin, logged, is_open, listens, came = time.monotonic() - board.now(), 0, False, 0.0, 0.0
    received = 0.0
    print("ready", link, flush=True)
    while True:
        now = time.monotonic()
        if now - begin - board.now() > _LATE:
            begin = now - board.now()
        board.sleep_until(now - begin)  # first up to the present: what comes in now must not arrive in the past
        for seconds, pins in board.changes[logged:]:
            os.write(log, (json.dumps([time.monotonic(), seconds, pins, received]) + "\n").encode())
        logged = len(board.changes)
        if data := board.read(board.in_waiting):
            with contextlib.suppress(OSError):  # full, or nobody there: lost, as on a wire
                if is_open:
                    os.write(master, data)
        events = dict(poller.poll(0)).get(master, 0)
        closed = bool(events & select.POLLHUP)
        if not closed and not is_open:
            board.reset()
            listens = now + boot
        is_open = not closed
        if events & select.POLLIN:
            with contextlib.suppress(OSError):
                data, came = os.read(master, 4096), now
                if is_open and now >= listens:
                    board.write(data)
                    received = board.now()
        if closed:
            time.sleep(_PAUSE)  # select would return at once
        else:
            select.select([master], [], [], _BUSY_PAUSE if now - came < _BUSY else _PAUSE)


def main():
    """See --help."""
    parser = argparse.ArgumentParser(description="The emulated board on a pseudo-terminal, in real time.")
    parser.add_argument("--link", default="ttyBOARD", help="path of the link to the port (default: ttyBOARD)")
    parser.add_argument("--log", default=os.devnull, help="file for the changes at the pins, one a line")
    parser.add_argument("--plant", choices=["held", "simulated"], default="simulated", help="what is behind the board")
    parser.add_argument("--boot", type=float, default=0.0, help="s that the boot loader takes after the port is opened")
    options = parser.parse_args()
    plant = None
    if options.plant == "simulated":
        from ir50p_lab.bench.simulated_arm import SimulatedArm
        from ir50p_lab.modelling.named_arms import IR50P

        plant = SimulatedArm(IR50P)
    with contextlib.suppress(OSError, AttributeError):  # Linux: wake when asked to, not up to 50 us later
        ctypes.CDLL(None).prctl(_SET_TIMER_SLACK, 1, 0, 0, 0)
    log = os.open(options.log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    with contextlib.suppress(KeyboardInterrupt):
        serve(VirtualBoard(plant), options.link, log, options.boot)


if __name__ == "__main__":
    main()
