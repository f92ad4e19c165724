"""The loop in the background, the same on every bench: cycles of measure, obey, command, tell."""

import contextlib
import math
import time

import numpy as np

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.recorder import header_of
from ir50p_lab.bench.rest import way_to_rest
from ir50p_lab.bench.set_point import SPEED, SetPoint
from ir50p_lab.controllers.base import set_gains
from ir50p_lab.errors import BenchError
from ir50p_lab.signals.quintic import quintic

_DAY = 86400.0  # s: the longest run "until stopped"
_THERE = math.radians(0.25)  # nearer than this a lead-in would only waste time: about the noise of the potentiometers


def live_loop(bench, controller, reference, memory, *, seconds, lead_in, rest, orphaned=lambda: False):
    """Run until the orders in `memory` say stop or cut, `seconds` are over, or something fails.

    Args:
        bench: open Bench; controller: anything with step(t, measured, reference); reference: target(t) or None, which
        holds the measured pose; memory: SharedLoop. seconds: of the reference, or None; lead_in, rest: as `start`.
        orphaned: says in every cycle whether the process that gives the orders has died.

    After the orders' cut or an error the drive is off at once; else the arm moves to its rest pose first.
    Raises what controller, reference or bench raise, and BenchError when orphaned.
    """
    loop = _Loop(bench, memory, orphaned)
    try:
        if hasattr(controller, "reset"):
            controller.reset()
        target = _Target(bench, reference, lead_in)
        header = {"controller": type(controller).__name__, "loop": "in the background; gains and set point may change"}
        q = loop.run(controller, target, seconds, header=header | header_of(controller))
        if rest and bench.kind != "replay" and not memory.orders().cut and q is not None:
            memory.status.phase = shared_loop.RETURNING
            pid, way = way_to_rest(bench.arm, q, bench.period)
            loop.run(pid, _Target(bench, way, lead_in=False), way.duration + 0.5, header=None)
    finally:
        bench.cut()
        bench._last = None  # closing the bench moves nothing: the arm is at rest, or was cut on purpose
        memory.status.phase = shared_loop.ENDED


class _Loop:
    """What outlives one run: the time so far and how many orders were obeyed."""

    def __init__(self, bench, memory, orphaned):
        self.bench, self.memory, self.orphaned = bench, memory, orphaned
        self.t0, self.missed0, self.trips0 = 0.0, 0, bench.trips

    def run(self, controller, target, seconds, *, header):
        """One run of the bench; header None: the way to the rest pose, neither recorded nor tuned.

        Returns: the last q (3,), None if there was no sample.
        """
        returning = header is None
        bench, memory = self.bench, self.memory
        gains_number = set_point_number = 0
        sample = None
        cycles = bench.run(_DAY, target, record=not returning, **(header or {}))
        with contextlib.closing(cycles):
            for sample in cycles:
                woke, t = time.perf_counter(), sample.t
                if self.orphaned():
                    raise BenchError("the process that started this loop is gone: the drive has been cut")
                orders = memory.orders()
                if orders.cut or (orders.stop and not returning):
                    break
                if seconds is not None and t - target.begins > target.lead + seconds - 0.5 * bench.period:
                    break
                if not returning:
                    leading = t - target.begins < target.lead
                    memory.status.phase = shared_loop.LEADING if leading else shared_loop.RUNNING
                    if orders.gains_number != gains_number:
                        gains_number = orders.gains_number
                        gains = {"kp": orders.gains[:3], "ki": orders.gains[3:6], "kd": orders.gains[6:]}
                        set_gains(controller, **gains)
                        bench.note("; ".join(f"{k} = {' '.join(f'{x:g}' for x in v)}" for k, v in gains.items()))
                    if orders.set_point_number != set_point_number:
                        set_point_number = orders.set_point_number
                        target.move_to(t, orders.set_point)
                u = bench.drive(controller.step(t, sample.q, sample.reference))
                busy, late = time.perf_counter() - woke, self.missed0 + sample.missed
                aim = sample.reference[0]
                memory.put(self.t0 + t, sample.q, u, aim, woke, busy, late, bench.trips - self.trips0)
            if memory.orders().cut:
                bench.cut()  # before the run is closed, whose recording takes a moment
        if sample is None:
            return None
        self.t0, self.missed0 = self.t0 + sample.t + bench.period, int(memory.status.missed)
        return sample.q


class _Target:
    """The reference, with a way to it in front, until a set point takes over: the target starts where the arm stands.

    begins: t of its first call, s; lead: how long the way to the reference takes, s.
    """

    def __init__(self, bench, reference, lead_in):
        self.bench, self.reference, self.lead_in = bench, reference, lead_in
        self.begins, self.lead, self._way = None, 0.0, None

    def __call__(self, t):
        if self.begins is None:
            self._begin(t)
        t = t - self.begins
        leading = self._way is not None and t < self.lead
        return self._way(t) if leading else self.reference(t - self.lead)

    def _begin(self, t):
        """Start at this time, from the pose just measured."""
        self.begins, arm = t, self.bench.arm
        here = np.clip(self.bench._last.q, arm.q_min, arm.q_max)
        if self.reference is None:
            self.reference = SetPoint(here)
        elif self.lead_in:
            goal = np.asarray(self.reference(0.0)[0], dtype=float)
            distance = float(np.abs(goal - here).max())
            if distance > _THERE:
                self.lead = max(0.3, 1.875 * distance / SPEED)  # a quintic's peak is 15/8 of its mean
                self._way = quintic(here, goal, duration=self.lead)

    def move_to(self, t, goal):
        """A set point takes over from where the reference is, moving as it moves."""
        if not isinstance(self.reference, SetPoint):
            q, qd, _ = self(t)
            self.reference, self._way = SetPoint(q, qd=qd), None
            self(t)  # its time begins now
        self.reference.move_to(goal)
