"""Least-squares fit of a first-order plant with dead time to a record, and of what is like it: a joint, a ramp."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.identification.response_fit import NOISE, best_fit, likeness, respond, solve, standard_errors


@dataclass(frozen=True)
class Fit:
    """Least-squares solution in the units of a Record: y = y0 + b x(a, L)."""

    b: float
    a: float
    L: float
    y0: float
    rss: float
    residuals: np.ndarray
    correlation: float  # of neighbouring residuals
    inflation: float  # of standard errors, for that correlation

    @property
    def shape(self):
        """Part of the sum of squares that is not white noise: second differences pass only the noise."""
        n = len(self.residuals)
        return self.rss - float(np.sum(np.diff(self.residuals, 2) ** 2)) / 6 * n / (n - 2)


class Record:
    """A recording in its own units: first change of u at 0, end at 1, range of y and largest step of u are 1.

    In these, y = y0 + b x with x' = v(t - L) - a x: 1/T is a, K/T is b. The rate a is fitted, not T, because 0 (the
    plant integrates) and below (it grows) are then points like any other, which the caller can refuse.
    """

    def __init__(self, t, y, jump_times, jumps, dead_time):
        self.unit, self.y_unit = float(t[-1] - jump_times[0]), float(np.ptp(y))
        self.u_unit = float(np.abs(jumps).max())
        self.t, self.jump_times = (t - jump_times[0]) / self.unit, (jump_times - jump_times[0]) / self.unit
        self.y, self.jumps = (y - y[0]) / self.y_unit, jumps / self.u_unit
        self.total = float(np.sum((self.y - self.y.mean()) ** 2))
        self.period = float(np.median(np.diff(self.t)))
        self.latest = max(0.9 - 4 * self.period, 0.1)
        several = np.geomspace(0.3 * self.period, self.latest, 24), np.linspace(0, self.latest, 50)
        self.known = () if dead_time is None else (dead_time / self.unit,)  # a dead time that was given
        self.dead_times = np.unique(np.r_[several]) if dead_time is None else self.known

    def first_order(self, a, L):
        """Columns of y = y0 + b x(a, L), (n, 2)."""
        x = np.empty(len(self.t))
        respond(self.t, self.jump_times, self.jumps, a, L, x)
        return np.column_stack([x, np.ones_like(x)])

    def joint(self, a, L):
        """Columns for the position of a joint whose velocity is of first order: the integral (x(0, L) - x(a, L))/a."""
        return np.column_stack([(self.first_order(0.0, L) - self.first_order(a, L))[:, 0] / a, np.ones_like(self.t)])

    def fit_first_order(self):
        """Best (b, a, L, y0); a of any sign."""
        rates = np.r_[-30.0, -10.0, -3.0, -1.0, -0.3, 0.0, np.geomspace(0.1, 3 / self.period, 24)]
        return self._fit(self.first_order, rates, -40.0)

    def fit_joint(self):
        """Best fit of a joint's position."""
        return self._fit(self.joint, np.geomspace(0.1, 3 / self.period, 16), 0.05)

    def ramp_rss(self):
        """Sum of squares of the best ramp (a = 0, any L)."""
        return min(np.sum(solve(self.first_order(0.0, L), self.y)[1] ** 2) for L in self.dead_times)

    def _fit(self, columns, rates, slowest):
        """Best of a, and of L unless it is known."""
        free = 2 - len(self.known)
        starts = [[(a, L)[:free] for L in self.dead_times] for a in rates]
        bounds = (slowest, 0.0)[:free], (30 / self.period, self.latest + 0.05)[:free]
        p, (b, y0), e = best_fit(lambda p: columns(*p, *self.known), self.y, starts, bounds)
        a, L = map(float, (*p, *self.known))
        return Fit(float(b), a, L, float(y0), float(e @ e), e, *likeness(e))

    def f_value(self, fit, rss, parameters):
        """How much better `fit` is than a model with fewer parameters that leaves `rss`: F statistic."""
        n, free = len(self.t), 4 - len(self.known)
        spread = max(fit.rss, n * NOISE**2) / (n - free)
        return (rss - fit.rss) / parameters / spread / fit.inflation**2

    def slope(self, fit):
        """K/T, y/u per s."""
        return fit.b * self.y_unit / self.u_unit / self.unit

    def stderr(self, fit):
        """Standard errors of K (y/u), T (s) and L (s); 0 for a dead time that was given."""
        p = np.array([fit.b / fit.a, 1 / fit.a, fit.L][: 3 - len(self.known)])

        def response(p):
            K, T, L = (*p, *self.known)
            return K / T * self.first_order(1 / T, L)[:, 0]

        sizes = np.maximum(np.abs(p), 1e-3 * self.period)
        K, T, *L = standard_errors(response, p, sizes, fit.residuals)
        return float(K * self.y_unit / self.u_unit), float(T * self.unit), float(L[0] * self.unit) if L else 0.0
