"""Estimators for `fit`: ridge, Huber, bounded, instrumental variables.

Each takes a Problem and returns its parameters and their covariance, as `Problem.estimate` does.
"""

import numpy as np
from scipy.optimize import lsq_linear

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.checks import at_bounds
from ir50p_lab.identification.parameters import FREE_OF_SIGN

_BLIND = 1e-8  # if the least canonical correlation of instruments and columns is smaller, the estimate is rounding
_MOST_STEPS = 200  # if the robust fit needs more steps of reweighting, it does not settle
_NORMAL = 0.6744897501960817  # median of |x| of a standard normal x: turns a median of residuals into a deviation
_THRESHOLD = 1.345  # standard deviations from which on a residual pulls less: without outliers 95 % as efficient


def ridge(problem, strength):
    """min |y - A x|^2 + strength |x|^2, columns of A of length 1: biased towards 0, with less scatter."""
    R, one = problem.R, np.eye(len(problem.R))
    problem.notes.append(f"{problem.who}ridge {strength:g} pulls towards 0; standard errors leave out that bias")
    x = np.linalg.solve(R.T @ R + strength * one, R.T @ problem.Qty)
    return problem.estimate(R @ x, derivative=one + strength * problem.R_inverse.T @ problem.R_inverse)


def huber(problem):
    """min sum rho(e/s), rho quadratic up to 1.345 and linear beyond, by reweighted least squares.

    s: 1.4826 times the median of |residual|, of each joint by itself.
    """
    Q, y, z = problem.Q, problem.y, problem.Qty
    counts = (Q.any(axis=1) | (y != 0)).reshape(problem.n, -1)  # rows of zeros are samples that are not used
    floor = 1e-12 * np.abs(y).max() + 1e-300  # a perfect fit leaves no residuals to take a scale from
    for _ in range(_MOST_STEPS):
        e = (y - Q @ z).reshape(counts.shape)
        scale = np.nanmedian(np.where(counts, np.abs(e), np.nan), axis=0) / _NORMAL
        limit = np.broadcast_to(np.maximum(_THRESHOLD * scale, floor), e.shape).ravel()
        weights = limit / np.maximum(np.abs(e.ravel()), limit)
        before, z = z, np.linalg.solve(Q.T @ (weights[:, None] * Q), Q.T @ (weights * y))
        if np.linalg.norm(z - before) <= 1e-10 * np.linalg.norm(z):
            break
    else:
        raise IdentificationError(f"{problem.who}the robust fit has not settled: too few good samples; use 'ls'")
    e = y - Q @ z
    return problem.estimate(z, residuals=np.clip(e, -limit, limit), derivative=Q.T @ (Q * (abs(e) <= limit)[:, None]))


def bounded(problem):
    """min |y - A x|^2 with inertial and friction terms >= 0, a convex problem, by scipy.optimize.lsq_linear on R.

    Standard errors are those without bounds; of what is left at its bound the error is infinite.
    """
    low = np.where(np.isin(problem.names, FREE_OF_SIGN), -np.inf, 0.0)
    size = np.linalg.norm(problem.Qty) or 1.0  # y is scaled to 1: the solver's tolerances then suit every unit
    result = lsq_linear(problem.R, problem.Qty / size, (low, np.inf), method="bvls", tol=1e-14)
    if not result.success:
        raise IdentificationError(f"{problem.who}the bounded fit failed ({result.message}); use 'ls'")
    said, at = at_bounds(problem.names, result.x, low, np.inf)
    problem.notes += [problem.who + sentence for sentence in said]
    problem.at_bound = np.flatnonzero(at)
    _, covariance = problem.estimate(problem.R @ result.x * size)
    return result.x * size / problem.scale, covariance  # not from `estimate`: a parameter at its bound is exactly 0


def instrumental_variables(problem, Z):
    """Solve Z^T (y - A x) = 0: no bias from noise in A if Z, (N, p), moves as A does but with other noise."""
    Z = np.linalg.qr(Z / np.maximum(np.linalg.norm(Z, axis=0), 1e-300))[0]
    derivative = Z.T @ problem.Q
    smallest = np.linalg.svd(derivative, compute_uv=False)[-1]
    if smallest < _BLIND:
        raise IdentificationError(f"{problem.who}the instruments are unlike Phi: take some that follow the same motion")
    z = np.linalg.solve(derivative, Z.T @ problem.y)
    return problem.estimate(z, rows=Z, derivative=derivative)
