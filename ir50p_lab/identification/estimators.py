"""Estimators for `fit`: least squares, ridge, Huber, bounded, instrumental variables; from a Problem to parameters.

Each returns a Solution in the coordinates of Q (A = Q R), where numbers are well conditioned.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import lsq_linear

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.parameters import FREE_OF_SIGN
from ir50p_lab.identification.qr import gram, product, r_factor

_WEAK = 0.1  # smallest canonical correlation of instruments and regressors below which they are weak
_NOTHING = 1e-8  # below it the estimate would be rounding
_MOST_STEPS = 200
_NORMAL = 0.6744897501960817  # median of |x| of a standard normal


@dataclass(frozen=True, eq=False)
class Solution:
    """beta (p,), scaled parameters; the estimate solves sum of rows^T residuals = 0, with derivative `bread`."""

    beta: np.ndarray
    bread: np.ndarray
    rows: np.ndarray
    residuals: np.ndarray
    notes: list = field(default_factory=list)


def plain(problem):
    """min |y - A beta|^2 by QR    (2.35), without the squared condition number of A^T A."""
    beta = problem.R_inverse @ problem.Qty
    return Solution(beta, np.eye(len(beta)), problem.Q, problem.residuals(beta))


def ridge(problem, strength):
    """min |y - A beta|^2 + strength |beta|^2, columns of A of length 1: biased towards 0, and calmer."""
    p = len(problem.names)
    augmented = np.vstack([problem.R, np.sqrt(strength) * np.eye(p)])
    beta = np.linalg.lstsq(augmented, np.concatenate([problem.Qty, np.zeros(p)]), rcond=None)[0]
    bread = np.eye(p) + strength * problem.R_inverse.T @ problem.R_inverse
    note = f"{problem.who}ridge {strength:g} pulls parameters towards 0; standard errors do not hold that bias"
    return Solution(beta, bread, problem.Q, problem.residuals(beta), [note])


def huber(problem, threshold):
    """min sum rho(e / s), rho quadratic up to `threshold` and linear beyond, by reweighted least squares.

    s: 1.4826 times the median of |residual|, of each joint by itself. The scores are psi(e), residuals cut at the
    threshold: the standard errors follow from them.
    """
    Q, y = problem.Q, problem.y
    joints = len(y) // problem.n
    x = problem.Qty
    counts = (Q.any(axis=1) | (y != 0)).reshape(-1, joints)  # rows of zeros are samples left out
    floor = 1e-12 * np.abs(y).max(initial=0.0) + 1e-300  # a perfect fit has no scale
    for _ in range(_MOST_STEPS):
        e = (y - product(Q, x)).reshape(-1, joints)
        scale = np.nanmedian(np.where(counts, np.abs(e), np.nan), axis=0) / _NORMAL
        limit = np.maximum((threshold * scale * np.ones_like(e)).ravel(), floor)
        weights = limit / np.maximum(np.abs(e.ravel()), limit)
        new = np.linalg.solve(gram(Q, weights[:, None] * Q), gram(Q, weights * y))
        moved = np.linalg.norm(new - x)
        x = new
        if moved <= 1e-10 * max(np.linalg.norm(x), 1e-300):
            break
    else:
        raise IdentificationError(
            f"{problem.who}the robust fit has not settled after {_MOST_STEPS} steps: too few good samples; use 'ls'"
        )
    e = y - product(Q, x)
    inside = np.abs(e) <= limit
    cut = 1 - inside[counts.ravel()].mean()
    notes = [f"{problem.who}{cut:.0%} of the samples lie beyond the threshold"] if cut > 0.3 else []
    return Solution(problem.R_inverse @ x, gram(Q, inside[:, None] * Q), Q, np.clip(e, -limit, limit), notes)


def bounded(problem):
    """min |y - A beta|^2 with inertial and friction terms >= 0, a convex problem, by scipy.optimize.lsq_linear on R.

    Standard errors are those without bounds: a bound can only make an estimate surer.
    """
    low = np.array([-np.inf if name in FREE_OF_SIGN else 0.0 for name in problem.names])
    # y may be of any size: scaled to 1, so that the solver's tolerances mean the same for every unit
    size = np.linalg.norm(problem.Qty) or 1.0
    result = lsq_linear(problem.R, problem.Qty / size, (low, np.inf), method="bvls", tol=1e-14)
    if not result.success:
        raise IdentificationError(f"{problem.who}the bounded fit failed ({result.message}); use 'ls'")
    beta = result.x * size
    at = [f"{name} = 0" for name, active in zip(problem.names, result.active_mask, strict=True) if active]
    notes = [f"{problem.who}at a bound: {', '.join(at)}; the data alone would go beyond"] if at else []
    return Solution(beta, np.eye(len(beta)), problem.Q, problem.residuals(beta), notes)


def instrumental_variables(problem, Z):
    """Solve Z^T (y - A beta) = 0: no bias from noise in A if Z, (N, p), moves as A does but with other noise.

    Raises IdentificationError if Z says nothing about some combination of the columns.
    """
    length = np.linalg.norm(Z, axis=0)
    if not length.all():
        name = problem.names[int(np.argmin(length))]
        raise IdentificationError(f"{problem.who}the instrument of {name} is zero throughout: fit without that column")
    R = r_factor(Z / length)
    if np.abs(np.diag(R)).min() < 1e-8:
        raise IdentificationError(f"{problem.who}the instruments depend on each other: they excite fewer columns")
    Qz = product(Z / length, np.linalg.solve(R, np.eye(len(R))))
    bread = gram(Qz, problem.Q)
    smallest = np.linalg.svd(bread, compute_uv=False)[-1]
    if smallest < _NOTHING:
        raise IdentificationError(
            f"{problem.who}instruments and regressors have a correlation of {smallest:.1g} only in some direction: "
            "take instruments that follow the same motion, such as the regressor of the reference or of a simulation"
        )
    beta = problem.R_inverse @ np.linalg.solve(bread, gram(Qz, problem.y))
    notes = []
    if smallest < _WEAK:
        notes = [f"{problem.who}weak instruments (smallest correlation {smallest:.2g}): large, optimistic errors"]
    return Solution(beta, bread, Qz, problem.residuals(beta), notes)
