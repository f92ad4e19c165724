"""The handle of a loop in the background: how it is tuned, stopped, cut and watched, whatever it runs in."""

import math
import threading
from dataclasses import dataclass

import numpy as np

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.set_point import checked_set_point
from ir50p_lab.controllers.base import GAINS, gains, gains_of
from ir50p_lab.errors import BenchError, InputError

_TO_REST = 60.0  # s: a way to the rest pose that takes longer has failed
_OBEYED = 0.25  # s: a loop that has not taken the order to cut by then hangs


@dataclass(frozen=True)
class LoopStatistics:
    """How well the loop keeps time.

    cycles, missed, trips (times the drive was cut because the loop had paused): counts since the start; period_p50,
    period_p99, period_max: s between measurements; busy_p50: s from having a sample until its command was sent. The
    times are of the last 80 s at most; NaN before there are any.
    """

    cycles: int
    missed: int
    trips: int = 0
    period_p50: float = math.nan
    period_p99: float = math.nan
    period_max: float = math.nan
    busy_p50: float = math.nan

    def __str__(self):
        if not self.cycles:
            return "no cycle yet"
        p50, p99, largest = (1e3 * x for x in (self.period_p50, self.period_p99, self.period_max))
        cuts = f", {self.trips} cuts of the drive by pauses" if self.trips else ""
        return (
            f"{self.cycles} cycles, {self.missed} late{cuts}; period {p50:.2f} ms median, {p99:.2f} ms 99 %, "
            f"{largest:.2f} ms longest; {1e3 * self.busy_p50:.2f} ms from sample to command"
        )


@dataclass(frozen=True)
class LiveSamples:
    """The last samples: t (n,) s, q (n, 3) rad, u (n, 3) PWM counts as sent, reference (n, 3) rad; trips (k,) s, of the
    samples at which the drive had been cut because the loop had paused.
    """

    t: np.ndarray
    q: np.ndarray
    u: np.ndarray
    reference: np.ndarray
    trips: np.ndarray


class LiveRun:
    """A loop in the background: made by `bench.start`.

    ================================ ==========================================================================
    stop()                           end it in order: to the rest pose, then let go
    cut()                            drive off within a cycle, and the loop ends; the arm sinks
    set_gains(kp=, ki=, kd=)         from the next cycle on, without a bump; what is left out stays
    set_point([q1, q2, q3])          go there from where the reference is, at limited speed; rad, None: leave it
    recent(10)                       the last 10 s: .t .q .u .reference
    statistics()                     cycles, late ones, periods
    join(timeout)                    wait for the end; raises what ended it early
    alive, phase, error, recording   whether it runs; what it does; what went wrong or None; the file
    ================================ ==========================================================================

    Subclasses supply `alive`, `recording`, `begin()`: start, the first cycle follows; `wait(timeout)`: for the end, at
    most `timeout` s, returns whether it came; `give_up()`: cut the drive of a loop that does not obey.
    """

    def __init__(self, bench, controller, cargo, options, memory):
        """cargo: controller and reference as bytes; options: of `live_loop`; memory: the SharedLoop."""
        self._bench, self._cargo, self._options, self._memory = bench, cargo, options, memory
        self.error = None  # the exception that ended the loop
        self._gains = gains_of(controller)
        self._lock = threading.Lock()  # orders may come from several widgets' threads

    def is_here(self):
        """Whether the caller is the loop itself."""
        return False

    def _take_back(self):
        """Have the port again, if the loop had it."""

    @property
    def phase(self):
        """What it does: 'starting', 'leading in', 'running', 'moving to the rest pose' or 'ended'."""
        return shared_loop.PHASES[self._memory.status.phase] if self.alive else shared_loop.PHASES[-1]

    @property
    def gains(self):
        """{'kp': (3,), 'ki': (3,), 'kd': (3,)} as ordered last; empty if the controller has none to set."""
        return {name: values.copy() for name, values in self._gains.items()}

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains from the next cycle on; the command does not jump. Raises InputError for bad gains."""
        if not self._gains:
            raise InputError("this controller has no gains kp, ki, kd: there is nothing to change live")
        wanted = {
            name: gains(name, value) for name, value in zip(GAINS, (kp, ki, kd), strict=True) if value is not None
        }
        with self._lock:
            self._gains.update(wanted)
            self._memory.order(gains=np.concatenate([self._gains[name] for name in GAINS]))

    def set_point(self, q):
        """Go to q (3,) rad at limited speed; None (or NaN) leaves a joint where its reference is.

        Raises InputError if q is outside the joint limits or below the table.
        """
        goal = checked_set_point(self._bench.arm, q)
        with self._lock:
            self._memory.order(set_point=goal)

    def give_back(self):
        """The bench is wanted in this process again. Raises BenchError while the loop runs."""
        if self.alive:
            raise BenchError(f"a loop in the background has the arm ({self.phase}): stop() or cut() it first")
        self._take_back()

    def stop(self, *, wait=True):
        """End in order: the arm moves to its rest pose and is let go. wait: until that is over."""
        with self._lock:
            self._memory.order(stop=True)
        if wait and not self.wait(_TO_REST):
            self.cut()

    def cut(self):
        """Drive off within one cycle, and the loop ends. The arm sinks. Never raises; may be called at any time."""
        with self._lock:
            self._memory.order(cut=True, stop=True)
        if not self.wait(_OBEYED):
            self.give_up()

    def join(self, timeout=None):
        """Wait until the loop has ended; at most `timeout` s.

        Returns: whether it has. Raises what ended it early: an error of the controller, a lost board...
        """
        ended = self.wait(timeout)
        if self.error is not None:
            raise self.error
        return ended

    def recent(self, seconds):
        """The samples of the last `seconds`, at most 80 s: LiveSamples."""
        rows = self._memory.latest(1 + math.ceil(seconds / self._bench.period))
        rows = rows[rows["t"] >= rows["t"].max(initial=0.0) - seconds]
        tripped = np.flatnonzero(np.diff(rows["trips"])) + 1
        return LiveSamples(rows["t"], rows["q"], rows["u"], rows["r"], rows["t"][tripped])

    def statistics(self):
        """How well the loop keeps time: LoopStatistics."""
        status, rows = self._memory.status, self._memory.latest(shared_loop.CAPACITY)
        counts = int(status.samples), int(status.missed), int(status.trips)
        if len(rows) < 2:
            return LoopStatistics(*counts)
        periods = np.diff(rows["measured"])[np.diff(rows["number"]) == 1]
        p50, p99 = np.percentile(periods, (50, 99))
        return LoopStatistics(*counts, p50, p99, periods.max(), float(np.median(rows["busy"])))

    def __repr__(self):
        return f"<LiveRun: {self.phase}; {self.statistics()}>"
