"""Fourier series as excitation: periodic motion from rest to rest, inside the limits of the arm    (4.2 corrected)."""

import math
from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.inputs import choice, first_not_finite, number, numbers, whole
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.signals.reference import Reference, per_joint

_GRID = 256  # points per period of the fastest harmonic: between them no more than 1 - cos(pi/256) of the swing hides
_AT_REST = 1e-9  # of the sum of |k a_k|: rounding of coefficients that were made to end at rest


@dataclass(frozen=True)
class Fourier(Reference):
    """A Fourier series as a reference; `fourier` makes it.

    a, b: three rows of N coefficients, rad; q0: (3,) rad, the mean pose; period: s; duration: s, end of the motion.
    Before and after the motion it rests in `q_start`.
    """

    a: tuple
    b: tuple
    q0: tuple
    period: float
    duration: float = field(kw_only=True)

    def _rows(self, t):
        rows = series(self.a, self.b, self.q0, self.period, t)
        outside = (t <= 0) | (t >= self.duration)
        rows[outside, 0] = self.q_start
        rows[outside, 1:] = 0.0
        return rows

    @property
    def q_start(self):
        """The pose in which the motion begins and ends, q0 - sum b_k, (3,) rad; move there first, with `quintic`."""
        return np.array(self.q0) - np.array(self.b).sum(axis=1)


def fourier(
    a,
    b,
    *,
    period,
    q0=0.0,
    periods=1,
    ends="check",
    arm=None,
    max_joint_speed=None,
    table=0.0,
    margin=0.03,
):
    """Return a periodic motion of the three joints, from rest to rest    (4.2 corrected)

        q_i = q_i0 + sum_k=1..N [a_ik sin(k w t) - b_ik cos(k w t)],    w = 2 pi/period

    The thesis begins at k = 0, which adds a constant to q_i0, and has one a and one b for all joints. At t = 0 and
    after whole periods the velocity is w sum k a_ik and the acceleration w^2 sum k^2 b_ik. Both sums must be 0, or the
    arm gets a jerk at the start and at the end. The record must hold whole periods; otherwise averages over it are not
    those of the motion, and the frequencies leak into each other.

    Args:
        a, b: (3, N) rad, one row per joint. period: s. q0: mean pose, rad, one number or (3,).
        periods: length of the motion in periods, a whole number >= 1.
        ends: "check" refuses sums that are not 0; "adjust" takes the nearest coefficients whose sums are 0 (with the
            least change of all a and b) and needs N >= 2.
        arm: Arm; if given, the motion is checked against its joint limits, from which it keeps `margin` (rad), against
            the speed `max_joint_speed` (rad/s, one number or (3,); default: half the no-load speed of the motors, or
            2 rad/s without motors), and against the `table` (the height in m below which neither elbow nor tip may go;
            None: no table).

    Returns: Fourier, a Reference with `.q_start`.
    Raises: UnreachableError if a limit of the arm is passed (it says which, when and by how much); InputError on wrong
    shapes, numbers that are not finite, and ends that are not at rest.
    """
    a, b = _coefficients(a, b)
    period, periods = number("period", period, "> 0", unit="s"), whole("periods", periods, 1, 10**6)
    choice("ends", ends, ("check", "adjust"))
    if ends == "adjust":
        a, b = at_rest(a, b)
    _refuse_moving_ends(a, b)
    a, b = (tuple(map(tuple, rows.tolist())) for rows in (a, b))
    made = Fourier(a, b, per_joint("q0", q0, unit="rad"), period, duration=periods * period)
    if arm is not None:
        check_limits(made, arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    return made


def series(a, b, q0, period, t):
    """Return the bare series and its derivatives at the times t (n,) s, also outside the motion.

    Returns: (n, 3, 3), as Reference.sample.
    """
    a, b = np.array(a), np.array(b)
    w = 2 * np.pi / period * np.arange(1, a.shape[1] + 1)
    angle = (t % period)[:, None] * w
    s, c = np.sin(angle), np.cos(angle)
    rows = np.empty((len(t), 3, 3))
    rows[:, 0] = s @ a.T - c @ b.T + np.array(q0)
    rows[:, 1] = (c * w) @ a.T + (s * w) @ b.T
    rows[:, 2] = (c * w**2) @ b.T - (s * w**2) @ a.T
    return rows


def at_rest(a, b):
    """Return the nearest coefficients (a, b) with which the motion ends at rest: sum k a_k = 0 and sum k^2 b_k = 0.

    Args: a, b: (3, N) rad, N >= 2 (one harmonic alone cannot rest). Raises InputError for other shapes.
    """
    a, b = _coefficients(a, b)
    if a.shape[1] < 2:
        raise InputError("one harmonic alone is never at rest and without acceleration at once: give N >= 2 columns")
    k = np.arange(1.0, a.shape[1] + 1)
    return a - np.outer(a @ k, k) / (k @ k), b - np.outer(b @ k**2, k**2) / (k**2 @ k**2)


def check_limits(target, arm, *, max_joint_speed=None, table=0.0, margin=0.03):
    """Refuse a Fourier motion that leaves the limits of the arm; arguments and errors are those of `fourier`.

    The motion is inspected at 256 points per period of its fastest harmonic. A trigonometric polynomial of degree N can
    exceed its largest value on such a grid by no more than 1/cos(pi/256) - 1 of half its range (Bernstein); that much
    is added.
    """
    lengths(arm)  # refuses what is not an Arm
    low, high, speed, table = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    n = _GRID * len(target.a[0])
    t = target.period * np.arange(n) / n
    rows = series(target.a, target.b, target.q0, target.period, t)
    hidden = (1 / math.cos(math.pi / _GRID) - 1) * np.ptp(rows, axis=0) / 2
    q, speeds = rows[:, 0], np.abs(rows[:, 1])
    for what, value, over, limit, remedy in (
        ("goes up to", q, q - high + hidden[0], high, "another q0"),
        ("goes down to", q, low - q + hidden[0], low, "another q0"),
        ("turns at", speeds, speeds - speed + hidden[1], speed, "a longer period"),
    ):
        i, joint = np.unravel_index(over.argmax(), over.shape)
        if over[i, joint] > 0:
            unit = "rad/s" if what == "turns at" else "rad"
            raise UnreachableError(
                f"joint {joint + 1} {what} {value[i, joint]:.4g} {unit} at {t[i]:.3g} s of the period, its limit is "
                f"{limit[joint]:.4g} {unit}: choose {remedy} or smaller coefficients"
            )
    refuse_below_table(arm.l, q, table, lambda i: f"{t[i]:.3g} s of the period")


def refuse_below_table(l, q, table, place):
    """Raise UnreachableError if elbow or tip would be under the table; place(i) returns where sample i is, in words.

    l: (3,) m; q: (n, 3) rad; table: its height in m, or None for no table.
    """
    for part, height in zip(("elbow", "tip"), heights(l, q), strict=True):
        i = int(height.argmin())
        if table is not None and height[i] < table - 1e-12:
            raise UnreachableError(
                f"the {part} would be {1e3 * (table - height[i]):.3g} mm under the table (height {table:g} m) at "
                f"{place(i)}: lead the motion higher, or give the height of your table"
            )


def heights(l, q):
    """Return the heights of elbow and tip above the base, (n,) m each. l: (3,) m; q: (n, 3) rad."""
    elbow = l[0] + l[1] * np.sin(q[:, 1])
    return elbow, elbow + l[2] * np.sin(q[:, 1] + q[:, 2])


def limits_of(arm, *, max_joint_speed=None, table=0.0, margin=0.03):
    """Return the bounds that `fourier` checks: lowest and highest q (3,) rad, speed (3,) rad/s, table in m or None.

    The joint limits come narrowed by `margin`, rad. Raises InputError for arguments that are no such numbers.
    """
    number("margin", margin, ">= 0", unit="rad")
    if table is not None:
        number("table", table, unit="m", hint="its height, or None for no table")
    if max_joint_speed is None:
        speed = np.full(3, 2.0) if arm.actuators is None else 0.5 * arm.actuators.no_load_speed
    else:
        speed = np.array(per_joint("max_joint_speed", max_joint_speed, "> 0", unit="rad/s"))
    return np.array(arm.q_min) + margin, np.array(arm.q_max) - margin, speed, table


def _coefficients(a, b):
    a, b = numbers("a", a, unit="rad, shape (3, N)"), numbers("b", b, unit="rad, shape (3, N)")
    if a.ndim != 2 or len(a) != 3 or a.shape != b.shape:
        raise InputError(
            f"a has shape {a.shape}, b {b.shape}; give a row of N coefficients per joint, both (3, N) (rad)"
        )
    for name, array in (("a", a), ("b", b)):
        if not np.isfinite(array).all():
            raise InputError(f"{name} holds {first_not_finite(array)}; every coefficient must be finite (rad)")
    return a, b


def _refuse_moving_ends(a, b):
    k = np.arange(1.0, a.shape[1] + 1)
    for what, x, weight in (("velocity: sum k a_k", a, k), ("acceleration: sum k^2 b_k", b, k**2)):
        total, size = x @ weight, np.abs(x) @ weight
        joint = int(np.abs(total).argmax())
        if (np.abs(total) > _AT_REST * size.max()).any():
            raise InputError(
                f"joint {joint + 1} does not end with zero {what} = {total[joint]:.4g} rad, not 0: the arm would start "
                "and stop with a jerk. Use ends='adjust' for the nearest coefficients that do"
            )
