"""The quickest motion within limits of velocity and acceleration: trapezoids of velocity."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.signals.reference import Reference, per_joint, pose, seconds

_NO_DISTANCE = 1e-100  # rad: below it a joint stays, so that limit/distance cannot overflow


@dataclass(frozen=True)
class Trapezoid(Reference):
    """Trapezoidal velocity; made by `trapezoid`.

    q0, q1: (3,) rad; v_max: (3,) rad/s; a_max: (3,) rad/s^2; start: s; synchronise: bool.
    Found from these, in terms of the share s of the way (0..1): accelerations a (3,) 1/s^2, peak velocities v (3,)
    1/s, and the times T (3,) s that the joints need.
    """

    q0: tuple
    q1: tuple
    v_max: tuple
    a_max: tuple
    start: float
    synchronise: bool
    a: tuple = field(init=False, repr=False)
    v: tuple = field(init=False, repr=False)
    T: tuple = field(init=False)
    duration: float = field(init=False)

    def __post_init__(self):
        distance = np.abs(np.array(self.q1) - self.q0)
        moving = distance > _NO_DISTANCE
        way = np.where(moving, distance, 1.0)
        v, a = np.array(self.v_max) / way, np.array(self.a_max) / way
        if self.synchronise and moving.any():
            v[:], a[:] = v[moving].min(), a[moving].min()
        v = np.minimum(v, np.sqrt(a))  # triangle: the way ends before the limit of velocity is reached
        T = np.where(moving, 1 / v + v / a, 0.0)
        for name, values in (("a", a), ("v", v), ("T", T)):
            object.__setattr__(self, name, tuple(values.tolist()))
        object.__setattr__(self, "duration", max(0.0, self.start + T.max()))

    def _rows(self, t):
        a, v, T = np.array(self.a), np.array(self.v), np.array(self.T)
        since, left = t[:, None] - self.start, T - (t[:, None] - self.start)
        speeding, braking = since < v / a, left <= v / a
        s = np.where(speeding, a * since**2 / 2, np.where(braking, 1 - a * left**2 / 2, v * (since - v / a / 2)))
        sd = np.where(speeding, a * since, np.where(braking, a * left, v))
        sdd = np.where(speeding, a, np.where(braking, -a, 0.0))
        q0, q1 = np.array(self.q0), np.array(self.q1)
        before, after = since < 0, left <= 0
        rest = before | after
        rows = np.empty((len(t), 3, 3))
        rows[:, 0] = np.where(after, q1, np.where(before, q0, q0 + (q1 - q0) * s))
        rows[:, 1] = np.where(rest, 0.0, (q1 - q0) * sd)
        rows[:, 2] = np.where(rest, 0.0, (q1 - q0) * sdd)
        return rows


def trapezoid(q0, q1, *, v_max, a_max, start=0.0, synchronise=True):
    """Move from rest at `q0` to rest at `q1`: full acceleration, full speed, full braking.

    A joint with way D needs D/v_max + v_max/a_max, or 2 sqrt(D/a_max) if D < v_max^2/a_max: then it never reaches
    v_max and its velocity is a triangle. The acceleration jumps (at a jump the value after it counts).

    With `synchronise` all joints share one profile s(t) of the way, q = q0 + (q1 - q0) s(t): they start, change
    over and arrive together, and the pose moves on a straight line in joint space. It is the quickest such profile
    that keeps every limit; where one joint is limited by velocity and another by acceleration, it takes longer than
    the slower of the two alone. Without it each joint goes as fast as it can and waits for the others.

    Args:
        q0, q1: (3,) rad (may be equal).
        v_max, a_max: limits, rad/s and rad/s^2, > 0: one number, or (3,).
        start: s; before it the arm rests at q0.

    Returns: Reference with duration start + longest time; `.T` (3,) s holds the time of each joint.
    Raises: InputError on a wrong shape, a number that is not finite, or a limit that is not positive.
    """
    return Trapezoid(
        q0=pose("q0", q0),
        q1=pose("q1", q1),
        v_max=per_joint("v_max", v_max, "> 0", unit="rad/s"),
        a_max=per_joint("a_max", a_max, "> 0", unit="rad/s^2"),
        start=seconds("start", start),
        synchronise=bool(synchronise),
    )
