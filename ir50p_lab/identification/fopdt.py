"""A first-order model with dead time from a recorded step response, with standard errors    (2.21)."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.response_fit import (
    NOISE,
    StepRecord,
    best_fit,
    by_name,
    jumps_of,
    likeness,
    recorded,
    respond,
    standard_errors,
)
from ir50p_lab.identification.second_order import second_order_of

_RESPONSE = 15.0  # least F value for "y follows u": a search over T and L in pure noise stays below it
_SHAPE = 0.05  # largest share of the variance of y that may be left and not be white: 20-40 % of overshoot
_BENDS = 9.0  # least F value for "the response bends towards a final value": three standard errors
_ENOUGH = 20  # samples of a response, five for each parameter, from which on its shape can be judged
_SEEN = 0.99  # sampling periods: a time constant or dead time below is not seen
_SLOWEST = 10.0  # a time constant longer than this many records cannot be told from infinity


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
        for name, value, good in (("K", self.K, self.K != 0), ("T", self.T, self.T > 0), ("L", self.L, self.L >= 0)):
            if not (math.isfinite(value) and good):
                raise InputError(f"{name} = {value}: a FOPDT model needs finite K != 0, T > 0 s and L >= 0 s")

    def response(self, t, u, *, u_before=None):
        """Output of the model for the input u(t), exact between the samples.

        Args: t: (n,) s, increasing; u: (n,), u[k] acts from t[k] to t[k + 1]; u_before: input at rest (default u[0]).
        Returns: (n,), in units of y. Raises InputError on wrong shapes or numbers that are not finite.
        """
        t, u = recorded(t=t, u=u)
        times, jumps = jumps_of(t, u, u_before)
        out = np.empty(len(t))
        respond(t, times, jumps, 1 / self.T, float(self.L), out)
        return self.y0 + self.K / self.T * out


def fit_fopdt(t, u, y, *, u_before=None, anyway=False):
    """Fit K, T and L of a first-order plus dead time model to a recording    (2.21)

    T dy/dt + y = y0 + K [u(t - L) - u_before], solved exactly for an input held between samples (zero-order hold), with
    any number of steps, sampled evenly or not; y starts at rest. After one step of height h this is
    y = y0 + K h (1 - exp(-(t - t_step - L)/T)). Least squares over all samples, from the best points of a grid.

    Standard errors come from the Jacobian at the solution and the spread of the residuals. They are right for white
    noise. Neighbouring residuals that are alike (drift, a filter, a model that does not quite fit) carry less
    information than their number: where the lag-one correlation r is significant, the errors are widened by
    sqrt((1 + r)/(1 - r)), and a warning says so. Measured over 200 seeds, 500 samples: two standard errors held the
    truth 91-97 times in 100 in white noise and up to r = 0.9, 83 times at r = 0.97: slow drift is still worse than it
    says. They know nothing of errors of the model itself, nor of a plant that was not at rest at first.

    Args:
        t: (n,) s, increasing. u: (n,), input; u[k] acts from t[k] to t[k + 1]. y: (n,), output, any unit.
        u_before: input at rest before t[0]; give it if u has its new value already in the first sample.
        anyway: go on where the data are refused and a model can be had; the reason is then in `warnings`.

    Returns: FOPDT. K is negative where y answers a step up by going down. `warnings` tells of a response that is not
    over when the record ends (T longer than it), of T or L below the sampling period (not identifiable, the error is
    then inf or a period), of correlated residuals, times that look like milliseconds, and single outliers, which are
    left out.

    Raises:
        IdentificationError: u never changes; y does not change or does not follow u; fewer than 8 samples after the
        change; y swings (then with what `fit_second_order` finds) or drifts; y runs on like a ramp (an integrating
        joint: K and T have no value) or ever faster. Each says what to do next.
        InputError: NaN, shapes or lengths that do not fit, time that does not increase.
    """
    record = StepRecord(t, u, y, u_before, anyway)
    doubts, period = record.doubts, record.period
    (a, L), (b, y0), e = _first_order(record)
    _check_shape(record, a, L, b, e)
    if a <= 0:
        raise IdentificationError("no first-order model is near this response, not even with anyway=True")

    def response(p):
        return p[0] / p[1] * record.respond(1 / p[1], p[2])

    found = np.array([b / a, 1 / a, L])
    units = record.gain, record.unit, record.unit
    errors = standard_errors(response, found, np.maximum(np.abs(found), 1e-3 * period), e) * units
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
        warnings=tuple(doubts),
    )


def _first_order(record):
    """(a, L), (b, y0) and residuals of y = y0 + b x, x' = v(t - L) - a x: 1/T is a, K/T is b.

    The rate a is fitted, not T, because 0 (the plant integrates) and below (it grows) are then points like any other.
    """
    latest = max(0.9 - 4 * record.period, 0.1)
    dead_times = np.r_[np.geomspace(0.3 * record.period, latest, 24), np.linspace(0, latest, 50)]
    rates = np.r_[-30.0, -10.0, -3.0, -1.0, -0.3, 0.0, np.geomspace(0.1, 3 / record.period, 24)]
    starts = [[(a, L) for L in dead_times] for a in rates]
    bounds = (-40.0, 0.0), (30 / record.period, latest + 0.05)
    return best_fit(lambda p: _columns(record, *p), record.y, starts, bounds)


def _columns(record, a, L):
    return np.column_stack([record.respond(a, L), np.ones_like(record.t)])


def _check_shape(record, a, L, b, e):
    """Refuse where y does not follow u at all, in a way that no FOPDT model has, or without end."""
    doubts, n, rss, total = record.doubts, len(e), e @ e, np.sum((record.y - record.y.mean()) ** 2)
    correlation, inflation = likeness(e)

    def F(more, parameters):  # how much better the model is than one with fewer parameters, that leaves `more`
        return (more - rss) / parameters / (max(rss, n * NOISE**2) / (n - 4))

    follows, explained = F(total, 3), 100 * (1 - rss / total)
    not_white = rss - np.sum(np.diff(e, 2) ** 2) / 6 * n / (n - 2)  # second differences pass only the white noise
    if follows >= _RESPONSE and not_white > _SHAPE * total and correlation > 0.5:
        doubts.refuse(
            f"the response has not the shape of the model, which explains {explained:.0f} % of the variance of y, and "
            f"what is left is not white (neighbours correlate by {correlation:.2f}). A response that overshoots or "
            f"swings needs a second-order model{_second_order(record)} (a closed loop does this: open it); or y "
            "drifts, or moved before the step: start from rest; or the drive has a dead zone or a limited rate"
        )
    elif follows < _RESPONSE or (follows / inflation**2 < _RESPONSE and explained < 50):
        doubts.refuse(
            f"y does not follow u: the model explains {explained:.1f} % of its variance, no more than noise or drift "
            "can; make a larger step, or average several recordings"
        )
    ramp = best_fit(lambda p: _columns(record, 0.0, *p), record.y, [[(k / 50,)] for k in range(45)], (0.0, 0.95))[2]
    if a * (1 - L) > 1 / _SLOWEST and F(ramp @ ramp, 1) / inflation**2 > _BENDS:
        return
    doubts.refuse(
        "the response runs on like a ramp, or ever faster: within this record the plant integrates (the position of a "
        "joint does, under constant torque) or is unstable. K and T have no value of their own, only K/T, about "
        f"{b * record.gain / record.unit:.4g} y/u per s, has. Fit the velocity instead (differentiate and smooth y) "
        "and tune with simc_integrating; stabilise a plant that grows; or, if it is only slow, record for longer"
    )


def _second_order(record):
    """What `fit_second_order` makes of it."""
    try:
        found = second_order_of(record)
    except IdentificationError:
        return ""
    return (
        f": fit_second_order(t, u, y) has K {found.K:.4g}, w {found.w:.4g} rad/s, damping {found.damping:.3g}, zero "
        f"{found.zero:.3g} s, fit {found.fit:.0f} %"
    )


def _warn(record, T, L, L_stderr, correlation, inflation):
    """What is to be minded about a fit that is not refused."""
    doubts, period = record.doubts, record.period
    if T < _SEEN * period:
        doubts.add(
            f"the time constant is not identifiable: about {T / period:.2f} of the sampling period, so that T and L "
            "cannot be told apart; K holds. Sample at least five times in one time constant"
        )
    elif L < _SEEN * period:
        doubts.add(
            f"the dead time is not identifiable: about {L / period:.2f} of the sampling period (when within it was u "
            "applied, and y read?); K and T hold. Rules that divide by L (Ziegler-Nichols, AMIGO) have no meaning here"
        )
    elif L < 2 * L_stderr:
        doubts.add(f"dead time {L * record.unit:.3g} s is less than two standard errors: it cannot be told from none")
    seen = int((record.t >= L).sum())
    if seen < _ENOUGH:
        doubts.add(
            f"only {seen} samples of the response: too few to see whether a first-order model is right (dead zone, "
            "limited rate, overshoot); record longer, or sample faster"
        )
    if T > 1 - L:
        doubts.add(
            f"not settled: T = {T * record.unit:.4g} s is longer than the {(1 - L) * record.unit:.4g} s of response "
            "recorded; K and T rest on the model being exact, record at least 3 T"
        )
    if inflation > 1:
        doubts.add(
            f"residuals are not white (correlation of neighbours {correlation:.2f}): standard errors were widened by "
            f"{inflation:.1f}; drift, a filter in the sensor, or a plant that is not quite of first order"
        )
