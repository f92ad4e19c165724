"""The replay bench: a recording takes the part of the arm; your commands are kept, to compare with those sent then."""

import math
import os
import time

import numpy as np

from ir50p_lab.bench.base import Bench
from ir50p_lab.bench.calibration import JointCalibration
from ir50p_lab.bench.recording import Recording
from ir50p_lab.errors import InputError, RecordingError


class ReplayBench(Bench):
    """A bench whose samples are those of a recording; each run begins at its first sample.

    `drive` limits and records your command as on every bench, but it moves nothing: the samples are what followed from
    the recorded command. Compare `bench.recording.u` (yours) with `bench.original.u` (what was sent then). A run that
    asks for more than was recorded ends with the recording and says so.

    Args:
        recording: Recording, or the path of one.
        arm: Arm whose limits hold, default `load_arm()`. realtime: whether samples come at the recorded pace.
        record_to: folder for recordings of your commands; default: in memory only.

    Attributes: original: the Recording that is replayed.
    Raises RecordingError if the file is no recording, or has no sample; InputError if `recording` or `arm` is something
    else.
    """

    kind = "replay"
    answers = guarded = False  # the arm moved by another command

    def __init__(self, recording, *, arm=None, realtime=False, record_to=False, name=None):
        if isinstance(recording, str | os.PathLike):
            recording = Recording.load(recording)
        if not isinstance(recording, Recording):
            raise InputError(f"recording = {recording!r:.60}: give a Recording, or the path of one")
        if not len(recording):
            raise RecordingError(f"{recording!r} has no sample to replay: choose another recording")
        self.original, self.simulated, self.realtime = recording, recording.simulated, realtime
        origin = recording.path.name if recording.path else recording.header.get("bench", "data")
        name, calibration = name or f"replay of {origin}", _calibration(recording.header)
        period = recording.period if math.isfinite(recording.period) else 0.01  # one sample of unknown origin
        super().__init__(arm, calibration, period=period, record_to=record_to, name=name)
        counts = recording.counts
        self._counts = np.where(np.isfinite(counts), counts, self.calibration.counts(recording.q))
        self._late = np.nan_to_num(recording.missed).astype(int)
        bench_id = recording.header.get("bench_id", "none")
        self.bench_id = None if bench_id == "none" else bench_id

    def _begin(self):
        self._started = time.perf_counter()

    def _cycles(self, cycles, reference, record, header):
        there = min(cycles, len(self.original))
        yield from super()._cycles(there, reference, record, header)
        if there < cycles:
            print(f"The recording ends at t = {self.original.t[-1]:.2f} s, and with it this run.")

    def measure(self, cycle, drive):
        """Return what was recorded in this cycle; see `Bench.measure`."""
        t = self.original.t
        self._q = self.original.q[cycle]
        if self.realtime:
            time.sleep(max(0.0, self._started + t[cycle] - t[0] - time.perf_counter()))
        self._run.pace.missed = int(self._late[cycle])
        return float(t[cycle]), self._counts[cycle], False

    def radians(self, counts):
        """Return the angles as they were recorded; see `Bench.radians`."""
        return self._q  # as it was recorded

    def _header(self):
        return {"original": str(self.original.path or "in memory")}

    def go_to_rest(self):
        """Do nothing: a recording cannot move."""


def _calibration(head):
    """The JointCalibration in the head of a recording; None if there is none."""
    try:
        slope, zero = head["counts_per_rad"].split(), head["counts_at_zero"].split()
        return JointCalibration(slope, zero, source=head.get("calibration", "of the recording"))
    except (KeyError, ValueError):  # an InputError is one, too
        return None
