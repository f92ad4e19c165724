"""What every reference signal promises: q, qd and qdd at any time, for one time or for many."""

import math

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, number, numbers, vector3


class Reference:
    """A motion of the three joints as a function of time; made by `hold`, `steps`, `quintic`, `trapezoid`...

    ==================== =====================================================================================
    target(t)            (q, qd, qdd) at one time t in s: three arrays (3,), rad, rad/s, rad/s^2
    target.sample(t)     the same for times (n,) in s: array (n, 3, 3), indices time, (q, qd, qdd), joint
    target.duration      s from t = 0 until the motion is over (0 for `hold`, inf for `sinusoid`); q stays after it
    ==================== =====================================================================================

    qd is the derivative of q, and qdd that of qd, everywhere except at the jumps that a class names. A time is any
    finite number of seconds; before its start a reference rests in its first pose. References are frozen and compare
    by value. A new kind derives from this class, sets `duration` and writes `_rows(t)`: times (n,) -> array (n, 3, 3).
    """

    duration = 0.0

    def __call__(self, t):
        """(q, qd, qdd) at the time `t`, s: three arrays (3,). Raises InputError if t is not one finite number."""
        if type(t) is not float or not math.isfinite(t):  # else nothing to check, a hundred times a second
            t = number("t", t, unit="s", hint="for an array of times use target.sample(t)")
        q, qd, qdd = self._rows(np.array([t]))[0]
        return q, qd, qdd

    def sample(self, t):
        """Return the reference at many times.

        Args: t: (n,) s, in any order. Returns: (n, 3, 3), indices time, (q, qd, qdd), joint; rad, rad/s, rad/s^2.
        Raises InputError if t is not of shape (n,) or a time is not finite.
        """
        return self._rows(time_vector("t", t))


def time_vector(name, value):
    """Return `value` as a float array (n,) in s. Raises InputError for another shape or a number that is not finite."""
    t = numbers(name, value, unit="s")
    if t.ndim != 1:
        raise InputError(f"{name} has shape {t.shape}; give times in s of shape (n,)")
    if not np.isfinite(t).all():
        raise InputError(f"{name} holds {first_not_finite(t)}; every time must be finite (s): remove that sample")
    return t


def pose(name, value, *, unit="rad"):
    """Return `value` as a tuple of three floats. Raises InputError for another shape or a number that is not finite."""
    return tuple(vector3(name, value, unit=unit).tolist())


def per_joint(name, value, rule="finite", *, unit=""):
    """Return three numbers, one per joint, as a tuple; a single number counts for all joints.

    Raises InputError for another shape, or for a number that breaks the `rule` of `number`.
    """
    if isinstance(value, (str, bytes, bool)):
        number(name, value, rule, unit=unit)  # says that these are none
    array = numbers(name, value, unit=unit)
    if array.shape not in ((), (3,)):
        raise InputError(f"{name} has shape {array.shape}; give one number, or one per joint, (3,) ({unit})")
    joints = enumerate(np.broadcast_to(array, 3).tolist(), start=1)
    return tuple(number(f"{name} of joint {joint}", x, rule, unit=unit) for joint, x in joints)
