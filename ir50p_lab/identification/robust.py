"""Huber's estimate: least squares for small residuals, absolute value for large ones, so that outliers pull little."""

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.least_squares import Solution
from ir50p_lab.identification.qr import gram, product

_MOST_STEPS = 200
_NORMAL = 0.6744897501960817  # median of |x| of a standard normal


def huber(problem, threshold):
    """min sum rho(e / s), rho quadratic up to `threshold` and linear beyond, by reweighted least squares.

    s: 1.4826 times the median of |residual|, of each joint by itself. The scores are psi(e), residuals cut at the
    threshold: the standard errors follow from them.
    """
    Q, y = problem.Q, problem.y
    joints = len(y) // problem.n
    x = problem.Qty
    counts = (Q.any(axis=1) | (y != 0)).reshape(-1, joints)  # rows of zeros are samples left out
    for _ in range(_MOST_STEPS):
        e = (y - product(Q, x)).reshape(-1, joints)
        limit = (
            threshold * np.nanmedian(np.where(counts, np.abs(e), np.nan), axis=0) / _NORMAL * np.ones_like(e)
        ).ravel()
        e = e.ravel()
        limit = np.maximum(limit, 1e-12 * np.abs(y).max(initial=0.0))  # a perfect fit has no scale
        weights = limit / np.maximum(np.abs(e), np.where(limit > 0, limit, 1.0))
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
    bread = gram(Q, inside[:, None] * Q)
    cut = 1 - inside[counts.ravel()].mean()
    notes = [f"{problem.who}{cut:.0%} of the samples lie beyond the threshold"] if cut > 0.3 else []
    return Solution(problem.beta(x), bread, Q, np.clip(e, -limit, limit), notes)
