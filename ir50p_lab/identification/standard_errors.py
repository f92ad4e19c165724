"""How sure an estimate is when its residuals are not white: the sandwich of scores, classical or HAC."""

import numpy as np
from scipy import fft, special

from ir50p_lab.identification.qr import gram


def sandwich(bread, rows, residuals, n, errors):
    """Covariance B^-1 S B^-T of an estimate that solves sum of rows^T residuals = 0.

    S is the covariance of that sum. Classical: residuals white, each equation with its own variance. HAC
    (heteroskedasticity and autocorrelation consistent): from the spectrum of the scores near frequency zero.

    Args:
        bread: (p, p), derivative of the sum by the parameters.
        rows: (N, p); residuals: (N,): N = n k equations, k of them (1 or 3 joints) per sample, sample by sample.
        errors: "classical" or "hac".
    """
    N, p = rows.shape
    joints = N // n
    if errors == "classical":
        blocks = [(rows[j::joints], residuals[j::joints]) for j in range(joints)]
        S = N / (N - p) * sum(np.mean(r**2) * gram(block, block) for block, r in blocks)
    else:
        scores = (rows * residuals[:, None]).reshape(n, joints, p).sum(axis=1)
        S, independent = long_run_sum(scores, residuals.reshape(n, joints))
        S *= 1 / max(1 - p / (independent * joints), 0.5)  # p of them were spent on the fit
    return np.linalg.solve(bread, np.linalg.solve(bread, S).T)


def long_run_sum(scores, residuals):
    """Covariance (p, p) of the sum over time of correlated `scores` (n, p); independent samples in `residuals` (n, k).

    Mean of the first B squared cosine coefficients ('equal-weighted cosine', Lazarus, Lewis, Stock and Watson 2018):
    what matters for an estimate is the noise at the frequencies next to zero. B = 0.4 n^(2/3), but no more than where
    the residuals' spectrum is still flat, taken as half of the band that holds half of their power (a quarter of the
    cut-off for noise that was low-passed). Few coefficients make the errors themselves uncertain: they are widened as
    Student's t with B degrees of freedom asks.
    """
    n = len(scores)
    power = np.cumsum(np.sum(fft.dct(residuals, axis=0) ** 2, axis=1))
    half = np.searchsorted(power, power[-1] / 2)
    B = int(np.clip(half // 2, 4, max(4, 0.4 * n ** (2 / 3))))
    coefficients = fft.dct(scores, axis=0)[1 : B + 1]
    wider = special.stdtrit(B, 0.99865) / 3.0  # three standard errors then hold the truth 997 times in 1000
    return wider**2 * coefficients.T @ coefficients / (2 * B), max(2 * half, 1)


def lag_one(residuals):
    """Correlation of neighbouring residuals, (3,) for (n, 3): 0 for white noise, near 1 after a low-pass."""
    power = np.sum(residuals**2, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.nan_to_num(np.sum(residuals[1:] * residuals[:-1], axis=0) / power)
