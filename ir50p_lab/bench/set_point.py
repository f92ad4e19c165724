"""A set point that is moved by hand, and a reference that runs after it at limited speed."""

import math

import numpy as np

from ir50p_lab.inputs import vector3

SPEED = 0.8  # largest joint speed, rad/s: the tip of the stretched arm moves at 0.7 m/s
ACCELERATION = 3.0  # largest joint acceleration, rad/s^2: full speed after a quarter of a second


class SetPoint:
    """A pose to hold that may be changed at any time; the reference runs after it at limited speed, without overshoot.

    Each joint accelerates with at most ACCELERATION, moves with at most `speed` and brakes in time, so that the steps
    of a slider become a motion that the arm can follow. It remembers where it is: call it once per cycle with
    increasing times, as a loop does.

    Args: q, qd: (3,) rad and rad/s, where and how fast the reference starts; speed: rad/s, of each joint.
    Attributes: q, goal: (3,) rad, where it is, and where it is going; set the goal with `move_to`.
    Raises InputError on wrong shapes and numbers that are not finite.
    """

    duration = math.inf

    def __init__(self, q, *, qd=(0.0, 0.0, 0.0), speed=SPEED):
        self.q, self._qd = vector3("q", q).copy(), vector3("qd", qd, unit="rad/s").copy()
        self.speed = speed
        self.goal, self._t = self.q, None

    def move_to(self, q):
        """Go to q (3,) rad from now on. Raises InputError on anything else."""
        self.goal = vector3("set point", q).copy()

    def __call__(self, t):
        """(q, qd, qdd) at the time t, s: three arrays (3,)."""
        dt = 0.0 if self._t is None else min(max(t - self._t, 0.0), 0.25)  # after a pause: go on, do not jump
        self._t = t
        if dt == 0.0:
            return self.q.copy(), self._qd.copy(), np.zeros(3)
        distance, before, at = self.goal - self.q, self._qd, ACCELERATION * dt
        # the speed from which n steps, each slower by a dt than the one before, end exactly at the goal
        steps = np.abs(distance) / (at * dt)
        n = np.maximum(1, np.ceil(0.5 * (np.sqrt(1 + 8 * steps) - 1) - 1e-9))
        braking = at * (steps / n + 0.5 * (n - 1))
        wanted = np.copysign(np.minimum(braking, self.speed), distance)
        self._qd = np.clip(wanted, before - at, before + at)
        there = np.abs(distance - self._qd * dt) < 1e-12  # but for rounding; the next step takes the rest of the speed
        self.q = np.where(there, self.goal, self.q + self._qd * dt)
        return self.q.copy(), self._qd.copy(), (self._qd - before) / dt
