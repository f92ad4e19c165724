"""Smooth motion from rest to rest: polynomials of fifth degree in time."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.signals.reference import Reference, pose

_TIME = "a motion takes time (for a sudden change use steps)"


@dataclass(frozen=True)
class Quintic(Reference):
    """A chain of quintic pieces between poses; `quintic` and `through` make it.

    times: m increasing numbers, s; points: m poses, rad. The joints rest at points[i] at times[i].
    """

    times: tuple
    points: tuple
    duration: float

    def _rows(self, t):
        times, points = np.array(self.times), np.array(self.points)
        piece = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
        T = (times[piece + 1] - times[piece])[:, None]
        s = np.clip((t - times[piece])[:, None] / T, 0.0, 1.0)
        step = points[piece + 1] - points[piece]
        rows = np.empty((len(t), 3, 3))
        rows[:, 0] = points[piece] + step * (s**3 * (10 + s * (6 * s - 15)))
        rows[:, 1] = step * (30 * s**2 * (1 - s) ** 2) / T
        rows[:, 2] = step * (60 * s * (1 - s) * (1 - 2 * s)) / T**2
        at_end = s[:, 0] == 1.0  # exactly there, without the rounding of the polynomial
        rows[at_end, 0] = points[piece[at_end] + 1]
        return rows


def quintic(q0, q1, *, duration):
    """Move from rest at `q0` to rest at `q1`, with zero velocity and acceleration at both ends.

    q = q0 + (q1 - q0)(10 s^3 - 15 s^4 + 6 s^5),  s = t/duration

    The largest velocity is 15/8 |q1 - q0|/duration, halfway; the largest acceleration is
    10/sqrt(3) |q1 - q0|/duration^2. Before t = 0 the joints rest at q0, after the end at q1.

    Args: q0, q1: (3,) rad (may be equal); duration: s, > 0.
    Returns: Reference. Raises InputError on a wrong shape, a number that is not finite
    or a duration that is not positive.

    >>> from ir50p_lab.signals import quintic
    >>> q, qd, qdd = quintic([0, 0, 0], [1, 0, -1], duration=2)(1.0)
    >>> q.round(3)
    array([ 0.5,  0. , -0.5])
    """
    duration = number("duration", duration, "> 0", unit="s", hint=_TIME)
    return Quintic(times=(0.0, duration), points=(pose("q0", q0), pose("q1", q1)), duration=duration)


def through(points, *, durations):
    """Move through poses one after the other, resting (for an instant) at each: a chain of `quintic`.

    Two equal poses in a row make a pause.

    Args: points: (m, 3) rad, m >= 2; durations: s, one number for every piece, or (m - 1,).
    Returns: Reference. Raises InputError as `quintic` does, or if the number of durations does not fit.
    """
    points = vectors3("points", points)
    if points.ndim != 2 or len(points) < 2:
        raise InputError(f"points has shape {points.shape}; give at least two poses, shape (m, 3) with m >= 2 (rad)")
    pieces = len(points) - 1
    durations = [durations] * pieces if np.ndim(durations) == 0 else list(durations)
    if len(durations) != pieces:
        raise InputError(f"{len(durations)} durations for {pieces} pieces between {pieces + 1} points: give one each")
    lengths = [number(f"durations[{i}]", T, "> 0", unit="s", hint=_TIME) for i, T in enumerate(durations)]
    times = np.cumsum([0.0, *lengths]).tolist()
    return Quintic(times=tuple(times), points=tuple(map(tuple, points.tolist())), duration=times[-1])
