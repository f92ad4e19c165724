"""The loop in the background, the same on every bench: each cycle measures, obeys orders, commands, and tells."""

import contextlib
from itertools import takewhile

import numpy as np

from ir50p_lab.bench.pace import load_controllers
from ir50p_lab.bench.recorder import header_of
from ir50p_lab.bench.rest import trajectory_to_rest
from ir50p_lab.bench.set_point import SPEED, SetPoint
from ir50p_lab.controllers.base import gains_of, set_gains

STARTING, LEADING, RUNNING = "starting", "leading in", "running"
RETURNING, ENDED = "moving to the rest pose", "ended"
_DAY = 86400.0  # s: the longest run


def live_loop(bench, controller, reference, orders, tell):
    """Run until an order says stop or cut, or something fails.

    Args:
        bench: open Bench; controller: anything with step(t, measured, reference); reference: target(t), or None, which
        holds the measured pose. orders: queue of (name, content): "stop", "cut" (None), "gains" (dict of (3,)),
        "set point" (3,) rad, "push" (link, point, force). tell: is called with a name and its content: "phase",
        "recording" (path or None) and, once in each cycle, "sample": (t, q, u, reference, begin of the cycle in s of a
        true clock, late cycles, trips of the watchdog).

    After the order to cut, and after an error, the drive is off at once; otherwise the arm moves to its rest pose
    first, which is not recorded. Raises what controller, reference, bench or `tell` raise.
    """
    load_controllers()
    trajectory_to_rest(bench.arm, np.zeros(3), bench.period)[1](0.0)  # compiled now: at the end there is no time
    loop = _Loop(bench, _Target(bench, reference, min(SPEED, *bench.caps.speed)), orders, tell)
    loop.say(STARTING)
    try:
        if hasattr(controller, "reset"):
            controller.reset()
        header = {"controller": type(controller).__name__, "loop": "in the background; gains and set point may change"}
        with contextlib.closing(bench.run(_DAY, loop.target, **header | header_of(controller))) as samples:
            if loop.follow(samples, controller) == "stop" and bench.answers:
                bench._run.end_recording()
                controller, trajectory = trajectory_to_rest(bench.arm, bench.last.q, bench.period, *bench.caps[:2])
                bench._run.capped = False
                loop.target.take(trajectory, bench.last.t)
                end = bench.last.t + trajectory.duration + 0.5
                loop.follow(takewhile(lambda sample: sample.t < end, samples), controller, returning=True)
    finally:
        bench.cut()
        bench.last = None  # closing the bench moves nothing: the arm is at rest, or was cut on purpose
        loop.say(ENDED)


class _Loop:
    """One run in the background: its bench, target, queue of orders and phase."""

    def __init__(self, bench, target, orders, tell):
        self.bench, self.target, self.orders, self.tell = bench, target, orders, tell
        self.phase = None

    def say(self, phase):
        """Tell what the loop does now, and where that is recorded."""
        if phase != self.phase:
            self.phase, recording = phase, self.bench.recording
            self.tell("recording", recording and recording.path and recording.path.absolute())
            self.tell("phase", phase)

    def follow(self, samples, controller, *, returning=False):
        """Drive as long as there are samples; returning: only the order to cut counts. Returns the order that ended it.

        A sample with which it ends is not driven: the command before holds, or has been cut.
        """
        for sample in samples:
            began = self.bench._run.pace.heard
            while not self.orders.empty():
                order, content = self.orders.get()
                if order == "cut":
                    self.bench.cut()  # before the run is closed, whose recording takes a moment
                if order == "cut" or (order == "stop" and not returning):
                    return order
                if not returning:
                    self.change(controller, order, content, sample.t)
            self.say(RETURNING if returning else LEADING if self.target.leading else RUNNING)
            u = self.bench.drive(controller.step(sample.t, sample.q, sample.reference))
            numbers = (three.tolist() for three in (sample.q, u, sample.reference[0]))
            self.tell("sample", (sample.t, *numbers, began, sample.missed, self.bench._run.trips))
        return "over"

    def change(self, controller, order, content, t):
        """Take new gains, a new set point or a push."""
        if order == "set point":
            return self.target.move_to(content, t)
        if order == "push":
            return self.bench.push(*content)
        set_gains(controller, **content)
        gains = (f"{name} = {' '.join(f'{x:g}' for x in three)}" for name, three in gains_of(controller).items())
        self.bench.note("; ".join(gains))


class _Target:
    """What the arm is to follow: a trajectory to the reference from where it stands, the reference, then any set point.

    leading: whether it still follows the first of these; speed: rad/s, of set points.
    """

    def __init__(self, bench, reference, speed=SPEED):
        self.bench, self.reference, self.speed, self.leading = bench, reference, speed, reference is not None
        self._point, self._begin = None, 0.0

    def __call__(self, t):
        if self._point is None:  # the arm has just been measured for the first time
            arm = self.bench.arm
            self._point = SetPoint(np.clip(self.bench.last.q, arm.q_min, arm.q_max), speed=self.speed)
            if self.leading:
                self._point.move_to(self.reference(0.0)[0])
        if self.leading and (self._point.q == self._point.goal).all():
            self.take(self.reference, t)
        if self.leading or self.reference is None:
            return self._point(t)
        return self.reference(t - self._begin)

    def take(self, reference, t):
        """Follow `reference`, whose time begins at t, s, and which begins where the target is now."""
        self.reference, self.leading, self._begin = reference, False, t

    def move_to(self, q, t):
        """A set point takes over from where the target is, moving as it moves."""
        if self.reference is not None and not self.leading:
            here, speed, _ = self(t)
            self._point = SetPoint(here, qd=speed, speed=self.speed)
            self._point(t)  # its time begins now
        self.reference, self.leading = None, False
        self._point.move_to(q)
