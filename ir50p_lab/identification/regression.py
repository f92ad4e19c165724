"""Least squares for any regressor matrix, with standard errors that stay honest when residuals are alike (HAC)."""

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft, special

from ir50p_lab.errors import InputError
from ir50p_lab.identification.estimators import plain
from ir50p_lab.identification.fit_input import finite
from ir50p_lab.identification.problem import prepare
from ir50p_lab.inputs import numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class LeastSquares:
    """What `least_squares` found.

    ============== ================================================================================ ==========
    x              parameters; 0 where a column was left out                                        (p,)
    stderr         standard errors; inf: the data cannot carry it                                   (p,)
    covariance     of x; 0 where a column was left out                                              (p, p)
    residuals      y - A x, of the samples used                                                     like y
    rms            of the residuals
    correlation    of neighbouring residuals: 0 for white noise
    independent    number of independent samples that carry as much as the n there are
    condition      of A, its columns scaled to length 1
    dropped        names of the columns that the data cannot carry                                  tuple
    warnings       tuple of str: columns left out, columns that are hardly told apart
    ============== ================================================================================ ==========
    """

    x: np.ndarray
    stderr: np.ndarray
    covariance: np.ndarray
    residuals: np.ndarray
    rms: float
    correlation: float
    independent: float
    condition: float
    dropped: tuple
    warnings: tuple


def least_squares(A, y, *, names=None, tolerance=1e-8):
    """Least squares A x = y by QR, for any regressor matrix, with standard errors for residuals in time order.

        found = least_squares(np.column_stack([qd, np.sign(qd)]), torque, names=("viscous", "Coulomb"))

    Args:
        A: (n, p), or (n, k, p) for k equations a sample; y: (n,) or (n, k). Time first. Masked samples are left out.
        names: of the p columns.
        tolerance: a column of which less than this sticks out of those before it is left out.

    Returns: LeastSquares. Its errors hold for residuals that are alike over time and of unequal size
    (heteroscedasticity and autocorrelation consistent, `long_run_sum`). Noise in A is not in them: it biases.
    Raises: InputError on shapes and numbers that are not finite; IdentificationError if A is zero, or has fewer than
    twice as many rows as columns.
    """
    masks = [np.ma.getmaskarray(x) for x in (A, y) if np.ma.isMaskedArray(x)]
    A, y = numbers("A", A), numbers("y", y)
    if A.ndim not in (2, 3) or A.shape[:-1] != y.shape or not A.size:
        raise InputError(f"A has shape {A.shape}, y {y.shape}: give (n, p) and (n,), or (n, k, p) and (n, k)")
    if masks:
        keep = ~np.any([mask.reshape(len(y), -1).any(axis=1) for mask in masks], axis=0)
        A, y = A[keep], y[keep]
    A, y = finite("A", A), finite("y", y)
    p = A.shape[-1]
    names = tuple(f"x{k + 1}" for k in range(p)) if names is None else tuple(names)
    if len(names) != p:
        raise InputError(f"{len(names)} names for {p} columns: give one for each")
    problem = prepare("", names, A.reshape(-1, p), y.ravel(), len(y), tolerance)
    solution = plain(problem)
    kept = [names.index(name) for name in problem.names]
    x, covariance, stderr = np.zeros(p), np.zeros((p, p)), np.full(p, np.inf)
    x[kept], covariance[np.ix_(kept, kept)] = parameters_of(problem, solution)
    stderr[kept] = np.sqrt(np.diag(covariance))[kept]
    e = solution.residuals.reshape(len(y), -1)
    return LeastSquares(
        x=x,
        stderr=stderr,
        covariance=covariance,
        residuals=e.reshape(y.shape),
        rms=math.sqrt(np.mean(e**2)),
        correlation=float(np.mean(lag_one(e))),
        independent=float(independent_samples(e)),
        condition=problem.condition,
        dropped=problem.lost,
        warnings=(*problem.notes, *problem.hardly_told_apart()),
    )


def parameters_of(problem, solution):
    """Parameters of the columns of a Problem, (p,), and their covariance B^-1 S B^-T, (p, p).

    The estimate solves sum of rows^T residuals = 0, with derivative B; S is the covariance of that sum, from the
    spectrum of the scores near frequency zero.
    """
    n, (N, p) = problem.n, solution.rows.shape
    scores = (solution.rows * solution.residuals[:, None]).reshape(n, -1, p).sum(axis=1)
    residuals = solution.residuals.reshape(n, -1)
    S = long_run_sum(scores, residuals)
    S *= 1 / max(1 - p / (independent_samples(residuals) * N / n), 0.5)  # p of them were spent on the fit
    in_q = np.linalg.solve(solution.bread, np.linalg.solve(solution.bread, S).T)
    back = problem.R_inverse / problem.scale[:, None]
    return solution.beta / problem.scale, back @ in_q @ back.T


def long_run_sum(scores, residuals):
    """Covariance (p, p) of the sum over time of correlated `scores` (n, p), which go with `residuals` (n, k).

    Mean of the first B squared cosine coefficients ('equal-weighted cosine', Lazarus, Lewis, Stock and Watson 2018):
    what matters for an estimate is the noise at the frequencies next to zero. B = 0.4 n^(2/3), but no more than where
    the residuals' spectrum is still flat, taken as half of the band that holds half of their power (a quarter of the
    cut-off for noise that was low-passed). Few coefficients make the errors themselves uncertain: they are widened as
    Student's t with B degrees of freedom asks.
    """
    n = len(scores)
    B = int(np.clip(independent_samples(residuals) // 4, 4, max(4, 0.4 * n ** (2 / 3))))
    coefficients = fft.dct(scores, axis=0)[1 : B + 1]
    wider = special.stdtrit(B, 0.99865) / 3.0  # three standard errors then hold the truth 997 times in 1000
    return wider**2 * coefficients.T @ coefficients / (2 * B)


def independent_samples(residuals):
    """Independent samples in residuals (n, k): twice the cosine coefficients that hold half of their power."""
    power = np.cumsum(np.sum(fft.dct(residuals, axis=0) ** 2, axis=1))
    return max(2 * np.searchsorted(power, power[-1] / 2), 1)


def lag_one(residuals):
    """Correlation of neighbouring residuals, (3,) for (n, 3): 0 for white noise, near 1 after a low-pass."""
    power = np.sum(residuals**2, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(np.sum(residuals[1:] * residuals[:-1], axis=0) / power)
