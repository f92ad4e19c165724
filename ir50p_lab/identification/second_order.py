"""A second-order model with a zero and dead time: for responses that overshoot, swing, or start the wrong way."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.doubts import Doubts
from ir50p_lab.identification.response_fit import best_fit, respond, standard_errors
from ir50p_lab.identification.step_record import check_time, jumps_of, recorded, without_outliers

_BETTER = 12.0  # least F value of a zero
_DAMPING = (0.02, 10.0)
_GRID = (0.1, 0.35, 0.8, 2.0)


@dataclass(frozen=True, kw_only=True)
class SecondOrderModel:
    """G(s) = K (zero s + 1) exp(-L s)/((s/w)^2 + 2 damping s/w + 1)

    K: y/u; w: rad/s; damping: 1; zero: s, 0 without one, < 0 starts the wrong way; L: s; each with a standard error
    ..._stderr (0: not fitted); y0: output at rest; rms: of the residual; fit: 100 (1 - |e|/|y - mean y|) %.
    """

    K: float
    w: float
    damping: float
    zero: float
    L: float
    K_stderr: float = math.nan
    w_stderr: float = math.nan
    damping_stderr: float = math.nan
    zero_stderr: float = math.nan
    L_stderr: float = math.nan
    y0: float = 0.0
    rms: float = math.nan
    fit: float = math.nan
    warnings: tuple = ()

    def response(self, t, u, *, u_before=None):
        """Output for the input u(t), (n,), exact between the samples; arguments as in `FOPDT.response`."""
        t, u = recorded(t=t, u=u)
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
    plain = w**2 * (fast - slow) / (-2 * root)
    slope = w**2 * (poles[0] * fast - poles[1] * slow) / (2 * root)
    return np.column_stack([plain.real, slope.real])


def fit_second_order(t, u, y, *, u_before=None):
    """Fit K, w, damping, a zero and dead time to a recorded response: where `fit_fopdt` is refused for its shape.

    Least squares over all samples, exact for an input held between samples; the zero is kept where it explains
    significantly more. Arguments as in `fit_fopdt`.

    Returns: SecondOrderModel. Raises: InputError as `fit_fopdt` does; IdentificationError if u never changes, or the
    model explains less than half of the variance of y.
    """
    t, u, y = recorded(t=t, u=u, y=y)
    times, jumps = jumps_of(t, u, u_before)
    if not len(times):
        raise IdentificationError("u never changes, so the recording holds no step response: give u_before=")
    doubts = Doubts()
    doubts += check_time(t)
    t, y = without_outliers(doubts, t, y)
    unit, period, spread = t[-1] - times[0], float(np.median(np.diff(t))), float(np.std(y))
    starts = [
        [(np.log(w), damping, L) for damping in _GRID for L in (0.0, 3 * period, 0.1 * unit)]
        for w in np.geomspace(3 / unit, 0.5 / period, 10)
    ]
    bounds = ([math.log(0.1 / unit), _DAMPING[0], 0.0], [math.log(3 / period), _DAMPING[1], 0.5 * unit])

    def columns(p, zeros):
        return np.column_stack([np.ones_like(t), _basis(t, times, jumps, math.exp(p[0]), *p[1:])[:, : 1 + zeros]])

    without, with_zero = (best_fit(partial(columns, zeros=m), y / spread, starts, bounds) for m in (0, 1))
    rss, less = (float(fit[2] @ fit[2]) for fit in (without, with_zero))
    zeros = int((rss - less) / max(less, 1e-14 * len(t)) * (len(t) - 6) > _BETTER)
    p, c, e = with_zero if zeros else without
    c, e = c * spread, e * spread
    explained = 1 - np.mean(e**2) / spread**2
    if explained < 0.5:
        raise IdentificationError(
            f"a second-order model explains {100 * explained:.0f} % of the variance of y: y does not follow u in this "
            "way; start from rest and make a larger step"
        )
    K, zero = float(c[1]), float(c[2] / c[1]) if zeros else 0.0
    w, damping, L = math.exp(p[0]), float(p[1]), float(p[2])
    found = np.array([K, w, damping, L, zero][: 4 + zeros])

    def response(p):
        return _basis(t, times, jumps, *p[1:4]) @ [p[0], p[0] * p[4] if zeros else 0.0] / spread

    sizes = np.maximum(np.abs(found), [0.0, 0.0, 0.0, 1e-3 / w, 1e-3 / w][: 4 + zeros])
    errors = [*standard_errors(response, found, sizes, e / spread), 0.0]
    if w * period > 1:
        doubts.add(f"w = {w:.3g} rad/s is {w * period:.2g} rad a sample: not identifiable, sample faster")
    rms = float(np.sqrt(np.mean(e**2)))
    return SecondOrderModel(
        **{"K": K, "w": w, "damping": damping, "L": L, "zero": zero},
        **{f"{name}_stderr": float(x) for name, x in zip(("K", "w", "damping", "L", "zero"), errors, strict=False)},
        y0=float(c[0]),
        rms=rms,
        fit=100 * (1 - rms / spread),
        warnings=tuple(doubts),
    )
