"""A first-order model with dead time from a plant's recorded answer to steps    (2.21)."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.checks import Warnings, check_outliers
from ir50p_lab.identification.columns import same_samples
from ir50p_lab.inputs import number
from ir50p_lab.simulation.first_order_lag import respond

_FEWEST = 8  # samples from the first change of u on: twice the number of parameters
_FOLLOWS = 15.0  # least F value for "y follows u": a search over T and L in pure noise stays below it
_SHAPE = 0.05  # share of the variance of y that may be left and be alike over time
_SLOWEST = 10.0  # a time constant longer than this many records cannot be told from infinity


@dataclass(frozen=True, kw_only=True)
class FOPDT:
    """First-order plus dead time, G(s) = K exp(-L s)/(T s + 1)    (2.21)

    K y/u, T s, L s with standard errors ..._stderr (nan: not fitted); y0: output at rest; rms of the residual;
    correlation of neighbouring residuals, 0 for white noise; warnings: tuple of str. By hand, FOPDT(K=, T=, L=).
    Raises InputError if K is 0 or T is not > 0 or L is not >= 0.
    """

    K: float
    T: float
    L: float
    K_stderr: float = math.nan
    T_stderr: float = math.nan
    L_stderr: float = math.nan
    y0: float = 0.0
    rms: float = math.nan
    correlation: float = math.nan
    warnings: tuple = ()

    def __post_init__(self):
        if not (math.isfinite(self.K + self.T + self.L) and self.K != 0 and self.T > 0 and self.L >= 0):
            raise InputError(f"K, T, L = {self.K}, {self.T}, {self.L}: give finite K != 0, T > 0 s and L >= 0 s")

    def response(self, t, u, *, u_before=None):
        """Output (n,) for the input u[k] from t[k] to t[k + 1] s, exact; u_before: input at rest (default u[0])."""
        t, u = same_samples({"t": t, "u": u}, most=1)
        out = np.empty(len(t))
        respond(t, *_jumps(t, u, u_before), 1 / self.T, float(self.L), out)
        return self.y0 + self.K / self.T * out


def fit_fopdt(t, u, y, *, u_before=None, anyway=False):
    """Fit K, T and L of a first-order plus dead time model to a recording    (2.21)

    T dy/dt + y = y0 + K [u(t - L) - u_before], solved exactly for an input held between samples, with any number of
    steps; y starts at rest. Least squares over all samples, from the best points of a grid. Standard errors from the
    Jacobian and the residuals, widened where neighbouring residuals are alike.

    Args: t (n,) s; u (n,), u[k] acts from t[k] to t[k + 1]; y (n,); u_before: input at rest before t[0]; anyway: go on
    where the data are refused. Returns: FOPDT. Raises: IdentificationError if u or y never changes, y does not follow
    u, has another shape, or runs on like a ramp; InputError for NaN, shapes, times that do not increase.
    """
    times, jumps = _jumps(*same_samples({"t": t, "u": u}, most=1), u_before)  # a masked y hides no step
    t, u, y = same_samples({"t": t, "u": u, "y": y}, most=1)
    warned, period = Warnings(anyway), float(np.median(np.diff(t)))
    if period >= 1:
        warned.add(f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000")
    if not len(times):
        raise IdentificationError("u never changes: record samples before the step too, or give u_before=")
    if np.ptp(y) <= 1e-12 * np.abs(y).max():
        raise IdentificationError(f"y stays at {y[0]:.6g}: check sensor and power; is the step above the friction?")
    if (after := int((t >= times[0]).sum())) < _FEWEST:
        raise IdentificationError(f"only {after} samples from the first change of u on: record {_FEWEST} or more")
    places = check_outliers(warned, "y", t, y, "left out; look for their cause")
    t, y = np.delete(t, places), np.delete(y, places)
    record, size = float(t[-1] - times[0]), float(np.ptp(y))

    def model(p):  # K in ranges of y, T and L in records
        out = np.empty(len(t))
        respond(t, times, jumps, math.exp(-p[0]) / record, p[1] * record, out)
        return out * math.exp(-p[0]) / record

    def solved(p):
        A = np.column_stack([model(p), np.ones_like(t)])
        c = np.linalg.lstsq(A, y / size, rcond=None)[0]
        return c, A @ c - y / size

    (log_T, L), (K, y0), e = _best(solved, period / record)
    T, rss, n = math.exp(log_T), float(e @ e), len(e)
    total, correlation = float(np.sum((y / size - np.mean(y / size)) ** 2)), float(e[1:] @ e[:-1] / max(e @ e, 1e-300))
    exact = rss <= n * 1e-14
    correlation = 0.0 if exact else correlation
    alike = math.sqrt((1 + correlation) / (1 - correlation)) if correlation > 3 / math.sqrt(n) else 1.0
    explained = 1 - rss / total
    if (total - rss) / 3 / max(rss / (n - 4), 1e-300) < _FOLLOWS * alike**2 and explained < 0.5:
        warned.refuse(f"y does not follow u ({explained:.1%} explained): make a larger step, or average recordings")
    elif rss > _SHAPE * total and correlation > 0.5:
        warned.refuse(f"the response has not the shape of the model ({explained:.0%} explained): swings, loads, limits?")
    elif T > _SLOWEST:
        slope = f"only K/T has a value, about {K * size / (T * record):.4g} y/u per s"
        warned.refuse(f"the response runs on like a ramp: the plant integrates (as angles do) or is slow; {slope}")

    def response(p):
        return p[0] * model((math.log(p[1]), p[2]))

    here = np.array([K, T, L])
    moves = 1e-6 * np.maximum(np.abs(here), [0.0, 0.0, period / record])
    J = np.column_stack([(response(here + move) - response(here)) / move.sum() for move in np.diag(moves)] + [e * 0 + 1])
    drift = np.column_stack([J, (t - t[0]) / record])
    left = e - drift @ np.linalg.lstsq(drift, e, rcond=None)[0]
    if not exact and (rss - left @ left) / max(left @ left / n, 1e-300) > 9 * alike**2:
        warned.add("y drifts: record longer rest before the step, or steps to both sides")
    spread = math.sqrt(rss / (n - 4)) * alike
    length = np.linalg.norm(J, axis=0)
    errors = spread * np.linalg.norm(np.linalg.pinv(J / length), axis=1)[:3] / length[:3]
    for name, value, error in (("time constant", T, errors[1]), ("dead time", L, errors[2])):
        if value < 0.99 * period / record:
            warned.add(f"the {name} is not identifiable, {value * record / period:.2f} of a sampling period")
        elif value < 2 * error:
            warned.add(f"{name} {value * record:.3g} s is less than two standard errors: it cannot be told from none")
    if (seen := int((t >= times[0] + L * record).sum())) < 20:
        warned.add(f"only {seen} samples of the response: too few to see whether the model is right; sample faster")
    if T > 1 - L:
        warned.add(f"not settled: T = {T * record:.4g} s, {(1 - L) * record:.4g} s of response recorded; record 3 T")
    if alike > 1:
        warned.add(f"residuals are not white (correlation {correlation:.2f}): errors were widened by {alike:.1f}")
    units = np.array([size, record, record])
    names = [*"KTL", *(f"{name}_stderr" for name in "KTL")]
    values = (np.r_[here * units, errors * units]).tolist()
    return FOPDT(
        **dict(zip(names, values, strict=True)),
        y0=float(y0 * size),
        rms=size * math.sqrt(rss / n),
        correlation=correlation,
        warnings=tuple(warned),
    )


def _jumps(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    before = u[0] if u_before is None else number("u_before", u_before, hint="the input at rest before t[0]")
    heights = np.diff(u, prepend=before)
    return t[heights != 0], heights[heights != 0]


def _best(solved, period):
    """(log T, L), (K, y0) and residuals of the best fit: refined from the best points of a grid; 1 is the record."""
    from scipy.optimize import least_squares

    grid = [(a, L) for a in np.log(np.geomspace(period / 3, 30, 30)) for L in np.r_[np.linspace(0, 0.9, 60), period]]
    costs = [np.linalg.norm(solved(p)[1]) for p in grid]
    bounds = (math.log(period / 30), 0.0), (math.log(100), 0.95)
    options = {"bounds": bounds, "x_scale": "jac", "ftol": 1e-12, "xtol": 1e-11, "gtol": 1e-14}
    fits = [least_squares(lambda p: solved(p)[1], grid[k], **options) for k in np.argsort(costs)[[0, 1, 2, 5, 10]]]
    best = min(fits, key=lambda fit: fit.cost)
    return best.x, *solved(best.x)
