"""Least squares for the answer of a linear plant to an input that jumps: shared by the first and the second order."""

import math

import numpy as np
from numba import njit

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
