"""The loop in the background, the same on every bench: cycles of measure, obey, command, tell."""

import contextlib
import time

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.base import header_of
from ir50p_lab.bench.rest import way_to_rest
from ir50p_lab.bench.set_point import LeadIn, SetPoint, led_in
from ir50p_lab.errors import BenchError

_DAY = 86400.0  # s: the longest run "until stopped"
_LATE = 0.25  # s: farther behind than this, a simulated bench gives up catching up


def live_loop(bench, controller, reference, memory, *, seconds, lead_in, rest, orphaned=lambda: False, paced=True):
    """Run until the orders in `memory` say stop or cut, `seconds` are over, or something fails.

    Args:
        bench: open Bench; controller: anything with step(t, measured, reference); reference: target(t) or None, which
        holds the measured pose; memory: SharedLoop. seconds: of the reference, or None; lead_in, rest: as `start`.
        orphaned: says in every cycle whether the process that gives the orders has died; paced: keep real time here
        (a bench that does so itself is not held up by it).

    After the orders' cut or an error the drive is off at once; else the arm moves to its rest pose first.
    Raises what controller, reference or bench raise, and BenchError when orphaned.
    """
    loop = _Loop(bench, memory, orphaned, paced)
    try:
        if hasattr(controller, "reset"):
            controller.reset()
        target = _Target(reference, lead_in)
        q = loop.run(controller, target, seconds, header=_header(controller))
        if rest and bench.kind != "replay" and not memory.orders().cut and q is not None:
            memory.enter(shared_loop.RETURNING)
            pid, way = way_to_rest(bench.arm, q, bench.period)
            loop.run(pid, _Target(way, lead_in=False), way.duration + 0.5, header=None)
    finally:
        bench.cut()
        bench._last = None  # closing the bench moves nothing: the arm is at rest, or was cut on purpose
        memory.enter(shared_loop.ENDED)


class _Loop:
    """What outlives one run: the time so far and how many orders were obeyed."""

    def __init__(self, bench, memory, orphaned, paced):
        self.bench, self.memory, self.orphaned, self.paced = bench, memory, orphaned, paced
        self.t0, self.missed0 = 0.0, 0

    def run(self, controller, target, seconds, *, header):
        """One run of the bench; header None: the way to the rest pose, neither recorded nor tuned.

        Returns: the last q (3,), None if there was no sample.
        """
        returning = header is None
        period, memory, drive = self.bench.period, self.memory, self.bench.drive
        gains_number = set_point_number = 0
        pace = _Pace() if self.paced else None
        sample, late, end = None, 0, _DAY
        cycles = self.bench.run(_DAY, record=not returning, **(header or {}))
        with contextlib.closing(cycles):
            for sample in cycles:
                if pace is not None:
                    late += pace.wait_for(sample.t, period)
                woke = time.perf_counter()
                if self.orphaned():
                    raise BenchError("the process that started this loop is gone: the drive has been cut")
                orders = memory.orders()
                if orders.cut or (orders.stop and not returning):
                    break
                t = sample.t
                if target.begins is None:
                    lead = target.begin(sample)
                    end = _DAY if seconds is None else lead + seconds - 0.5 * period
                if t - target.begins > end:
                    break
                if not returning:
                    memory.enter(shared_loop.LEADING if t - target.begins < lead else shared_loop.RUNNING)
                    if orders.gains_number != gains_number:
                        gains_number = orders.gains_number
                        gains = {"kp": orders.gains[:3], "ki": orders.gains[3:6], "kd": orders.gains[6:]}
                        controller.set_gains(**gains)
                        self.bench.note("; ".join(f"{k} = {' '.join(f'{x:g}' for x in v)}" for k, v in gains.items()))
                    if orders.set_point_number != set_point_number:
                        set_point_number = orders.set_point_number
                        target.move_to(t, orders.set_point)
                aim = target(t)
                u = drive(controller.step(t, sample.q, aim), reference=aim[0])
                busy = time.perf_counter() - woke
                measured = woke if self.paced else self.t0 + t  # paced, t is a number of periods; else it is true time
                memory.put(self.t0 + t, sample.q, u, aim[0], measured, busy, self.missed0 + max(sample.missed, late))
            if memory.orders().cut:
                self.bench.cut()  # before the run is closed, whose recording takes a moment
        if sample is None:
            return None
        self.t0, self.missed0 = self.t0 + sample.t + period, memory.missed
        return sample.q


class _Target:
    """The reference, with a lead-in, until a set point takes over."""

    def __init__(self, reference, lead_in):
        self.reference, self.lead_in, self.begins = reference, lead_in, None

    def begin(self, sample):
        """Start at this sample. Returns the time the lead-in takes, s."""
        self.begins = sample.t
        if self.reference is None:
            self.reference = SetPoint(sample.q)
        elif self.lead_in:
            self.reference = led_in(sample.q, self.reference)
        return self.reference.lead if isinstance(self.reference, LeadIn) else 0.0

    def __call__(self, t):
        return self.reference(t - self.begins)

    def move_to(self, t, goal):
        """A set point takes over from where the reference is, moving as it moves."""
        if not isinstance(self.reference, SetPoint):
            q, qd, _ = self(t)
            self.reference = SetPoint(q, qd=qd)
            self.reference(t - self.begins)
        self.reference.move_to(goal)


class _Pace:
    """Real time for a bench that has none: absolute deadlines, so that nothing drifts."""

    def __init__(self):
        self.origin = None

    def wait_for(self, t, period):
        """Sleep until the run is t old, s. Returns 1 if that was more than a period ago, else 0."""
        now = time.perf_counter()
        if self.origin is None:
            self.origin = now - t
        left = self.origin + t - now
        if left > 0:
            time.sleep(left)
        elif left < -_LATE:
            self.origin = now - t  # a laptop that slept: go on from here instead of racing after the clock
        return int(left < -period)


def _header(controller):
    lines = {"controller": type(controller).__name__, "loop": "in the background; gains and set point may change"}
    return lines | header_of(controller)
