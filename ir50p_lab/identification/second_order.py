"""A second-order model with a zero and dead time: for responses that overshoot, swing, or start the wrong way."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.response_fit import (
    StepRecord,
    best_fit,
    by_name,
    jumps_of,
    recorded,
    respond,
    standard_errors,
)

_BETTER = 12.0  # least F value of a zero
_DAMPING = (0.02, 10.0)
_GRID = (0.1, 0.35, 0.8, 2.0)
_NAMES = ("K", "w", "damping", "L", "zero")


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
    return second_order_of(StepRecord(t, u, y, u_before))


def second_order_of(record):
    """`fit_second_order` of a StepRecord."""
    t, y, period, n = record.t, record.y, record.period, len(record.t)
    starts = [
        [(np.log(w), damping, L) for damping in _GRID for L in (0.0, 3 * period, 0.1)]
        for w in np.geomspace(3, 0.5 / period, 10)
    ]
    bounds = ([math.log(0.1), _DAMPING[0], 0.0], [math.log(3 / period), _DAMPING[1], 0.5])

    def basis(log_w, damping, L):
        return _basis(t, record.times, record.jumps, math.exp(log_w), damping, L)

    def columns(p, zeros):
        return np.column_stack([np.ones_like(t), basis(*p)[:, : 1 + zeros]])

    without, with_zero = (best_fit(partial(columns, zeros=m), y, starts, bounds) for m in (0, 1))
    rss, less = (float(fit[2] @ fit[2]) for fit in (without, with_zero))
    zeros = int((rss - less) / max(less, 1e-14 * n) * (n - 6) > _BETTER)
    p, c, e = with_zero if zeros else without
    explained = 1 - np.mean(e**2) / np.var(y)
    if explained < 0.5:
        raise IdentificationError(
            f"a second-order model explains {100 * explained:.0f} % of the variance of y: y does not follow u in this "
            "way; start from rest and make a larger step"
        )
    w, doubts = math.exp(p[0]), tuple(record.doubts)
    found = np.array([c[1], w, p[1], p[2], c[2] / c[1] if zeros else 0.0])

    def response(p):
        return basis(math.log(p[1]), *p[2:4]) @ [p[0], p[0] * p[4] if zeros else 0.0]

    found = found[: 4 + zeros]
    sizes = np.maximum(np.abs(found), [0.0, 0.0, 0.0, 1e-3 / w, 1e-3 / w][: 4 + zeros])
    errors = standard_errors(response, found, sizes, e)
    if w * period > 1:
        doubts += (f"w is {w * period:.2g} rad a sample: not identifiable, sample faster",)
    units = np.array([record.gain, 1 / record.unit, 1.0, record.unit, record.unit])[: 4 + zeros]
    return SecondOrderModel(
        **by_name(_NAMES[: 4 + zeros], found * units, errors * units),
        y0=float(c[0] * record.y_unit + record.y_first),
        rms=float(np.sqrt(np.mean(e**2))) * record.y_unit,
        fit=float(100 * (1 - np.sqrt(np.mean(e**2)) / np.std(y))),
        warnings=doubts,
    )
