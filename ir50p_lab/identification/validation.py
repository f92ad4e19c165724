"""How good a model is on data it has not seen, as in Table 4.4 on raw PWM."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.fit_input import finite
from ir50p_lab.identification.processing import BOTH, process
from ir50p_lab.identification.time_series import columns_of, sampling_period
from ir50p_lab.inputs import number
from ir50p_lab.modelling.dynamics import as_theta


@dataclass(frozen=True, kw_only=True, eq=False)
class Validation:
    """Measured and predicted values compared, joint by joint.

    ========== ================================================================================== ======
    rms        of measured - predicted; unit of u, or rad for q                                   (3,)
    fit        100 (1 - |measured - predicted|/|measured - mean|) %, the fit of Table 4.4         (3,)
    t          of the samples compared, s                                                         (n,)
    measured   u of the recording as it stands, or q                                              (n, 3)
    predicted  by the model                                                                       (n, 3)
    of         "u" or "q"
    ========== ================================================================================== ======
    """

    rms: np.ndarray
    fit: np.ndarray
    t: np.ndarray
    measured: np.ndarray
    predicted: np.ndarray
    of: str

    @property
    def residuals(self):
        """The residuals measured - predicted, (n, 3)."""
        return self.measured - self.predicted


def nrmse_fit(measured, predicted):
    """Return the rms error and the fit of each column    (Table 4.4).

    fit = 100 (1 - |y - y_p|/|y - mean y|): 100 is perfect, 0 is no better than the mean, and below 0 is worse than
    that. It is not R^2: a fit of 70 % leaves 30 % of the amplitude, which is 9 % of the variance.

    Args: measured, predicted: (n,) or (n, k). Returns: (rms, fit), numbers or (k,). Raises InputError on shapes that
    differ, numbers that are not finite, or a measured column that never changes.

    >>> from ir50p_lab.identification import nrmse_fit
    >>> rms, fit = nrmse_fit([0, 1, 2, 3], [0, 1, 2, 2.9])
    >>> round(float(rms), 3), round(float(fit), 1)
    (0.05, 95.5)
    """
    y, p = finite("measured", measured), finite("predicted", predicted)
    if y.shape != p.shape or y.ndim not in (1, 2) or len(y) < 2:
        raise InputError(f"measured {y.shape} and predicted {p.shape}: give two arrays of one shape, (n,) or (n, k)")
    spread = np.sqrt(np.mean((y - y.mean(axis=0)) ** 2, axis=0))
    if np.any(spread <= 1e-12 * np.abs(y).max(axis=0)):
        raise InputError("a measured column never changes: the fit has no meaning there; leave that joint out")
    rms = np.sqrt(np.mean((y - p) ** 2, axis=0))
    return rms, 100 * (1 - rms / spread)


def validate(estimate, recording, q=None, u=None, *, derivatives=BOTH, cutoff_hz=1.5, delay=0.0, held=True, sign=None):
    """Predict the u of another recording from its angles, one sample at a time    (4.5), Table 4.4.

    The u of the recording is taken raw, as it was sent. The prediction is made from q, qd and qdd as `process` finds
    them, and read at the time when each u acted: its sample + delay (+ half a period while it is held).

    Args: estimate: Estimate or theta (3, 20); recording, or t, q, u; derivatives, cutoff_hz, delay, held: as in
    `process`; sign: as in `regressor`.
    Returns: Validation of "u". Raises InputError, IdentificationError as `process` does.
    """
    theta, _ = as_theta(getattr(estimate, "theta", estimate))
    t, q, u = columns_of(recording, q, u)
    motion = process(t, q, u, derivatives=derivatives, cutoff_hz=cutoff_hz, held=False)
    predicted = np.einsum("nij,ij->ni", regressor(motion.q, motion.qd, motion.qdd, sign=sign), theta)
    still = 0.5 * np.diff(t, append=t[-1] + sampling_period(t)) if held and derivatives == BOTH else 0.0
    acts = t + number("delay", delay, ">= 0", unit="s") + still
    after = np.searchsorted(motion.t, acts).clip(1, len(motion) - 1)
    inside = (acts >= motion.t[after - 1]) & (acts <= motion.t[after])
    inside &= motion.segment[after] == motion.segment[after - 1]
    found = np.column_stack([np.interp(acts[inside], motion.t, p) for p in predicted.T])
    return compare_signals(t[inside], u[inside], found, "u")


def compare_signals(t, measured, predicted, of):
    """Return the Validation of "u" or "q" (`of`); t (n,) s, measured and predicted (n, 3)."""
    rms, fit = nrmse_fit(measured, predicted)
    return Validation(rms=rms, fit=fit, t=t, measured=measured, predicted=predicted, of=of)
