"""Whether residuals are white: what a good model leaves behind is noise that no past sample could have told."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.fit_input import finite
from ir50p_lab.inputs import whole


@dataclass(frozen=True, eq=False)
class Whiteness:
    """Autocorrelation of residuals, column by column.

    lags (m,) samples; correlation (m, k), of samples that far apart; bound: 2.58/sqrt(n), within which 99 in 100 lie
    if the residuals are white; p (k,): of the Ljung-Box test, small means not white.
    """

    lags: np.ndarray
    correlation: np.ndarray
    bound: float
    p: np.ndarray

    @property
    def white(self):
        """(k,) bool: p >= 0.01."""
        return self.p >= 0.01


def whiteness(residuals, *, lags=None):
    """Autocorrelation and Ljung-Box test of residuals.

        r_m = sum e_k e_k+m/sum e_k^2,    Q = n (n + 2) sum r_m^2/(n - m), chi-squared with `lags` degrees of freedom

    Args: residuals: (n,) or (n, k), evenly sampled, the mean is taken out; lags: whole number, default min(50, n/5).
    Returns: Whiteness. Raises InputError for fewer than 20 samples, numbers that are not finite, constant residuals.
    """
    e = finite("residuals", residuals)
    e = e[:, None] if e.ndim == 1 else e
    if e.ndim != 2 or len(e) < 20:
        raise InputError(f"residuals have shape {np.shape(residuals)}: give 20 or more, (n,) or (n, k), time first")
    n = len(e)
    lags = min(50, n // 5) if lags is None else whole("lags", lags, 1, n // 2)
    scale = np.abs(e).max(axis=0)
    e = e - e.mean(axis=0)
    power = (e**2).sum(axis=0)
    if (power <= n * (1e-12 * scale) ** 2).any():
        raise InputError("a column of residuals is constant: there is nothing to correlate")
    from scipy.stats import chi2

    m = np.arange(1, lags + 1)
    r = np.array([(e[k:] * e[:-k]).sum(axis=0) for k in m]) / power
    Q = n * (n + 2) * (r**2 / (n - m)[:, None]).sum(axis=0)
    return Whiteness(m, r, float(2.58 / np.sqrt(n)), chi2.sf(Q, lags))
