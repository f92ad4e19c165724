"""The quickest motion within limits of velocity and acceleration: velocities in the shape of a trapezoid."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.signals.reference import Reference, per_joint, pose

_NO_DISTANCE = 1e-100  # rad: below it a joint stays, so that limit/distance cannot overflow


@dataclass(frozen=True)
class Trapezoid(Reference):
    """A reference with a trapezoidal velocity; `trapezoid` makes it.

    q0, q1: (3,) rad. As shares of the path: acceleration a, 1/s^2, and peak velocity v, 1/s.
    """

    q0: tuple
    q1: tuple
    a: float
    v: float
    duration: float

    def _rows(self, t):
        a, v = self.a, self.v
        left = self.duration - t
        phases = t < 0, left <= 0, t < v / a, left <= v / a  # before, after, speeding, braking; else full speed
        s = np.select(phases, (0.0, 1.0, a * t**2 / 2, 1 - a * left**2 / 2), v * (t - v / a / 2))
        sd = np.select(phases, (0.0, 0.0, a * t, a * left), v)
        sdd = np.select(phases, (0.0, 0.0, a, -a), 0.0)
        rows = np.stack([s, sd, sdd], axis=1)[..., None] * np.subtract(self.q1, self.q0)
        rows[:, 0] += self.q0
        rows[left <= 0, 0] = self.q1  # exactly there
        return rows


def trapezoid(q0, q1, *, v_max, a_max):
    """Move from rest at `q0` to rest at `q1`: full acceleration, full speed, full braking.

    A joint alone with a path D needs D/v_max + v_max/a_max, or 2 sqrt(D/a_max) if D < v_max^2/a_max: then it never
    reaches v_max, and its velocity is a triangle. The acceleration jumps (at a jump the value after it counts).

    All joints share one profile s(t) of the path, q = q0 + (q1 - q0) s(t): they start, change over and arrive together,
    and the pose moves on a straight line in joint space. It is the quickest such profile that keeps every limit. If one
    joint is limited by velocity and another by acceleration, it takes longer than the slower of the two would alone.

    Args:
        q0, q1: (3,) rad (may be equal).
        v_max, a_max: limits, rad/s and rad/s^2, > 0: one number, or (3,).

    Returns: Reference.
    Raises: InputError on a wrong shape, a number that is not finite, or a limit that is not positive.

    >>> from ir50p_lab.signals import trapezoid
    >>> way = trapezoid([0, 0, 0], [1, 0, 0], v_max=0.5, a_max=1)
    >>> way.duration, way(way.duration)[0].round(3)
    (2.5, array([1., 0., 0.]))
    """
    q0, q1 = pose("q0", q0), pose("q1", q1)
    v_max, a_max = per_joint("v_max", v_max, "> 0", unit="rad/s"), per_joint("a_max", a_max, "> 0", unit="rad/s^2")
    distance = np.abs(np.subtract(q1, q0))
    moving = distance > _NO_DISTANCE
    if not moving.any():
        return Trapezoid(q0, q1, a=1.0, v=1.0, duration=0.0)
    v, a = (float((limit / distance[moving]).min()) for limit in (np.array(v_max)[moving], np.array(a_max)[moving]))
    v = min(v, math.sqrt(a))  # triangle: the path ends before the limit of velocity is reached
    return Trapezoid(q0, q1, a=a, v=v, duration=1 / v + v / a)
