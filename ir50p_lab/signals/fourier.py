"""Fourier series as excitation: periodic motion from rest to rest, inside the limits of the arm    (4.2 corrected)."""

import math
from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.inputs import check_arm, choice, first_not_finite, number, numbers
from ir50p_lab.signals.reference import Reference, per_joint, seconds

_GRID = 256  # points per period of the fastest harmonic: between them no more than 1 - cos(pi/256) of the swing hides
_AT_REST = 1e-9  # of the sum of |k a_k|: rounding of coefficients that were made to end at rest


@dataclass(frozen=True)
class Fourier(Reference):
    """Fourier series; made by `fourier`.

    a, b: three rows of N coefficients, rad; q0: (3,) rad, the mean pose; period: s; start: s; duration: s, end of the
    motion. Before and after it rests in `q_start`.
    """

    a: tuple
    b: tuple
    q0: tuple
    period: float
    start: float
    duration: float = field(kw_only=True)

    def _rows(self, t):
        since = t - self.start
        rows = series(self.a, self.b, self.q0, self.period, since)
        outside = (since <= 0) | (t >= self.duration)
        rows[outside, 0] = self.q_start
        rows[outside, 1:] = 0.0
        return rows

    @property
    def q_start(self):
        """Pose in which the motion begins and ends, q0 - sum b_k, (3,) rad: move there first, with `quintic`."""
        return np.array(self.q0) - np.array(self.b).sum(axis=1)

    @property
    def frequencies_hz(self):
        """Frequencies that the angles hold, (N,) Hz."""
        return np.arange(1, len(self.a[0]) + 1) / self.period


def fourier(
    a,
    b,
    *,
    period,
    q0=0.0,
    periods=1,
    record=None,
    start=0.0,
    ends="check",
    arm=None,
    max_joint_speed=None,
    table=0.0,
    margin=0.03,
):
    """Periodic motion of the three joints, from rest to rest    (4.2 corrected)

        q_i = q_i0 + sum_k=1..N [a_ik sin(k w t) - b_ik cos(k w t)],    w = 2 pi/period

    The thesis begins at k = 0, which adds a constant to q_i0, and has one a and one b for all. At t = 0 and after whole
    periods the velocity is w sum k a_ik and the acceleration w^2 sum k^2 b_ik: both sums must be 0, or the arm gets a
    jerk at the start and at the end. The record must hold whole periods: else averages over it are not those of the
    motion, and the frequencies leak into each other.

    Args:
        a, b: (3, N) rad, one row per joint. period: s. q0: rad, mean pose, one number or (3,).
        periods: whole number >= 1. record: s, length of the recording instead; it must be whole periods.
        start: s; before it the arm rests in `q_start`.
        ends: "check" refuses sums that are not 0; "adjust" takes the nearest coefficients whose sums are 0 (least
            change of all a and b); it needs N >= 2.
        arm: Arm; if given, the motion is checked against its joint limits less `margin` (rad), the speed
            `max_joint_speed` (rad/s, one number or (3,); default: half the no-load speed of the motors, without motors
            2) and the `table` (height in m below which neither elbow nor tip may go; None: no table).

    Returns: Fourier, a Reference with `.q_start` and `.frequencies_hz`.
    Raises: UnreachableError if a limit of the arm is passed, with .joint (0, 1, 2; None: table), .time (s), .value and
    .limit; InputError on wrong shapes, numbers that are not finite, ends that are not at rest, or a record that is no
    whole number of periods.
    """
    a, b = _coefficients(a, b)
    period, start = seconds("period", period, positive=True), seconds("start", start)
    periods = _whole_periods(period, periods, record)
    choice("ends", ends, ("check", "adjust"))
    if ends == "adjust":
        a, b = at_rest(a, b)
    _refuse_moving_ends(a, b)
    made = Fourier(
        a=tuple(map(tuple, a.tolist())),
        b=tuple(map(tuple, b.tolist())),
        q0=per_joint("q0", q0, unit="rad"),
        period=period,
        start=start,
        duration=start + periods * period,
    )
    if arm is not None:
        check_limits(made, arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    return made


def series(a, b, q0, period, t):
    """The bare series and its derivatives at times t (n,) s, also outside the motion: (n, 3, 3) as Reference.sample."""
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
    """The nearest coefficients with sum k a_k = 0 and sum k^2 b_k = 0, so that the motion ends at rest: (a, b).

    Args: a, b: (3, N) rad, N >= 2 (one harmonic alone cannot rest). Raises InputError.
    """
    a, b = _coefficients(a, b)
    if a.shape[1] < 2:
        raise InputError("one harmonic alone is never at rest and without acceleration at once: give N >= 2 columns")
    k = np.arange(1.0, a.shape[1] + 1)
    return a - np.outer(a @ k, k) / (k @ k), b - np.outer(b @ k**2, k**2) / (k**2 @ k**2)


def check_limits(target, arm, *, max_joint_speed=None, table=0.0, margin=0.03):
    """Refuse a Fourier motion that leaves the limits of the arm; args and errors as in `fourier`.

    Looked at on 256 points per period of the fastest harmonic. A trigonometric polynomial of degree N can exceed its
    largest value on such a grid by no more than 1/cos(pi/256) - 1 of half its range (Bernstein): that is added.
    """
    check_arm(arm)
    low, high, speed, table = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    n = _GRID * len(target.a[0])
    t = target.period * np.arange(n) / n
    rows = series(target.a, target.b, target.q0, target.period, t)
    hidden = (1 / math.cos(math.pi / _GRID) - 1) * np.ptp(rows, axis=0) / 2
    q, qd = rows[:, 0], rows[:, 1]
    for joint in range(3):
        for name, value, limit, sign, unit in (
            ("goes up to", q[:, joint], high[joint] - hidden[0, joint], 1, "rad"),
            ("goes down to", -q[:, joint], -low[joint] - hidden[0, joint], -1, "rad"),
            ("turns at", np.abs(qd[:, joint]), speed[joint] - hidden[1, joint], 1, "rad/s"),
        ):
            i = int(value.argmax())
            if value[i] > limit:
                remedy = "a longer period or smaller coefficients" if unit == "rad/s" else "another q0 or smaller ones"
                raise _too_far(
                    f"joint {joint + 1} {name} {sign * value[i]:.4g} {unit} at {t[i]:.3g} s of the period, its limit "
                    f"is {sign * limit:.4g} {unit}: choose {remedy}",
                    joint,
                    t[i],
                    sign * value[i],
                    sign * limit,
                )
    if table is None:
        return
    elbow, tip = heights(arm.l, q)
    for part, height in (("elbow", elbow), ("tip", tip)):
        i = int(height.argmin())
        if height[i] < table:
            raise _too_far(
                f"the {part} would be {1e3 * (table - height[i]):.3g} mm under the table (height {table:g} m) at "
                f"{t[i]:.3g} s of the period: raise q2 in q0, choose smaller coefficients, or give your table's height",
                None,
                t[i],
                float(height[i]),
                table,
            )


def heights(l, q):
    """Heights of elbow and tip over the base, (n,) m each; l: (3,) m; q: (n, 3) rad."""
    elbow = l[0] + l[1] * np.sin(q[:, 1])
    return elbow, elbow + l[2] * np.sin(q[:, 1] + q[:, 2])


def limits_of(arm, *, max_joint_speed=None, table=0.0, margin=0.03):
    """The bounds `fourier` checks: (q low (3,), q high (3,) rad, speed (3,) rad/s, table m or None). InputError."""
    number("margin", margin, ">= 0", unit="rad")
    if table is not None:
        number("table", table, unit="m", hint="its height, or None for no table")
    if max_joint_speed is None:
        speed = np.full(3, 2.0) if arm.actuators is None else 0.5 * arm.actuators.no_load_speed
    else:
        speed = np.array(per_joint("max_joint_speed", max_joint_speed, "> 0", unit="rad/s"))
    return np.array(arm.q_min) + margin, np.array(arm.q_max) - margin, speed, table


def _too_far(message, joint, time, value, limit):
    error = UnreachableError(message)
    error.joint, error.time, error.value, error.limit = joint, float(time), float(value), float(limit)
    return error


def _coefficients(a, b):
    arrays = []
    for name, value in (("a", a), ("b", b)):
        array = numbers(name, value, unit="rad, shape (3, N)")
        if array.ndim != 2 or array.shape[0] != 3 or array.shape[1] < 1:
            raise InputError(f"{name} has shape {array.shape}; give a row of N coefficients per joint, (3, N) (rad)")
        if not np.isfinite(array).all():
            raise InputError(f"{name} holds {first_not_finite(array)}; every coefficient must be finite (rad)")
        arrays.append(array)
    if arrays[0].shape != arrays[1].shape:
        raise InputError(f"a {arrays[0].shape} and b {arrays[1].shape}: give as many of the one as of the other")
    return arrays


def _whole_periods(period, periods, record):
    if record is not None:
        record = seconds("record", record, positive=True)
        count = round(record / period)
        if count < 1 or abs(count * period - record) > 1e-9 * record:
            raise InputError(
                f"record = {record:g} s holds {record / period:.4g} periods of {period:g} s: record "
                f"{max(count, 1) * period:g} s, or take a period of {record / max(count, 1):g} s"
            )
        return count
    if isinstance(periods, bool) or not (np.isscalar(periods) and not isinstance(periods, str) and periods >= 1):
        raise InputError(f"periods = {periods!r}: give a whole number >= 1")
    if periods != int(periods):
        raise InputError(f"periods = {periods!r}: the record must hold whole periods; give a whole number >= 1")
    return int(periods)


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
