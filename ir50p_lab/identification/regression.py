"""Least squares for any regressor matrix, with standard errors that hold for correlated residuals (HAC)."""

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft, special

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.fit_input import finite
from ir50p_lab.inputs import numbers

DEPENDENT = 1e-8  # share of a column's length: if less of it is no combination of the others, that is rounding


@dataclass(frozen=True, kw_only=True, eq=False)
class LeastSquares:
    """What `least_squares` found.

    ============== ================================================================================ ==========
    x              parameters; 0 where a column was left out                                        (p,)
    stderr         standard errors; inf: not determined by the data                                 (p,)
    covariance     of x; 0 where a column was left out                                              (p, p)
    residuals      y - A x, of the samples used                                                     like y
    rms            of the residuals
    correlation    of neighbouring residuals: 0 for white noise
    independent    number of independent samples that would tell as much as the n correlated ones
    dropped        names of the columns left out                                                    tuple
    warnings       tuple of str: columns left out, and what the others now stand for
    ============== ================================================================================ ==========
    """

    x: np.ndarray
    stderr: np.ndarray
    covariance: np.ndarray
    residuals: np.ndarray
    rms: float
    correlation: float
    independent: float
    dropped: tuple
    warnings: tuple


def least_squares(A, y, *, names=None, tolerance=DEPENDENT):
    """Solve A x = y by least squares (QR), for any regressor matrix and residuals that may be correlated in time.

        found = least_squares(np.column_stack([qd, np.sign(qd)]), torque, names=("viscous", "Coulomb"))

    Args:
        A: (n, p), or (n, k, p) for k equations per sample; y: (n,) or (n, k). Time first. Masked samples are left out.
        names: of the p columns.
        tolerance: a column is left out if it is a combination of those before it to within this share of its length.

    Returns: LeastSquares. Its errors hold for residuals that are correlated in time and of unequal size
    (heteroscedasticity and autocorrelation consistent, `long_run_sum`). They do not include noise in A, which biases x.
    Raises: InputError on wrong shapes and numbers that are not finite; IdentificationError if A is zero, or has fewer
    than twice as many rows as columns.
    """
    given = A, y
    A, y = numbers("A", A), numbers("y", y)
    if A.ndim not in (2, 3) or A.shape[:-1] != y.shape or not A.size:
        raise InputError(f"A has shape {A.shape}, y {y.shape}: give (n, p) and (n,), or (n, k, p) and (n, k)")
    masked = np.any([np.ma.getmaskarray(x).reshape(len(y), -1).any(axis=1) for x in given], axis=0)
    A, y = finite("A", A[~masked]), finite("y", y[~masked])
    p = A.shape[-1]
    names = [f"x{k + 1}" for k in range(p)] if names is None else list(names)
    if len(names) != p:
        raise InputError(f"{len(names)} names for {p} columns: give one for each")
    problem = Problem(A.reshape(-1, p), y.ravel(), names, len(y), tolerance=tolerance)
    kept = problem.kept
    x, covariance, stderr = np.zeros(p), np.zeros((p, p)), np.full(p, np.inf)
    x[kept], covariance[np.ix_(kept, kept)] = problem.estimate(problem.Qty)
    stderr[kept] = np.sqrt(np.diag(covariance))[kept]
    e = (y - A @ x).reshape(len(y), -1)
    power = np.maximum(np.sum(e**2, axis=0), 1e-300)
    return LeastSquares(
        x=x,
        stderr=stderr,
        covariance=covariance,
        residuals=e.reshape(y.shape),
        rms=math.sqrt(np.mean(e**2)),
        correlation=float(np.mean(np.sum(e[1:] * e[:-1], axis=0) / power)),
        independent=float(independent_samples(e)),
        dropped=tuple(problem.lost),
        warnings=tuple(problem.notes),
    )


class Problem:
    """Equations y = A x + noise, prepared: columns scaled to length 1, dependent ones left out, A = Q R.

    Args: A (N, p), y (N,), names of the columns; n: number of samples, with N/n equations each, time first; who: begins
    sentences, "joint 2: " or "". Raises IdentificationError for too few equations, and if A is zero.

    Attributes: Q (N, k), R, R_inverse (k, k), Qty (k,); names and `scale` (lengths) of the columns `kept` (indices);
    the names `lost`; indices of those left `at_bound`; condition of A with columns of length 1; notes: sentences
    about what the data cannot tell.
    """

    def __init__(self, A, y, names, n, *, who="", tolerance=DEPENDENT):
        if len(A) < 2 * len(names):
            raise IdentificationError(f"{who}{len(A)} equations for {len(names)} parameters, {2 * len(names)} needed")
        length = np.linalg.norm(A, axis=0)
        if not length.any():
            raise IdentificationError(f"{who}the data hold no motion: move the joint and record again")
        A = A / np.where(length > 1e-12 * length.max(), length, np.inf)
        R = np.linalg.qr(np.column_stack([A, y]), mode="r")
        self.kept, weights = independent_columns(R[:, :-1], tolerance)
        lost = [k for k in range(len(names)) if k not in self.kept]
        R = np.linalg.qr(R[:, [*self.kept, -1]], mode="r")
        self.R, self.Qty, self.scale = R[:-1, :-1], R[:-1, -1], length[self.kept]
        self.R_inverse = np.linalg.inv(self.R)
        self.Q = A[:, self.kept] @ self.R_inverse
        self.who, self.y, self.n, self.at_bound = who, y, n, []
        self.names, self.lost = [names[k] for k in self.kept], [names[k] for k in lost]
        in_its_unit = weights[:, lost] * length[lost] / self.scale[:, None]
        self.notes = [self._stands_for(*pair) for pair in zip(self.lost, in_its_unit.T, strict=True)]
        self.condition = float(np.linalg.cond(self.R))

    def _stands_for(self, lost, weights):
        """A sentence about a column left out: what the kept ones now stand for."""
        parts = [(name, w) for name, w in zip(self.names, weights, strict=True) if w]
        if not parts:
            return f"{self.who}{lost} cannot be found: nothing in the data excites it"
        stands = "; ".join(f"{name} stands for {name} {w:+.4g} {lost}" for name, w in parts)
        return f"{self.who}{lost} cannot be told apart from {', '.join(name for name, _ in parts)}: {stands}"

    def estimate(self, z):
        """Return the kept columns' parameters (k,) and covariance (k, k), for z = R x with columns of length 1."""
        residuals = self.y - self.Q @ z
        N, k = self.Q.shape
        scores = (self.Q * residuals[:, None]).reshape(self.n, -1, k).sum(axis=1)
        residuals = residuals.reshape(self.n, -1)
        spread = long_run_sum(scores, residuals)
        spread /= max(1 - k / (independent_samples(residuals) * N / self.n), 0.5)  # the fit uses k degrees of freedom
        back = self.R_inverse / self.scale[:, None]
        return back @ z, back @ spread @ back.T


def independent_columns(R, tolerance=DEPENDENT):
    """Find the columns of R, of length 1 or 0, that are no combination of those before them.

    A column is a combination if its distance from the space of the others is at most `tolerance`. Returns: indices of
    the k columns kept; weights (k, p) that give all columns from them: R = R[:, kept] @ weights.
    """
    kept = list(range(R.shape[1]))
    while (own := np.abs(np.diag(np.linalg.qr(R[:, kept], mode="r")))).min() <= tolerance:
        del kept[int(np.argmax(own <= tolerance))]
    weights = np.linalg.lstsq(R[:, kept], R)[0]
    return kept, np.where(np.abs(weights) > tolerance, weights, 0.0)


def long_run_sum(scores, residuals):
    """Return the covariance (p, p) of the sum over time of correlated `scores`.

    scores: (n, p), the columns of A times the residuals; residuals: (n, k).

    It is the mean of the first B squared cosine coefficients ('equal-weighted cosine', Lazarus, Lewis, Stock and Watson
    2018), because the error of an estimate comes from noise at the frequencies next to zero. B = 0.4 n^(2/3), but so
    few that the spectrum of the residuals is flat among them: at most half of those that hold half of their power (a
    quarter of the cut-off for noise that was low-passed). Few coefficients make the errors themselves uncertain, so
    they are widened by Student's t with B degrees of freedom.
    """
    B = int(np.clip(independent_samples(residuals) // 4, 4, max(4, 0.4 * len(scores) ** (2 / 3))))
    coefficients = fft.dct(scores, axis=0)[1 : B + 1]
    wider = special.stdtrit(B, 0.99865) / 3.0  # three standard errors then enclose the truth 997 times in 1000
    return wider**2 * coefficients.T @ coefficients / (2 * B)


def independent_samples(residuals):
    """Return the number of independent samples in residuals (n, k).

    It is twice the number of cosine coefficients that hold half of their power.
    """
    power = np.cumsum(np.sum(fft.dct(residuals, axis=0) ** 2, axis=1))
    return max(2 * np.searchsorted(power, power[-1] / 2), 1)
