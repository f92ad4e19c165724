"""One run of a bench: its cycles, each a sample, a command and a row of the recording; and what a pause leads to."""

import contextlib
from collections import namedtuple

import numpy as np

from ir50p_lab.bench.limits import checked_reference
from ir50p_lab.bench.pace import LONGEST_PAUSE, WATCHDOG, cut_said
from ir50p_lab.bench.protocol import JOINTS
from ir50p_lab.errors import BenchError, PauseError


class Sample(namedtuple("Sample", "t q counts missed reference", defaults=(None,))):
    """What the bench reports once per period.

    t: time of the measurement, s since the run began; q: (3,) rad, through the calibration; counts: (3,) counts of the
    10-bit converter (quarters of one if the board averages); missed: cycles that came late so far in this run;
    reference: (3, 3), what the run's reference asks for at t, rows q, qd, qdd in rad, rad/s, rad/s^2 (None without
    one).
    """


class Run:
    """Everything that belongs to one run.

    Args: bench: the Bench that it measures and drives; reference: target(t) or None.
    Attributes: recorder: Recorder or None; pace: Pace or CountedPace; guard: see `Bench._make_guard`; open_row: the
    Sample whose row is not written yet, because its command may still come; aim: its reference (3,); fault: what has
    ended the run; capped: whether the lab's caps hold (that of PWM always does); trips: how often the watchdog cut the
    drive.
    """

    recorder = pace = guard = open_row = aim = fault = None
    capped, trips = True, 0

    def __init__(self, bench, reference):
        self.bench, self.reference = bench, reference

    def next_sample(self, cycles):
        """Wait for the next cycle and measure. Returns the Sample, or None when the run is over."""
        bench, pace = self.bench, self.pace
        while True:
            self.write_row()  # of the sample before
            if pace.cycle + 1 >= cycles:
                return None
            cycle = pace.next_cycle()
            if self.paused(pace.silence()):
                continue
            if cycle >= cycles:
                return None
            t, counts, tripped = bench.measure(cycle, drive=pace.armed)
            pace.armed = pace.armed or cycle > 0
            if self.paused(WATCHDOG * tripped):  # commands were lost on the wire
                continue
            sample = self.open_row = bench.last = Sample(t, bench.radians(counts), counts, pace.missed)
            if self.guard is not None:
                self.guard.check(sample, bench.command)
            rows = None
            if self.reference is not None:
                rows = checked_reference(bench.arm, t, self.reference(t), sample.q if bench.answers else None)
                self.aim = rows[0].copy()
            if self.capped and bench.caps.source:
                bench.caps.check_cycle(self, sample.q, rows)
            return Sample(t, sample.q.copy(), counts.copy(), pace.missed, rows)  # may be written into

    def paused(self, silence):
        """Return True if the watchdog has cut the drive in this silence (s), after saying so and measuring again.

        Raises PauseError if the silence was too long: then the run has ended.
        """
        if silence < WATCHDOG:
            return False
        self.write_row()
        bench, pace = self.bench, self.pace
        when = pace.heard - silence + WATCHDOG - pace.start
        pace.catch_up()
        self.trips += 1
        said, ended = f"the drive was cut: no command for {silence:.2f} s", silence > LONGEST_PAUSE
        bench.note(said + "; the run was ended" * ended, when)
        bench.command = np.zeros(JOINTS)
        with contextlib.suppress(BenchError) if ended else contextlib.nullcontext():
            t, counts, _ = bench.measure(pace.cycle, drive=False)
            bench.last = self.open_row = Sample(t, bench.radians(counts), counts, pace.missed)
        if ended:
            paused = f"the program sent no command for {silence:.1f} s, from t = {when - WATCHDOG:.2f} s on"
            remedy = "start a new run, without plots or input in its loop, or use bench.start(...)"
            self.fault = PauseError(f"{paused}: {cut_said(bench.cut())}; {remedy}")
            raise self.fault
        if self.trips == 1:
            print(f"At t = {when:.2f} s {said}; the run goes on. Further cuts: bench.recording.events.")
        return True

    def write_row(self):
        """Record the last sample with the command that followed it."""
        sample, aim, self.open_row, self.aim = self.open_row, self.aim, None, None
        if sample is not None and self.recorder is not None:
            self.recorder.write(sample, self.bench.command, aim, self.bench.gripper)

    def end_recording(self):
        """Write the last row and close the recording; the run itself may go on."""
        try:
            self.write_row()
        except BaseException:  # a full disk; nobody may hear of it while a generator is closed
            self.bench.cut()
            raise
        finally:
            recorder, self.recorder = self.recorder, None
            if recorder is not None:
                recorder.close(self.bench.timing(self))
