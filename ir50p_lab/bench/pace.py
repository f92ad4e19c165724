"""The clock of a run: when each cycle is due, and how long the arm has heard nothing from the program."""

import contextlib
import gc
import time

import numpy as np

from ir50p_lab.errors import InputError

WATCHDOG = 0.1  # s without a command, after which the drive is cut: protocol.WATCHDOG_MS of the board
LONGEST_PAUSE = 0.5  # s: a longer time without a command ends the run, for later commands are out of date
_AWAKE = 0.001  # last part of each wait, s, spent polling the clock: a tenth of a processor at 100 Hz
_LATE = 0.2  # share of the period: a cycle that begins later than this counts as late
# a clock that goes on while a laptop sleeps (Linux, macOS; on Windows perf_counter does)
_SLEEPLESS = getattr(time, "CLOCK_BOOTTIME", getattr(time, "CLOCK_MONOTONIC", None))


class Clock:
    """The computer's clock, in s from an arbitrary start, and its sleep. In tests a virtual clock takes its place."""

    @staticmethod
    def now():
        """Return the time, s, which goes on while a laptop sleeps."""
        return time.perf_counter() if _SLEEPLESS is None else time.clock_gettime(_SLEEPLESS)

    @classmethod
    def sleep(cls, seconds):
        """Sleep, but stay awake in the last millisecond: other programs often make a sleeper wake late."""
        until = cls.now() + seconds
        if seconds > _AWAKE:
            time.sleep(seconds - _AWAKE)
        while cls.now() < until:
            pass


class CountedPace:
    """The cycles of a run whose time is a counter: nothing is ever late, and no pause matters. Used like `Pace`."""

    armed, missed, cycle = True, 0, -1

    def next_cycle(self):
        """Return the number of the next cycle."""
        self.cycle += 1
        return self.cycle

    def begins_anew(self):
        """Return False: counted time has no late beginning."""
        return False

    def silence(self):
        """Return 0 s: counted time knows no pause."""
        self.heard = time.perf_counter()
        return 0.0


class Pace:
    """The cycles of one run on a clock.

    Cycle k is due k periods after the start. One that would begin a whole period late is left out: the loop never runs
    to catch up, and a pause makes no run longer. Until the first command has been sent, the clock waits, because a
    program may have to compile in its first cycle.

    Attributes: start: when the run began; heard: when the arm last heard from the program, both in s on the clock;
    cycle: number of the last one; missed: cycles that came late or were left out; armed: whether a command was sent.
    """

    def __init__(self, clock, period):
        if period > 0.5 * WATCHDOG:
            raise InputError(f"period = {period} s: give {0.5 * WATCHDOG:g} s at most, the watchdog has {WATCHDOG:g} s")
        self._clock, self._period = clock, period
        self.start = self.heard = clock.now()
        self.cycle, self.missed, self.armed = -1, 0, False

    def next_cycle(self):
        """Wait for the next cycle. Returns its number."""
        self.begins_anew()
        self.cycle += 1
        self.catch_up()
        due = self.start + self.cycle * self._period
        early = due - self._clock.now()
        if early > 0:
            self._clock.sleep(early)
        self.missed += int(self._clock.now() - due > _LATE * self._period)
        return self.cycle

    def catch_up(self):
        """Skip to the cycle that is due now; those before it count as left out."""
        cycle = max(self.cycle, int((self._clock.now() - self.start) / self._period))
        self.missed += cycle - self.cycle
        self.cycle = cycle

    def begins_anew(self):
        """Return True if nothing was sent during a long first cycle: then the run's clock starts again now."""
        now = self._clock.now()
        if self.armed or now - self.heard <= LONGEST_PAUSE:
            return False
        self.start, self.heard = self.start + now - self.heard, now
        return True

    def silence(self):
        """Return how long the driven arm has had no command, s, and start to count again."""
        now = self._clock.now()
        silence, self.heard = now - self.heard, now
        return silence if self.armed else 0.0


def load_controllers():
    """Load the compiled controllers now; otherwise the first `step` of the first run takes 0.5 s or more for it."""
    from ir50p_lab.controllers import PID

    PID(kp=(0, 0, 0), limit_pwm=255).step(0.0, np.zeros(3), np.zeros((3, 3)))


def cut_said(confirmed):
    """Return a phrase that says whether the drive was cut. confirmed: whether the board has answered."""
    brakes = f"the board has not confirmed the cut: it brakes by itself within {WATCHDOG:g} s"
    return "the drive has been cut" if confirmed else brakes


@contextlib.contextmanager
def undisturbed():
    """Keep garbage collection off the objects of now until the end: a notebook's takes longer than WATCHDOG."""
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
