"""The exact answer of a first-order system to an input that jumps, and its least-squares fit to a record."""

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.optimize import least_squares

_NOISE = 1e-7  # residuals below this share of the response are rounding, not noise
_STARTS = 3  # best points of the grid from which the fit is refined: the sum of squares has kinks and side valleys in L
_SMALL = 1e-4  # below this a dt, series keep the digits that (1 - exp(-a dt))/a loses


@njit(cache=True)
def respond(t, jump_times, jumps, a, L, out):
    """x' = v(t - L) - a x from x = 0, exactly, with dead time L of any size (no multiple of a period).

    v is the sum of the jumps that have happened. a = 0 integrates, a < 0 grows, a complex one swings. Writes into
    out (3, n), of the type of a: x, dx/da and dx/dL at the times t (n,), increasing; jump_times (m,), increasing, none
    before t[0].
    """
    x, s, v, now, k = 0.0 * a, 0.0 * a, 0.0, t[0], 0
    tau = 1 / a if a != 0 else a
    for i in range(len(t)):
        while True:
            jump = k < len(jumps) and jump_times[k] + L <= t[i]
            dt = (jump_times[k] + L if jump else t[i]) - now
            z = a * dt
            gone = -np.expm1(-z)
            E = 1 - gone
            if abs(z) < _SMALL:
                phi = dt * (1 - z / 2 + z * z / 6)
                dphi = dt * dt * (-1 / 2 + z / 3 - z * z / 8)
            else:
                phi = gone * tau
                dphi = (dt * E - phi) * tau
            s = s * E - dt * E * x + v * dphi
            x = x * E + v * phi
            now += dt
            if not jump:
                break
            v += jumps[k]
            k += 1
        out[0, i], out[1, i], out[2, i] = x, s, a * x - v


@njit(cache=True)
def scan(t, jump_times, jumps, y, rates, dead_times, joint):
    """Sum of squares that y = y0 + b x leaves, with the best b and y0, for each a of rates and L of dead_times.

    x is the answer of `respond`, or with `joint` its integral (x(0, L) - x(a, L))/a. Returns: (rates, dead_times).
    """
    out, straight = np.empty((3, len(t))), np.zeros((3, len(t)))
    left = np.empty((len(rates), len(dead_times)))
    y = y - y.mean()
    total = np.dot(y, y)
    for j in range(len(dead_times)):
        if joint:
            respond(t, jump_times, jumps, 0.0, dead_times[j], straight)
        for i in range(len(rates)):
            respond(t, jump_times, jumps, rates[i], dead_times[j], out)
            x = out[0] - straight[0]
            x -= x.mean()
            xx = np.dot(x, x)
            left[i, j] = total - np.dot(x, y) ** 2 / xx if xx > 0 else total
    return left


@dataclass(frozen=True)
class Fit:
    """Least-squares solution in the units of a Record: y = y0 + b x(a, L)."""

    b: float
    a: float
    L: float
    y0: float
    rss: float
    shape: float  # part of rss that is not white noise
    correlation: float  # of neighbouring residuals
    inflation: float  # of standard errors, for that correlation


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
        self.dead_time = None if dead_time is None else dead_time / self.unit
        self.total = float(np.sum((self.y - self.y.mean()) ** 2))
        self.period = float(np.median(np.diff(self.t)))
        self.free = [0, 1, 3] if dead_time is not None else [0, 1, 2, 3]  # of (b, a, L, y0)

    def fit_first_order(self):
        """Best (b, a, L, y0); a of any sign."""
        rates = np.r_[-30.0, -10.0, -3.0, -1.0, -0.3, 0.0, np.geomspace(0.1, 3 / self.period, 24)]
        return self._fit(rates, -40.0, False)

    def fit_joint(self):
        """Best fit of a joint's position: first-order velocity, integrated, y = y0 + b (x(0, L) - x(a, L))/a."""
        return self._fit(np.geomspace(0.1, 3 / self.period, 16), 0.05, True)

    def ramp_rss(self):
        """Sum of squares of the best ramp (a = 0, any L)."""
        return float(scan(self.t, self.jump_times, self.jumps, self.y, np.zeros(1), self._dead_times(), False).min())

    def _dead_times(self):
        if self.dead_time is not None:
            return np.array([self.dead_time])
        latest = self._latest()
        return np.unique(np.r_[0.0, np.geomspace(0.3 * self.period, latest, 24), np.linspace(0, latest, 50)])

    def _latest(self):
        return max(0.9 - 4 * self.period, 0.1)

    def _fit(self, rates, slowest, joint):
        dead_times = self._dead_times()
        left = scan(self.t, self.jump_times, self.jumps, self.y, rates, dead_times, joint)
        free, out = self.free, np.empty((3, len(self.t)))
        low = np.array([-np.inf, slowest, 0.0, -np.inf])[free]
        high = np.array([np.inf, 30 / self.period, self._latest() + 0.05, np.inf])[free]

        def split(p):
            return (p[0], p[1], self.dead_time, p[2]) if len(p) == 3 else p

        def residuals(p):
            b, a, L, y0 = split(p)
            return y0 + b * self.basis(a, L, joint, out)[0] - self.y

        def jacobian(p):
            b, a, L, _ = split(p)
            x, x_a, x_L = self.basis(a, L, joint, out)
            return np.column_stack([x, b * x_a, b * x_L, np.ones_like(x)])[:, free]

        best = None
        for row in np.argsort(left.min(axis=1))[:_STARTS]:
            a, L = rates[row], dead_times[left[row].argmin()]
            x = self.basis(a, L, joint, out)[0]
            b, y0 = np.linalg.lstsq(np.column_stack([x, np.ones_like(x)]), self.y, rcond=None)[0]
            start = np.clip(np.array([b, a, L, y0])[free], low, high)
            found = least_squares(
                residuals, start, jacobian, bounds=(low, high), x_scale="jac", ftol=1e-12, xtol=1e-11, gtol=1e-14
            )
            if best is None or found.cost < best.cost:
                best = found
        return self._as_fit(split(best.x), 2 * best.cost, best.fun)

    def basis(self, a, L, joint, out):
        """x, dx/da, dx/dL at the samples: (3, n)."""
        respond(self.t, self.jump_times, self.jumps, a, L, out)
        if not joint:
            return out
        straight = np.empty_like(out)
        respond(self.t, self.jump_times, self.jumps, 0.0, L, straight)
        x = (straight[0] - out[0]) / a
        return np.array([x, -(out[1] + x) / a, (straight[2] - out[2]) / a])

    def _as_fit(self, p, rss, r):
        n = len(r)
        correlation, inflation = 0.0, 1.0
        if rss > n * _NOISE**2:
            correlation = float(r[1:] @ r[:-1] / (r @ r))
            if correlation > 3 / math.sqrt(n):
                inflation = math.sqrt((1 + correlation) / (1 - correlation))
        white = float(np.sum(np.diff(r, 2) ** 2)) / 6 * n / (n - 2)  # second differences pass only the noise
        return Fit(*(float(value) for value in p), float(rss), rss - white, correlation, inflation)

    def f_value(self, fit, rss, parameters):
        """How much better `fit` is than a model with fewer parameters that leaves `rss`: F statistic."""
        spread = max(fit.rss, len(self.t) * _NOISE**2) / (len(self.t) - len(self.free))
        return (rss - fit.rss) / parameters / spread / fit.inflation**2

    def watched(self, fit):
        """Length of the record after the first change has arrived."""
        return 1 - fit.L

    def K(self, fit):
        """Gain, y/u."""
        return self.slope(fit) * self.unit / fit.a

    def slope(self, fit):
        """K/T, y/u per s."""
        return fit.b * self.y_unit / self.u_unit / self.unit

    def stderr(self, fit):
        """Standard errors of K (y/u), T (s) and L (s) from the Jacobian in these parameters."""
        a, K = fit.a, fit.b / fit.a
        x, x_a, x_L = self.basis(a, fit.L, False, np.empty((3, len(self.t))))
        # y = y0 + K a x(a, L) and a = 1/T
        J = np.column_stack([a * x, -(a**2) * K * (x + a * x_a), fit.b * x_L, np.ones_like(x)])[:, self.free]
        size = np.linalg.norm(J, axis=0)
        R = np.linalg.qr(J / size, mode="r")
        spread = math.sqrt(fit.rss / (len(x) - len(self.free))) * fit.inflation
        sigma = spread * np.linalg.norm(np.linalg.solve(R, np.eye(len(size))), axis=1) / size
        L_sigma = sigma[2] * self.unit if self.dead_time is None else 0.0
        return float(sigma[0] * self.y_unit / self.u_unit), float(sigma[1] * self.unit), float(L_sigma)
