"""Models of a plant from its recorded answer to steps: first order with dead time (2.21), second order with a zero."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.checks import Warnings, check_outliers
from ir50p_lab.identification.columns import quantum_of, same_samples
from ir50p_lab.inputs import number
from ir50p_lab.simulation.first_order_lag import respond

_FEWEST = 8  # samples from the first change of u on: twice the number of parameters
_NOISE = 1e-7  # residuals below this share of the response are rounding, not noise
_STARTS = 5  # rows of the grid whose best points are refined: the sum of squares has kinks and side valleys in L
_STEP = 1e-6  # of a parameter's size, for differences
_RESPONSE = 15.0  # least F value for "y follows u": a search over T and L in pure noise stays below it
_SHAPE = 0.05  # largest share of the variance of y that may be left and not be white: 20-40 % of overshoot
_SWINGS = 0.5  # of what is left of y: if a second-order model leaves less, it is the one to take
_SIGNIFICANT = 9.0  # F value of one more parameter, a bend or a drift, that is surely there: three standard errors
_COARSE = 1 / 60  # of the range of y: a response in fewer steps than these, not mixed by noise, misleads
_ENOUGH = 20  # samples of a response, five for each parameter, from which on its shape can be judged
_SEEN = 0.99  # sampling periods: a time constant or dead time below is not seen
_SLOWEST = 10.0  # a time constant longer than this many records cannot be told from infinity
_BETTER = 12.0  # least F value of a zero
_DAMPING = (0.02, 10.0)
_GRID = (0.1, 0.35, 0.8, 2.0)
_NAMES = ("K", "w", "damping", "L", "zero")


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

    costs = np.array([[np.linalg.norm(solved(p)[1]) for p in row] for row in starts])
    exact = {"x_scale": "jac", "ftol": 1e-12, "xtol": 1e-11, "gtol": 1e-14}
    likely = [starts[k][costs[k].argmin()] for k in costs.min(axis=1).argsort()[:_STARTS]]
    fits = [least_squares(lambda p: solved(p)[1], np.clip(p, *bounds), bounds=bounds, **exact) for p in likely]
    best = min(fits, key=lambda fit: fit.cost)
    return best.x, *solved(best.x)


def likeness(e):
    """Correlation of neighbouring residuals e (n,), in units of the response, and how much wider errors are for it."""
    if e @ e <= len(e) * _NOISE**2:
        return 0.0, 1.0
    correlation = float(e[1:] @ e[:-1] / (e @ e))
    significant = correlation > 3 / math.sqrt(len(e))
    return correlation, math.sqrt((1 + correlation) / (1 - correlation)) if significant else 1.0


def jacobian(response, p, sizes):
    """Columns of response(p) by an offset and by the parameters p, from differences; sizes: of the parameters."""
    here = response(p)
    J = [(response(p + step) - here) / step.sum() for step in np.diag(_STEP * np.abs(sizes))]
    return np.column_stack([np.ones_like(here), *J])


def standard_errors(J, e):
    """Of the parameters of a jacobian J without the offset, from residuals e (n,), widened for their likeness."""
    length = np.linalg.norm(J, axis=0)
    spread = math.sqrt(e @ e / (len(e) - J.shape[1])) * likeness(e)[1]
    seen = length > 0  # what the response does not depend on at all has no error: it is not known
    errors = np.full(len(length), np.inf)
    errors[seen] = spread * np.linalg.norm(np.linalg.pinv(J[:, seen] / length[seen]), axis=1) / length[seen]
    return errors[1:]


def by_name(names, values, errors):
    """{name: value, name_stderr: error} of a fit, all float."""
    pairs = zip((*names, *(f"{name}_stderr" for name in names)), (*values, *errors), strict=True)
    return {name: float(x) for name, x in pairs}


def jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    before = u[0] if u_before is None else number("u_before", u_before, hint="the input at rest before t[0]")
    heights = np.diff(u, prepend=before)
    return t[heights != 0], heights[heights != 0]


class StepRecord:
    """t, y (n,), times and jumps (m,) of u without outliers: first change of u at 0, end at 1, ranges of y and u 1.

    unit: s; y_unit, gain (y/u): what these ones are; y_first: y at 0; period: of the samples. warned: about them.
    """

    def __init__(self, t, u, y, u_before, anyway=False):
        times, jumps = jumps_of(*same_samples({"t": t, "u": u}, most=1), u_before)  # a masked y hides no step
        t, u, y = same_samples({"t": t, "u": u, "y": y}, most=1)
        self.warned = Warnings(anyway)
        steps = np.diff(t)
        period, counted = float(np.median(steps)), np.abs(t - np.rint(t)).max() < 1e-6
        if (period >= 1 and counted) or (period >= 5 and 1e-6 < np.ptp(steps) / period < 1):  # a clock's jitter
            self.warned.add(f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000")
        check_outliers(self.warned, "u", t, u)
        if not len(times):
            raise IdentificationError("u never changes: record samples before the step too, or give u_before=")
        if np.ptp(y) <= 1e-12 * np.abs(y).max():
            raise IdentificationError(f"y stays at {y[0]:.6g}: check sensor and power; is the step above the friction?")
        if (after := int((t >= times[0]).sum())) < _FEWEST:
            raise IdentificationError(f"only {after} samples from the first change of u on: record {_FEWEST} or more")
        places = check_outliers(self.warned, "y", t, y, "left out; look for their cause")
        t, y = np.delete(t, places), np.delete(y, places)
        self.unit, self.y_unit, self.y_first = float(t[-1] - times[0]), float(np.ptp(y)), float(y[0])
        self.gain = self.y_unit / float(np.abs(jumps).max())
        self.t, self.times = (t - times[0]) / self.unit, (times - times[0]) / self.unit
        self.y, self.jumps = (y - y[0]) / self.y_unit, jumps / np.abs(jumps).max()
        self.period, self.quantum = float(np.median(np.diff(self.t))), quantum_of(self.y)

    def coarse(self, e):
        """Half a step of y, with a warning if they are few, if the residuals e (n,) do not mix them; else 0.

        Such errors do not average.
        """
        if e @ e >= len(e) * (self.quantum / 2) ** 2:
            return 0.0
        if self.quantum > _COARSE:
            self.warned.add(f"y takes about {1 / self.quantum:.0f} steps only: errors were widened; use a finer range")
        return self.quantum / 2

    def columns(self, a, L):
        """(n, 2): x of x' = v(t - L) - a x, and 1."""
        out = np.ones((2, len(self.t)))
        respond(self.t, self.times, self.jumps, a, L, out[0])
        return out.T


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
    warnings                   tuple of str: what to mind about this fit
    ========================== ==================================================== ==========

    By hand, FOPDT(K=, T=, L=) is enough. Raises InputError if K is 0 or T is not > 0 or L is not >= 0.
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
        """Output of the model for the input u(t), exact between the samples.

        Args: t: (n,) s, increasing; u: (n,), u[k] acts from t[k] to t[k + 1]; u_before: input at rest (default u[0]).
        Returns: (n,), in units of y. Raises InputError on wrong shapes or numbers that are not finite.
        """
        t, u = same_samples({"t": t, "u": u}, most=1)
        out = np.empty(len(t))
        respond(t, *jumps_of(t, u, u_before), 1 / self.T, float(self.L), out)
        return self.y0 + self.K / self.T * out


def fit_fopdt(t, u, y, *, u_before=None, anyway=False):
    """Fit K, T and L of a first-order plus dead time model to a recording    (2.21)

    T dy/dt + y = y0 + K [u(t - L) - u_before], solved exactly for an input held between samples (zero-order hold), with
    any number of steps, sampled evenly or not; y starts at rest. After one step of height h this is
    y = y0 + K h (1 - exp(-(t - t_step - L)/T)). Least squares over all samples, from the best points of a grid.

    Standard errors come from the Jacobian at the solution and the spread of the residuals. They are right for white
    noise. Neighbouring residuals that are alike (drift, a filter, a model that does not quite fit) carry less
    information than their number: where the lag-one correlation r is significant, the errors are widened by
    sqrt((1 + r)/(1 - r)), and a warning says so. Where y drifts in a line, or was on its way to rest at first, the
    errors are widened by what it moves, with a warning if it is significant and by a part of it if not; by the jitter
    of an uneven clock and by half a step of a coarse y they are widened without one. Measured over 200 seeds, 500
    samples, one step and many: two standard errors held the truth 92-98 times in 100 in white noise and up to
    r = 0.9, 87 times or more at r = 0.97. Of other errors of the model they know nothing. One step cannot tell a drift
    that is not significant from a slow end of the response: it may still move K and T by several standard errors.
    Several steps to both sides tell it.

    Args:
        t: (n,) s, increasing. u: (n,), input; u[k] acts from t[k] to t[k + 1]. y: (n,), output, any unit.
        u_before: input at rest before t[0]; give it if u has its new value already in the first sample.
        anyway: go on where the data are refused and a model can be had; the reason is then in `warnings`.

    Returns: FOPDT. K is negative where y answers a step up by going down. `warnings` tells of a response that is not
    over when the record ends (T longer than it), of T or L below the sampling period (not identifiable, the error is
    then inf or a period), of correlated residuals, drift, a start that was no rest, another shape, times that look like
    milliseconds, and single outliers, which are left out.

    Raises:
        IdentificationError: u never changes; y does not change or does not follow u; fewer than 8 samples after the
        change; y swings, so that `fit_second_order` leaves far less of it; y runs on like a ramp (an integrating
        joint: K and T have no value) or ever faster. Each says what to do next.
        InputError: NaN, shapes or lengths that do not fit, time that does not increase.
    """
    record = StepRecord(t, u, y, u_before, anyway)
    warned, period = record.warned, record.period
    (a, L), (b, y0), e = _first_order(record)
    _check_shape(record, a, L, b, e)
    if a <= 0:
        raise IdentificationError("no first-order model is near this response, not even with anyway=True")

    def response(p):
        return p[0] / p[1] * record.columns(1 / p[1], p[2])[:, 0]

    found = np.array([b / a, 1 / a, L])
    units = record.gain, record.unit, record.unit
    J = jacobian(response, found, np.maximum(np.abs(found), 1e-3 * period))
    errors = np.hypot(standard_errors(J, e), _systematic_errors(record, a, J, e)) * units
    _warn(record, 1 / a, L, errors[2] / record.unit, *likeness(e))
    if a * period > 1 / _SEEN:
        errors[1:] = math.inf
    if L < _SEEN * period:
        errors[2] = max(errors[2], period * record.unit)
    return FOPDT(
        **by_name("KTL", found * units, errors),
        y0=float(record.y_unit * y0 + record.y_first),
        rms=record.y_unit * float(np.sqrt(np.mean(e**2))),
        correlation=likeness(e)[0],
        warnings=tuple(warned),
    )


def _first_order(record):
    """(a, L), (b, y0) and residuals of y = y0 + b x, x' = v(t - L) - a x: 1/T is a, K/T is b.

    The rate a is fitted, not T, because 0 (the plant integrates) and below (it grows) are then points like any other.
    """
    latest = max(0.9 - 4 * record.period, 0.1)
    dead_times = np.r_[np.geomspace(0.3 * record.period, latest, 24), np.linspace(0, latest, 50)]
    rates = np.r_[-30.0, -10.0, -3.0, -1.0, -0.3, 0.0, np.geomspace(0.1, 3 / record.period, 24)]
    starts = [[(a, L) for L in dead_times] for a in rates]
    return best_fit(lambda p: record.columns(*p), record.y, starts, ((-40.0, 0.0), (30 / record.period, latest + 0.05)))


def _check_shape(record, a, L, b, e):
    """Refuse where y does not follow u at all, in a way that no FOPDT model has, or without end."""
    warned, n, rss, total = record.warned, len(e), e @ e, np.sum((record.y - record.y.mean()) ** 2)
    correlation, inflation = likeness(e)

    def F(more, parameters):  # how much better the model is than one with fewer parameters, that leaves `more`
        return (more - rss) / parameters / (max(rss, n * _NOISE**2) / (n - 4))

    follows, explained = F(total, 3), 100 * (1 - rss / total)
    not_white = rss - np.sum(np.diff(e, 2) ** 2) / 6 * n / (n - 2)  # second differences pass only the white noise
    shape = f"the response has not the shape of the model ({explained:.0f} % explained)"
    misshapen = follows >= _RESPONSE and not_white > _SHAPE * total and correlation > 0.5
    if misshapen and np.sum(_second_order(record)[0][2] ** 2) < _SWINGS * rss:
        warned.refuse(f"{shape}, a second-order model leaves far less: take fit_second_order(t, u, y)")
    elif follows < _RESPONSE or (follows / inflation**2 < _RESPONSE and explained < 50):
        warned.refuse(f"y does not follow u ({explained:.1f} % explained): make a larger step, or average recordings")
    elif misshapen:
        warned.add(f"{shape}: y is disturbed or drifts, or a dead zone or limit acts; do not use it yet")
    ramp = best_fit(lambda p: record.columns(0.0, *p), record.y, [[(k / 50,)] for k in range(45)], (0.0, 0.95))[2]
    if a * (1 - L) > 1 / _SLOWEST and F(ramp @ ramp, 1) / inflation**2 > _SIGNIFICANT:
        return
    value = f"only K/T has a value, {b * record.gain / record.unit:.4g} y/u per s"
    said = "the response runs on like a ramp, or ever faster: the plant integrates (as angles do), is unstable or slow"
    warned.refuse(f"{said}; {value}: fit the velocity and tune with simc_integrating, or record longer")


def _systematic_errors(record, a, J, e):
    """(3,) of K, T and L: what they move by beside a drift, or a rest at first that was none.

    Where such a flaw is significant it counts in full, and a warning is added; else in the proportion of its F value to
    a significant one, so that noise alone hardly widens the errors.

    An uneven clock is late now and then, perhaps at the step itself: T and L are no surer than its usual jitter. Coarse
    steps of y, not mixed by noise, do not average: half of one remains.
    """
    coarse = record.coarse(e)
    clock = np.median(np.abs(np.diff(record.t) - record.period))
    moved = np.array([coarse, coarse / a + clock, coarse / a + clock])
    others = {"y drifts by": record.t, "y was not at rest at first, but away by": np.exp(-a * (record.t - record.t[0]))}
    for what, column in others.items():
        A = np.column_stack([J, column])
        x = np.linalg.lstsq(A, -e)[0]
        left = e + A @ x
        spread = max(left @ left, len(e) * _NOISE**2) / (len(e) - A.shape[1]) * likeness(left)[1] ** 2
        sure = min((e @ e - left @ left) / (_SIGNIFICANT * spread), 1.0)
        moved = np.hypot(moved, sure * x[1:4])
        if sure == 1:
            size = f"{100 * abs(x[-1]) * np.ptp(column):.2g} % of its range"
            record.warned.add(f"{what} {size}: errors were widened; record longer rest before the step")
    return moved


def _warn(record, T, L, L_stderr, correlation, inflation):
    """What is to be minded about a fit that is not refused."""
    warned, period, unit = record.warned, record.period, record.unit
    if T < _SEEN * period:
        warned.add(f"the time constant is not identifiable, {T / period:.2f} of the sampling period: sample faster")
    elif L < _SEEN * period:
        warned.add(f"the dead time is not identifiable, {L / period:.2f} of a sampling period: use no rule with 1/L")
    elif L < 2 * L_stderr:
        warned.add(f"dead time {L * unit:.3g} s is less than two standard errors: it cannot be told from none")
    if (seen := int((record.t >= L).sum())) < _ENOUGH:
        warned.add(f"only {seen} samples of the response: too few to see whether the model is right; sample faster")
    if T > 1 - L:
        warned.add(f"not settled: T = {T * unit:.4g} s, but {(1 - L) * unit:.4g} s of response recorded; record 3 T")
    if inflation > 1:
        warned.add(f"residuals are not white (correlation {correlation:.2f}): errors were widened by {inflation:.1f}")


@dataclass(frozen=True, kw_only=True)
class SecondOrderModel:
    """G(s) = K (zero s + 1) exp(-L s)/((s/w)^2 + 2 damping s/w + 1)

    K: y/u; w: rad/s; damping: 1; zero: s, 0 without one, < 0 starts the wrong way; L: s; each with a standard error
    ..._stderr (nan: not fitted); y0: output at rest; fit: 100 (1 - |e|/|y - mean y|) %.
    """

    K: float
    w: float
    damping: float
    zero: float = 0.0
    L: float
    K_stderr: float = math.nan
    w_stderr: float = math.nan
    damping_stderr: float = math.nan
    zero_stderr: float = math.nan
    L_stderr: float = math.nan
    y0: float = 0.0
    fit: float = math.nan
    warnings: tuple = ()

    def response(self, t, u, *, u_before=None):
        """Output for the input u(t), (n,), exact between the samples; arguments as in `FOPDT.response`."""
        t, u = same_samples({"t": t, "u": u}, most=1)
        basis = _basis(t, *jumps_of(t, u, u_before), self.w, self.damping, self.L)
        return self.y0 + basis @ [self.K, self.K * self.zero]


def _basis(t, times, jumps, w, damping, L):
    """(n, 2): the answers of w^2/(s^2 + 2 damping w s + w^2), and of s times that."""
    damping += 1e-6 * (abs(damping - 1) < 1e-6)  # equal poles: a little apart
    root = w * np.sqrt(complex(damping**2 - 1))
    poles = damping * w + root, damping * w - root
    fast, slow = modes = np.empty((2, len(t)), dtype=complex)
    for a, out in zip(poles, modes, strict=True):
        respond(t, times, jumps, a, L, out)
    plain, slope = slow - fast, poles[0] * fast - poles[1] * slow
    return (np.column_stack([plain, slope]) * w**2 / (2 * root)).real


def _second_order(record):
    """The fit to take, the one with a zero, and the basis (n, 2) as function of p.

    A fit: p = (log w, damping, L), c = (offset, K and perhaps K zero), residuals.
    """
    t, y, period, n = record.t, record.y, record.period, len(record.t)
    dead_times = np.r_[np.arange(4) * period, np.geomspace(5 * period, 0.45, 9)]
    starts = [[(math.log(w), d, L) for w in np.geomspace(3, 0.5 / period, 12) for d in _GRID] for L in dead_times]
    bounds = ([math.log(0.1), _DAMPING[0], 0.0], [math.log(3 / period), _DAMPING[1], 0.5])

    def basis(log_w, damping, L):
        return _basis(t, record.times, record.jumps, math.exp(log_w), damping, L)

    def columns(p, zeros):
        return np.column_stack([np.ones_like(t), basis(*p)[:, : 1 + zeros]])

    without, with_zero = (best_fit(partial(columns, zeros=m), y, starts, bounds) for m in (0, 1))
    rss, less = (float(fit[2] @ fit[2]) for fit in (without, with_zero))
    better = (rss - less) / max(less, 1e-14 * n) * (n - 6) > _BETTER
    return with_zero if better else without, with_zero, basis


def fit_second_order(t, u, y, *, u_before=None):
    """Fit K, w, damping, a zero and dead time to a recorded response: where `fit_fopdt` is refused for its shape.

    Least squares over all samples, exact for an input held between samples; the zero is kept where it explains
    significantly more. Where it is not, it is in the errors: what a zero does and a dead time does is nearly the same.
    Arguments as in `fit_fopdt`.

    Returns: SecondOrderModel. Raises: InputError as `fit_fopdt` does; IdentificationError if u never changes, or the
    model explains less than half of the variance of y.
    """
    record = StepRecord(t, u, y, u_before)
    (p, c, e), with_zero, basis = _second_order(record)
    explained = 1 - np.mean(e**2) / np.var(record.y)
    if explained < 0.5:
        raise IdentificationError(f"y does not follow u: a second-order model explains {100 * explained:.0f} % of it")
    found, other = (np.array([k[1], np.exp(x[0]), *x[1:], *k[2:] / k[1], 0])[:5] for x, k in ((p, c), with_zero[:2]))

    def response(p):
        return basis(math.log(p[1]), *p[2:4]) @ [p[0], p[0] * p[4]]

    sizes = np.maximum(np.abs(found), [0.0, 0.0, 0.0, 1e-3 / found[1], 1e-3 / found[1]])
    J = jacobian(response, found, sizes)[:, : len(p) + len(c)]
    errors = np.hypot(found - other, np.append(standard_errors(J, e), 0.0)[:5])
    errors = np.hypot(errors, record.coarse(e) * np.array([1, found[1], 1, 1 / found[1], 1 / found[1]]))
    errors[4] = errors[3:].max()  # one can do for the other
    if found[1] * record.period > 1:
        record.warned.add(f"w is {found[1] * record.period:.2g} rad a sample: not identifiable, sample faster")
    if found[2] > 1:
        record.warned.add(f"damping {found[2]:.2g}: the faster of two lags and L are hardly told apart; take fit_fopdt")
    units = np.array([record.gain, 1 / record.unit, 1.0, record.unit, record.unit])
    return SecondOrderModel(
        **by_name(_NAMES, found * units, errors * units),
        y0=float(c[0] * record.y_unit + record.y_first),
        fit=float(100 * (1 - np.sqrt(np.mean(e**2)) / np.std(record.y))),
        warnings=tuple(record.warned),
    )
