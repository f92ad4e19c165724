"""How late one signal comes after another, from the data alone."""

import math

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, number


def measured_lag(x, y, rate_hz, *, max_lag=1.0):
    """Time by which y follows x, s: the shift at which the two are most alike (largest correlation).

    The correlation coefficient of y(t + shift) with x(t) over their common stretch, with a parabola through the three
    best shifts: finer than one sample. Negative: y leads.

    Args: x, y: (n,), sampled together; rate_hz: samples per s; max_lag: s, largest shift tried, to both sides.
    Raises InputError on shapes that do not fit, numbers that are not finite, a signal that does not move, or if the
    best shift is the largest tried.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.ndim != 1 or x.shape != y.shape:
        raise InputError(f"x {x.shape} and y {y.shape}: give two signals of the same shape (n,)")
    for name, signal in (("x", x), ("y", y)):
        if not np.isfinite(signal).all():
            raise InputError(f"{name} holds {first_not_finite(signal)}: repair that sample first")
        if np.ptp(signal) == 0:
            raise InputError(f"{name} does not move: a lag shows only in motion")
    number("rate_hz", rate_hz, "> 0")
    number("max_lag", max_lag, "> 0", unit="s")
    most = min(math.ceil(max_lag * rate_hz), len(x) // 2)
    if most < 1:
        raise InputError(
            f"{len(x)} samples are too few to shift them: give at least 4, and max_lag of a sample or more"
        )
    shifts = np.arange(-most, most + 1)
    x, y = x - x.mean(), y - y.mean()
    likeness = np.array([_likeness(x, y, k) for k in shifts])
    best = int(likeness.argmax())
    if best in (0, len(shifts) - 1):
        raise InputError(
            f"the two are most alike at the largest shift tried, {shifts[best] / rate_hz:.3g} s: raise max_lag, or "
            "give a longer stretch with motion (a steady ramp fits at any shift)"
        )
    left, here, right = likeness[best - 1 : best + 2]
    bend = left - 2 * here + right
    return float((shifts[best] + (0.5 * (left - right) / bend if bend < 0 else 0.0)) / rate_hz)


def _likeness(x, y, k):
    """Correlation coefficient of y, k samples later, with x over their common stretch; -1 where one stands still."""
    length = len(x) - abs(k)
    energies = x @ x, y @ y
    x, y = x[max(0, -k) :][:length], y[max(0, k) :][:length]
    x, y = x - x.mean(), y - y.mean()
    if x @ x <= 1e-12 * energies[0] or y @ y <= 1e-12 * energies[1]:
        return -1.0
    return x @ y / math.sqrt((x @ x) * (y @ y))
