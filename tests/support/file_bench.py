"""A bench whose arm is a file: every command is a line with its time, written at once, whoever dies next."""

import os
import time

import numpy as np

from ir50p_lab.bench.base import Bench
from ir50p_lab.bench.calibration import nominal_calibration
from ir50p_lab.bench.pace import Pace
from ir50p_lab.errors import PortError
from ir50p_lab.modelling.named_arms import IR50P


class FileBench(Bench):
    """Loops in the background get a process of their own, as on hardware; the arm follows slowly."""

    kind = "file"
    simulated = True

    def __init__(self, path, *, busy=False, period=0.01, record_to=False):
        super().__init__(IR50P, nominal_calibration(IR50P), period=period, record_to=record_to)
        self.path, self.busy, self._file, self._q = path, busy, None, np.array([0.1, 0.2, -0.3])

    def _arguments(self):
        return {"path": self.path, "busy": self.busy, "record_to": self.record_to}

    def _open(self):
        if self.busy and os.path.exists(self.path):
            raise PortError("the port is busy")
        self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        self._tell("open")

    def _tell(self, what):
        os.write(self._file, f"{time.monotonic()} {os.getpid()} {what}\n".encode())

    def _begin(self):
        pass

    def _make_pace(self):
        return Pace(self._clock, self.period)

    def measure(self, cycle, drive):
        self._q = self._q + 2e-4 * self.command
        return self._clock.now() - self._run.pace.start, self.calibration.counts(self._q), False

    def _send(self, pwm, gripper):
        self._tell("drive " + " ".join(f"{u:g}" for u in pwm))
        return pwm

    def _cut(self):
        if self._file is not None:
            self._tell("cut")

    def _close(self):
        if self._file is not None:
            os.close(self._file)
            self._file = None


def lines(path):
    """[(time, pid, words)] of such a file."""
    with open(path) as file:
        return [(float(t), int(pid), words) for t, pid, *words in map(str.split, file)]
