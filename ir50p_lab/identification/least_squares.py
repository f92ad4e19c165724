"""Least squares, ridge and instrumental variables: from a Problem to parameters and the equation they solve.

Each returns a Solution in the coordinates of Q (A = Q R), where numbers are well conditioned.
"""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.qr import gram, inverse_upper, product, r_factor

_WEAK = 0.1  # smallest canonical correlation of instruments and regressors below which they are weak


@dataclass(frozen=True, eq=False)
class Solution:
    """beta (p,), scaled parameters; the estimate solves sum of rows^T residuals = 0, with derivative `bread`."""

    beta: np.ndarray
    bread: np.ndarray
    rows: np.ndarray
    residuals: np.ndarray
    notes: list = field(default_factory=list)


def least_squares(problem):
    """min |y - A beta|^2 by QR    (2.35), without the squared condition number of A^T A."""
    beta = problem.beta(problem.Qty)
    return Solution(beta, np.eye(len(beta)), problem.Q, problem.residuals(beta))


def ridge(problem, strength):
    """min |y - A beta|^2 + strength |beta|^2, columns of A of length 1: biased towards 0, and calmer."""
    p = len(problem.names)
    augmented = np.vstack([problem.R, np.sqrt(strength) * np.eye(p)])
    beta = np.linalg.lstsq(augmented, np.concatenate([problem.Qty, np.zeros(p)]), rcond=None)[0]
    bread = np.eye(p) + strength * problem.R_inverse.T @ problem.R_inverse
    note = f"{problem.who}ridge {strength:g} pulls parameters towards 0; standard errors do not hold that bias"
    return Solution(beta, bread, problem.Q, problem.residuals(beta), [note])


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
    Qz = product(Z / length, inverse_upper(R))
    bread = gram(Qz, problem.Q)
    smallest = np.linalg.svd(bread, compute_uv=False)[-1]
    if smallest < 1e-3:
        raise IdentificationError(
            f"{problem.who}instruments and regressors have a correlation of {smallest:.1g} only in some direction: "
            "take instruments that follow the same motion, such as the regressor of the reference or of a simulation"
        )
    beta = problem.beta(np.linalg.solve(bread, gram(Qz, problem.y)))
    notes = []
    if smallest < _WEAK:
        notes = [f"{problem.who}weak instruments (smallest correlation {smallest:.2g}): large, optimistic errors"]
    return Solution(beta, bread, Qz, problem.residuals(beta), notes)


def covariance_of_beta(problem, in_q):
    """R^-1 C R^-T: covariance of beta from that in the coordinates of Q."""
    return problem.R_inverse @ in_q @ problem.R_inverse.T
