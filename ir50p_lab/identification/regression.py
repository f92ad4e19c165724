"""Least squares for a few columns with standard errors that stay honest when residuals are alike (HAC)."""

import math
from dataclasses import dataclass

import numpy as np

_TOLERANCE = 1e-6  # share of a column's power that the others do not hold, below which it has no answer of its own


@dataclass(frozen=True)
class Solution:
    """x (p,) with stderr (p,); dropped: indices of columns without an answer of their own (x = 0, stderr = inf).

    residuals (n,); rms; correlation of neighbouring residuals; condition of the column-normalised matrix.
    """

    x: np.ndarray
    stderr: np.ndarray
    dropped: tuple
    residuals: np.ndarray
    rms: float
    correlation: float
    condition: float


def solve(A, y, *, drop_first=(), lags=None):
    """Least squares A x = y by QR; columns that the others hold already are dropped, those of `drop_first` first.

    The covariance is that of Newey and West (Bartlett weights): residuals that stay alike for `lags` samples carry
    less information than their number. lags: default 4 (n/100)^(2/9), at least until their correlation has died out.
    """
    n, p = A.shape
    size = np.linalg.norm(A, axis=0)
    kept = [j for j in range(p) if size[j] > 0]
    order = [j for j in drop_first if j in kept] + [j for j in kept if j not in drop_first]
    for j in order:
        others = [k for k in kept if k != j]
        if others and _own_share(A[:, j] / size[j], A[:, others] / size[others]) < _TOLERANCE:
            kept = others
    dropped = tuple(j for j in range(p) if j not in kept)
    B = A[:, kept] / size[kept]
    Q, R = np.linalg.qr(B)
    x = np.linalg.solve(R, Q.T @ y)
    r = y - B @ x
    covariance = _hac(Q, R, r, lags)
    out, stderr = np.zeros(p), np.full(p, np.inf)
    out[kept], stderr[kept] = x / size[kept], np.sqrt(np.diag(covariance)) / size[kept]
    power = float(r @ r)
    scale = float(y @ y)
    correlation = float(r[1:] @ r[:-1] / power) if power > 1e-24 * scale else 0.0
    return Solution(out, stderr, dropped, r, math.sqrt(power / n), correlation, float(np.linalg.cond(B)))


def _own_share(column, others):
    """Share of the power of `column` (of length 1) that `others` cannot express."""
    Q, _ = np.linalg.qr(others)
    left = column - Q @ (Q.T @ column)
    return float(left @ left)


def _hac(Q, R, r, lags):
    n, p = Q.shape
    lags = correlation_length(r) if lags is None else lags
    lags = int(min(max(lags, math.ceil(4 * (n / 100) ** (2 / 9))), n // 4))
    scores = Q * r[:, None]
    S = scores.T @ scores
    for k in range(1, lags + 1):
        part = scores[k:].T @ scores[:-k]
        S += (1 - k / (lags + 1)) * (part + part.T)
    inverse = np.linalg.solve(R, np.eye(p))
    covariance = inverse @ S @ inverse.T * n / max(n - p, 1)
    # Bartlett weights leave out the slow part of the correlation: never below what independent residuals give
    white = inverse @ inverse.T * float(r @ r) / max(n - p, 1)
    flat = np.maximum(np.diag(covariance), np.diag(white))
    return covariance + np.diag(flat - np.diag(covariance))


def correlation_length(r):
    """Twice the number of samples after which residuals r (n,) are no longer alike (correlation < 2/sqrt(n))."""
    n = len(r)
    power = float(r @ r)
    if power <= 0:
        return 0
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(r, size)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2, size)[: max(n // 8, 2)] / power
    quiet = np.flatnonzero(correlation < 2 / math.sqrt(n))
    return 2 * int(quiet[0] if len(quiet) else len(correlation))
