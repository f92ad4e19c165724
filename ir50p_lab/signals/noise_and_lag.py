"""Noise against lag: every filter pays for one with the other. Numbers for one estimate of a velocity, and a lag."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite
from ir50p_lab.signals.low_pass import low_pass


@dataclass(frozen=True)
class NoiseAndLag:
    """What an estimate of a velocity is worth; made by `noise_and_lag`.

    noise: rms at rest, about its mean, rad/s. lag: s by which it is late in slow motion.
    """

    noise: float
    lag: float


def noise_and_lag(qd, truth, rate_hz, *, rest, motion):
    """How noisy an estimate of the velocity of one joint is at rest, and how late in motion.

    The lag is that of slow motion: truth and estimate pass the same zero-phase filter (2 Hz) before `measured_lag`
    compares them, which moves neither and takes away noise.

    Args:
        qd: (n,) rad/s, the estimate. rate_hz: samples per s.
        truth: (n,) rad/s, velocity to measure the lag against, such as `difference_velocity` of the record, zero-phase
            at 3 Hz, which has no lag.
        rest, motion: slice or bool mask of the stretch where the joint stands, and of one where it speeds up and slows
            down (one run of samples).

    Returns: NoiseAndLag. Raises InputError on bad shapes, or if nothing moves in `motion`.
    """
    qd, truth = np.asarray(qd, dtype=float), np.asarray(truth, dtype=float)
    for name, where in (("rest", rest), ("motion", motion)):
        if qd.ndim != 1 or truth.shape != qd.shape or len(qd[where]) < 10:
            raise InputError(f"{name}: {len(qd[where])} samples, truth {truth.shape}: give 10 or more, and (n,)")
    cutoff_hz = min(2.0, rate_hz / 10)  # the motion is slow; noise above would hide where the two are most alike
    slow = low_pass(np.column_stack([truth, qd]), cutoff_hz, rate_hz, order=2, kind="zero-phase")[motion]
    return NoiseAndLag(float(np.std(qd[rest])), measured_lag(*slow.T, rate_hz, max_lag=0.5))


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
    most = min(math.ceil(max_lag * rate_hz), len(x) // 2)
    if most < 1:
        raise InputError(f"{len(x)} samples cannot be shifted: give at least 4, and a max_lag of a sample or more")
    shifts = np.arange(-most, most + 1)
    x, y = x - x.mean(), y - y.mean()
    likeness = _likeness(x, y, shifts)
    best = int(likeness.argmax())
    if best in (0, len(shifts) - 1):
        shift = f"{shifts[best] / rate_hz:.3g} s"  # a steady ramp fits at any shift
        raise InputError(f"most alike at the largest shift tried, {shift}: raise max_lag, or give more motion")
    left, here, right = likeness[best - 1 : best + 2]
    bend = left - 2 * here + right
    return float((shifts[best] + (0.5 * (left - right) / bend if bend < 0 else 0.0)) / rate_hz)


def _likeness(x, y, shifts):
    """Correlation coefficients of x and y, `shifts` (-n..n) samples later, where they overlap; -1 if one rests."""
    length = len(x) - np.abs(shifts)
    sum_x, energy_x = _moments(x, np.maximum(0, -shifts), length)
    sum_y, energy_y = _moments(y, np.maximum(0, shifts), length)
    common = np.correlate(np.pad(y, shifts[-1]), x, "valid") - sum_x * sum_y / length
    moves = (energy_x > 1e-12 * (x @ x)) & (energy_y > 1e-12 * (y @ y))
    return np.where(moves, common / np.sqrt(np.where(moves, energy_x * energy_y, 1.0)), -1.0)


def _moments(x, start, length):
    """Sum, and energy about the mean, of x[start : start + length] for each start and length."""
    totals = (np.concatenate([[0.0], np.cumsum(one)]) for one in (x, x * x))
    total, square = (one[start + length] - one[start] for one in totals)
    return total, square - total**2 / length
