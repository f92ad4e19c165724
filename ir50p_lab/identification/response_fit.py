"""A first-order model with dead time from the recorded response of a plant to steps    (2.21)."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.recording_checks import Warnings, at_bounds, check_outliers
from ir50p_lab.identification.time_series import quantum_of, same_samples
from ir50p_lab.inputs import number
from ir50p_lab.simulation.first_order_lag import respond

_FEWEST = 8  # samples from the first change of u on: if there are fewer, four parameters cannot be judged
_ROUNDING = 1e-7  # share of the range of y: if the residual is less, it is rounding, not noise
_FOLLOWS = 15.0  # F value of the model: if it is less, y does not follow u (fits to pure noise stay below it)
_SIGNIFICANT = 9.0  # F value of one more parameter: from here on it is significant (three standard errors)
_MISSED = 0.05  # share of the variance of y: if more is left that is not white noise, the response has another shape
_MEANINGFUL = 0.8  # share of the variance of y: if the model explains less of another shape, K, T, L mean nothing
_SLOWEST = 10.0  # T over the length of the record: if it is more, T cannot be told from infinity
_SEEN = 0.99  # sampling periods: if T or L is shorter, the record does not show it
_REFINED = 5  # values of 1/T, each with its best L, that the search starts from: in L there are kinks and many minima


@dataclass(frozen=True, kw_only=True)
class FOPDT:
    """First-order plus dead time, G(s) = K exp(-L s)/(T s + 1)    (2.21)

    ========================== ==================================================== ==========
    field                      meaning                                              unit
    ========================== ==================================================== ==========
    K, T, L                    gain, time constant, dead time                       y/u, s, s
    K_stderr ... L_stderr      standard errors (nan: not fitted)                    y/u, s, s
    y0                         output at rest, before u changes                     y
    rms                        residual, root mean square                           y
    correlation                of neighbouring residuals: 0 for white noise, -1..1
    warnings                   tuple of str: doubts about this fit
    ========================== ==================================================== ==========

    To make one by hand, FOPDT(K=, T=, L=) is enough. Raises InputError if K is 0, T is not > 0 or L is not >= 0.
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
        """Return the output of the model for the input u(t), exact between the samples.

        Args: t: (n,) s, increasing; u: (n,), u[k] acts from t[k] to t[k + 1]; u_before: input at rest (default u[0]).
        Returns: (n,), in units of y. Raises InputError on wrong shapes or numbers that are not finite.
        """
        t, u = same_samples({"t": t, "u": u}, most=1)
        out = np.empty(len(t))
        respond(t, *_jumps_of(t, u, u_before), 1 / self.T, float(self.L), out)
        return self.y0 + self.K / self.T * out


def fit_fopdt(t, u, y, *, u_before=None, anyway=False):
    """Fit K, T and L of a first-order plus dead time model to a recording    (2.21)

    T dy/dt + y = y0 + K [u(t - L) - u_before] is solved exactly for an input held between samples (zero-order hold),
    with any number of steps, sampled evenly or not; y starts at rest. After one step of height h this is
    y = y0 + K h (1 - exp(-(t - t_step - L)/T)). The fit is least squares over all samples, from the best points of a
    grid.

    Standard errors come from the Jacobian and the residuals. Neighbouring residuals that are correlated (r > 0)
    carry less information than their number suggests: then the errors are widened by sqrt((1 + r)/(1 - r)). They are
    also widened by how far K, T and L move if a linear drift of y, or a y that was not yet at rest, is fitted as well,
    by the jitter of an uneven clock, and by half a step of a coarse y. In white noise two standard errors enclose the
    truth 95 times in 100. Other errors of the model are not included.

    Args:
        t: (n,) s, increasing. u: (n,), input; u[k] acts from t[k] to t[k + 1]. y: (n,), output, any unit.
        u_before: input at rest before t[0]; give it if u has its new value already in the first sample.
        anyway: go on where the data are refused and a model can be had; the reason is then in `warnings`.

    Returns: FOPDT. K is negative if y goes down after a step up. `warnings` tells of a response that is not over
    when the record ends (T is longer), of T or L below the sampling period (its error is then inf or a period), of
    an L at a bound of the search, 0 or nearly the whole record (its error is then inf), of
    correlated residuals, drift, another shape, times that look like milliseconds, and single outliers of u and y (those
    of y are left out).

    Raises:
        IdentificationError: u never changes; y does not change or does not follow u; fewer than 8 samples after the
        change; the response has quite another shape (it swings, say); y runs on like a ramp (an integrating joint: K
        and T have no value) or ever faster. Each message says what to do next.
        InputError: NaN, shapes or lengths that do not fit, time that does not increase.
    """
    record = _StepRecord(t, u, y, u_before, Warnings(anyway))
    rate, L, slope, e = record.best()
    _check_shape(record, rate, L, slope, e)
    if rate <= 0:
        raise IdentificationError("no first-order model is near this response, not even with anyway=True")
    found = np.array([slope / rate, 1 / rate, L])
    errors = record.standard_errors(found, e)
    _check_parameters(record, *found[1:], errors, e)
    units = record.y_range / record.u_range, record.seconds, record.seconds
    values = [*(found * units).tolist(), *(errors * units).tolist()]
    return FOPDT(
        **dict(zip(("K", "T", "L", "K_stderr", "T_stderr", "L_stderr"), values, strict=True)),
        y0=record.y_range * float(np.mean(record.y - slope * record.answer(rate, L))),
        rms=record.y_range * float(np.sqrt(np.mean(e**2))),
        correlation=_correlation(e)[0],
        warnings=tuple(record.warned),
    )


class _StepRecord:
    """A checked record, scaled: u first changes at 0, the record ends at 1, y has range 1, the largest jump of u is 1.

    t, y (n,); times, jumps (m,) of u; period of the samples; quantum: smallest step of y; latest: the
    longest L that is searched. seconds, y_range, u_range: the units in which t, y and u are scaled. warned: the
    Warnings so far.
    """

    def __init__(self, t, u, y, u_before, warned):
        times, jumps = _jumps_of(*same_samples({"t": t, "u": u}, most=1), u_before)  # a masked y hides no step
        t, u, y = same_samples({"t": t, "u": u, "y": y}, most=1)
        period = float(np.median(np.diff(t)))
        if period >= 1 and np.abs(t - np.rint(t)).max() < 1e-6:
            warned.add(f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000")
        check_outliers(warned, "u", t, u)
        if not len(times):
            raise IdentificationError("u never changes: record samples before the step too, or give u_before=")
        if np.ptp(y) <= 1e-12 * np.abs(y).max():
            raise IdentificationError(f"y stays at {y[0]:.6g}: check sensor and power; is the step above the friction?")
        if (after := int((t >= times[0]).sum())) < _FEWEST:
            raise IdentificationError(f"only {after} samples after the first change of u: record {_FEWEST} or more")
        places = check_outliers(warned, "y", t, y, "left out; look for their cause")
        t, y = np.delete(t, places), np.delete(y, places)
        self.seconds, self.y_range, self.u_range = float(t[-1] - times[0]), float(np.ptp(y)), float(np.abs(jumps).max())
        self.t, self.times = (t - times[0]) / self.seconds, (times - times[0]) / self.seconds
        self.y, self.jumps = y / self.y_range, jumps / self.u_range
        self.period, self.quantum = float(np.median(np.diff(self.t))), quantum_of(self.y)
        self.latest = max(0.95 - 4 * self.period, 0.15)
        self.warned = warned

    def answer(self, rate, L):
        """x (n,) of x' = u(t - L) - rate x."""
        x = np.empty(len(self.t))
        respond(self.t, self.times, self.jumps, rate, L, x)
        return x

    def best(self):
        """rate, L, slope, residuals of the least squares y = y0 + slope x, x' = u(t - L) - rate x.

        rate is 1/T, slope K/T: at rate 0 the plant integrates, below it grows, and these are points like any other.
        """
        from scipy.optimize import least_squares

        y = self.y - self.y.mean()

        def solved(p):
            x = self.answer(*p)
            x -= x.mean()
            slope = x @ y / max(x @ x, 1e-300)
            return slope, slope * x - y

        latest = self.latest - 0.05
        dead_times = np.r_[np.geomspace(0.3 * self.period, latest, 24), np.linspace(0, latest, 50)]
        rates = np.r_[-30.0, -10.0, -3.0, -1.0, -0.3, 0.0, np.geomspace(0.1, 3 / self.period, 24)]
        costs = np.array([[np.linalg.norm(solved((rate, L))[1]) for L in dead_times] for rate in rates])
        bounds = (-40.0, 0.0), (30 / self.period, self.latest)
        options = {"bounds": bounds, "x_scale": "jac", "ftol": 1e-12, "xtol": 1e-11, "gtol": 1e-14}
        likely = costs.min(axis=1).argsort()[:_REFINED]
        starts = [(rates[k], dead_times[costs[k].argmin()]) for k in likely]
        fits = [least_squares(lambda p: solved(p)[1], np.clip(start, *bounds), **options) for start in starts]
        p = min(fits, key=lambda fit: fit.cost).x
        return *p, *solved(p)

    def standard_errors(self, found, e):
        """Standard errors (3,) of K, T, L = found (3,), from numerical derivatives and the residuals e (n,).

        A linear drift and a decaying start are fitted as well. How far they move K, T and L is added: in full if they
        are significant, else in proportion to their F value.
        """

        def response(p):
            return p[0] / p[1] * self.answer(1 / p[1], p[2])

        moves = np.diag(1e-6 * np.maximum(np.abs(found), 1e-3 * self.period))
        slopes = [(response(found + move) - response(found)) / move.sum() for move in moves]
        J = np.column_stack([*slopes, np.ones_like(e)])
        A = np.column_stack([J, self.t, np.exp((self.t[0] - self.t) / found[1])])
        x = np.linalg.lstsq(A, -e)[0]
        left = e + A @ x
        spread = max(left @ left, len(e) * _ROUNDING**2) / len(e) * _correlation(left)[1] ** 2
        sure = min((e @ e - left @ left) / (_SIGNIFICANT * spread), 1.0)
        if sure == 1:
            self.warned.add("y drifts, or was not at rest at first: errors were widened; record longer rest before")
        length = np.maximum(np.linalg.norm(J, axis=0), 1e-300)  # 0 in T for a response over between two samples
        spread = math.sqrt(e @ e / (len(e) - 4)) * _correlation(e)[1]
        errors = spread * np.linalg.norm(np.linalg.pinv(J / length), axis=1) / length
        # a coarse y with less noise than half its step is always rounded the same way: no averaging
        coarse = self.quantum / 2 if e @ e < len(e) * (self.quantum / 2) ** 2 else 0.0
        late = coarse * found[1] + np.median(np.abs(np.diff(self.t) - self.period))
        return np.hypot(np.hypot(errors[:3], sure * x[:3]), [coarse, late, late])


def _jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    before = u[0] if u_before is None else number("u_before", u_before, hint="the input at rest before t[0]")
    heights = np.diff(u, prepend=before)
    return t[heights != 0], heights[heights != 0]


def _correlation(e):
    """Correlation of neighbouring residuals e (n,), and the factor by which it widens standard errors."""
    if e @ e <= len(e) * _ROUNDING**2:
        return 0.0, 1.0
    correlation = float(e[1:] @ e[:-1] / (e @ e))
    significant = correlation > 3 / math.sqrt(len(e))
    return correlation, math.sqrt((1 + correlation) / (1 - correlation)) if significant else 1.0


def _check_shape(record, rate, L, slope, e):
    """Refuse, or warn, where y does not follow u, has another shape than the model, or rises without end."""
    warned, n, rss, total = record.warned, len(e), e @ e, np.sum((record.y - record.y.mean()) ** 2)
    correlation, wider = _correlation(e)
    F = (total - rss) / 3 / (max(rss, n * _ROUNDING**2) / (n - 4))
    explained = 1 - rss / total
    not_white = rss - np.sum(np.diff(e, 2) ** 2) / 6 * n / (n - 2)  # sum: 6 rss for white noise, 0 for slow e
    if F < _FOLLOWS or (F / wider**2 < _FOLLOWS and explained < 0.5):
        warned.refuse(f"y does not follow u ({explained:.1%} explained): make a larger step, or average recordings")
    elif not_white > _MISSED * total and correlation > 0.5:
        said = f"the response does not have the shape of the model ({explained:.0%} explained)"
        doubt = warned.refuse if explained < _MEANINGFUL else warned.add
        doubt(f"{said}: drift, a limit, a swing? Fit a swing by scipy's least_squares with control.forced_response")
    if rate * (1 - L) < 1 / _SLOWEST:
        value = f"only K/T has a value, {slope * record.y_range / record.u_range / record.seconds:.4g} y/u per s"
        said = "the response runs on like a ramp, or faster: the plant integrates (as angles do), is unstable or slow"
        warned.refuse(f"{said}; {value}: fit the velocity and tune by the rule of notebook 09, or record longer")


def _check_parameters(record, T, L, errors, e):
    """Warn of T or L that the record does not show; below a period, their errors (3,) become inf, or a period."""
    warned, period, seconds = record.warned, record.period, record.seconds
    if T < _SEEN * period:
        warned.add(f"the time constant is not identifiable, {T / period:.2f} of the sampling period: sample faster")
        errors[1:] = math.inf
    elif L < _SEEN * period:
        warned.add(f"the dead time is not identifiable, {L / period:.2f} of a sampling period: use no rule with 1/L")
        errors[2] = max(errors[2], period)
    elif L < 2 * errors[2]:
        warned.add(f"dead time {L * seconds:.3g} s is less than two standard errors: it cannot be told from zero")
    said, at = at_bounds(["L"], np.array([L * seconds]), 0.0, record.latest * seconds, 1e-3 * period * seconds)
    warned.extend(said)
    errors[2] = math.inf if at else errors[2]
    if T > 1 - L:
        warned.add(f"not settled: T = {T * seconds:.4g} s, {(1 - L) * seconds:.4g} s of response recorded; record 3 T")
    correlation, wider = _correlation(e)
    if wider > 1:
        warned.add(f"residuals are not white (correlation {correlation:.2f}): errors were widened by {wider:.1f}")
