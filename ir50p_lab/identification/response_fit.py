"""Fits to a recorded step response, what the first and the second order share: the record, the plant, the errors."""

import math

import numpy as np
from numba import njit

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.columns import same_samples
from ir50p_lab.identification.doubts import Doubts, check_outliers
from ir50p_lab.inputs import number

_FEWEST = 8  # samples from the first change of u on: twice the number of parameters
NOISE = 1e-7  # residuals below this share of the response are rounding, not noise
_STARTS = 3  # rows of the grid whose best points are refined: the sum of squares has kinks and side valleys in L
_SMALL = 1e-4  # below this a dt, series keep the digits that (1 - exp(-a dt))/a loses
_STEP = 1e-6  # of a parameter's size, for differences


@njit(cache=True)
def respond(t, jump_times, jumps, a, L, out):
    """x' = v(t - L) - a x from x = 0, exactly, with dead time L of any size (no multiple of a period).

    v is the sum of the jumps that have happened. a = 0 integrates, a < 0 grows, a complex one swings. Writes x at the
    times t (n,), increasing, into out (n,), of the type of a; jump_times (m,), increasing, none before t[0].
    """
    x, v, now, k = 0.0 * a, 0.0, t[0], 0
    for i in range(len(t)):
        while True:
            jump = k < len(jumps) and jump_times[k] + L <= t[i]
            dt = (jump_times[k] + L if jump else t[i]) - now
            z = a * dt
            gone = -np.expm1(-z)
            x = x * (1 - gone) + v * (dt * (1 - z / 2 + z * z / 6) if abs(z) < _SMALL else gone / a)
            now += dt
            if not jump:
                break
            v += jumps[k]
            k += 1
        out[i] = x


def best_fit(columns, y, starts, bounds):
    """Least squares y = columns(p) c over p, and over c, exactly for each p.

    starts: rows of p; from the best of each of the best rows the fit is refined. bounds: (low, high) of p.
    Returns: p, c, residuals.
    """
    from scipy.optimize import least_squares

    def solved(p):
        A = columns(p)
        c = np.linalg.lstsq(A, y, rcond=None)[0]
        return c, A @ c - y

    def cost(A):  # the quick way, for comparing: y less its projection, in normal equations
        b = A.T @ y
        return y @ y - b @ np.linalg.lstsq(A.T @ A, b, rcond=None)[0]

    costs = np.array([[cost(columns(p)) for p in row] for row in starts])
    exact = {"x_scale": "jac", "ftol": 1e-12, "xtol": 1e-11, "gtol": 1e-14}
    fits = [
        least_squares(lambda p: solved(p)[1], np.clip(starts[k][costs[k].argmin()], *bounds), bounds=bounds, **exact)
        for k in costs.min(axis=1).argsort()[:_STARTS]
    ]
    best = min(fits, key=lambda fit: fit.cost)
    return best.x, *solved(best.x)


def likeness(e):
    """Correlation of neighbouring residuals e (n,), in units of the response, and how much wider errors are for it."""
    if e @ e <= len(e) * NOISE**2:
        return 0.0, 1.0
    correlation = float(e[1:] @ e[:-1] / (e @ e))
    if correlation <= 3 / math.sqrt(len(e)):
        return correlation, 1.0
    return correlation, math.sqrt((1 + correlation) / (1 - correlation))


def standard_errors(response, p, sizes, e):
    """Of the parameters p of response(p), beside an offset, from residuals e (n,), widened for their likeness.

    sizes: of the parameters, for differences.
    """
    here = response(p)
    J = [(response(p + step) - here) / step.sum() for step in np.diag(_STEP * np.abs(sizes))]
    J = np.column_stack([np.ones_like(e), *J])
    length = np.linalg.norm(J, axis=0)
    spread = math.sqrt(e @ e / (len(e) - J.shape[1])) * likeness(e)[1]
    return (spread * np.linalg.norm(np.linalg.pinv(J / length), axis=1) / length)[1:]


def by_name(names, values, errors):
    """{name: value, name_stderr: error} of a fit, all float."""
    pairs = zip((*names, *(f"{name}_stderr" for name in names)), (*values, *errors), strict=True)
    return {name: float(x) for name, x in pairs}


def recorded(**columns):
    """Columns of a recording as float arrays: one dimension, one length, finite; `t` increasing. Raises InputError."""
    arrays = same_samples(columns)
    for name, array in arrays.items():
        if array.ndim != 1:
            raise InputError(f"{name} has shape {array.shape}; give one value per sample, shape (n,)")
    return arrays.values()


def jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    before = u[0] if u_before is None else number("u_before", u_before, hint="the input at rest before t[0]")
    heights = np.diff(u, prepend=before)
    return t[heights != 0], heights[heights != 0]


class StepRecord:
    """t, y (n,), times and jumps (m,) of u without outliers: first change of u at 0, end at 1, ranges of y and u 1.

    unit: s; y_unit, gain (y/u): what these ones are; y_first: y at 0; period: of the samples. doubts: about them.
    """

    def __init__(self, t, u, y, u_before, anyway=False):
        t, u, y = recorded(t=t, u=u, y=y)
        times, jumps = jumps_of(t, u, u_before)
        self.doubts = Doubts(anyway)
        self._check(t, u, y, times)
        places = check_outliers(self.doubts, "y", t, y, "left out; look for their cause")
        t, y = np.delete(t, places), np.delete(y, places)
        self.unit, self.y_unit, self.y_first = float(t[-1] - times[0]), float(np.ptp(y)), float(y[0])
        self.gain = self.y_unit / float(np.abs(jumps).max())
        self.t, self.times = (t - times[0]) / self.unit, (times - times[0]) / self.unit
        self.y, self.jumps = (y - y[0]) / self.y_unit, jumps / np.abs(jumps).max()
        self.period = float(np.median(np.diff(self.t)))

    def _check(self, t, u, y, times):
        steps = np.diff(t)
        period = float(np.median(steps))
        counted = np.abs(t - np.rint(t)).max() < 1e-6
        jitter = np.ptp(steps) / period  # of a computer's clock
        if (period >= 1 and counted) or (period >= 5 and 1e-6 < jitter < 1):
            self.doubts.add(f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000")
        check_outliers(self.doubts, "u", t, u)
        if not len(times):
            raise IdentificationError("u never changes: record samples before the step too, or give u_before=")
        if np.ptp(y) <= 1e-12 * np.abs(y).max():
            raise IdentificationError(f"y stays at {y[0]:.6g}: check sensor and power; is the step above the friction?")
        after = int((t >= times[0]).sum())
        if after < _FEWEST:
            raise IdentificationError(f"only {after} samples from the first change of u on: record {_FEWEST} or more")

    def respond(self, a, L):
        """x (n,) of x' = v(t - L) - a x."""
        x = np.empty(len(self.t), dtype=type(a))
        respond(self.t, self.times, self.jumps, a, L, x)
        return x
