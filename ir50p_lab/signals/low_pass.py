"""Low-pass filters for sampled signals, applied to a whole record at once (4.1.3 corrected)."""

import math

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, first_not_finite, number, numbers, whole


def low_pass(x, cutoff_hz, rate_hz, *, order=1, kind="causal"):
    """Filter a record with a Butterworth low pass; its gain at the cut-off is 1/sqrt(2) (Figure 4.3; zero-phase: 1/2).

    kind="causal" uses only the past, as a loop must. It starts settled on the first sample and lags by 1/(2 pi cutoff).
    kind="zero-phase" runs forward and backward over the finished record: no lag and double the order, but no loop can
    use it.

    Args: x: (n,) or (n, k), time first; cutoff_hz: Hz, below rate_hz/2; rate_hz: samples per s; order: 1..8.
    Returns: array like x. Raises InputError for a cut-off at or above half the rate (the thesis's 300 Hz at 100 Hz),
    for numbers that are not finite, and for records too short to be run backward.

    >>> from ir50p_lab.signals import low_pass
    >>> low_pass([0, 1, 1, 1], cutoff_hz=3, rate_hz=100).round(3)
    array([0.   , 0.086, 0.244, 0.375])
    """
    sections = _sections(cutoff_hz, rate_hz, order)
    x = _signal(x)
    from scipy.signal import sosfilt, sosfiltfilt

    if choice("kind", kind, ("causal", "zero-phase")) == "causal":
        return sosfilt(sections, x, axis=0, zi=_settled(sections, x[0]))[0]
    pad = max(3 * (2 * len(sections) + 1), min(len(x) - 1, math.ceil(rate_hz / cutoff_hz)))
    if len(x) <= pad:
        raise InputError(f"x has {len(x)} samples; to run backward it needs more than {pad}")
    return sosfiltfilt(sections, x, axis=0, padlen=pad)


def alias(f_hz, rate_hz):
    """Return the frequency for which `f_hz` is taken when it is sampled at `rate_hz`, 0 to rate_hz/2, Hz.

    f_hz: Hz, a number or an array. 300 Hz sampled at 100 Hz looks like 0 Hz.
    """
    rate_hz = number("rate_hz", rate_hz, "> 0", hint="samples per second")
    f = np.asarray(f_hz, dtype=float)
    return np.abs(f - rate_hz * np.rint(f / rate_hz))


def _sections(cutoff_hz, rate_hz, order):
    rate_hz = number("rate_hz", rate_hz, "> 0", hint="samples per second")
    whole("order", order, 1, 8)
    cutoff_hz = number("cutoff_hz", cutoff_hz, "> 0 or inf", unit="Hz")
    if cutoff_hz >= rate_hz / 2:
        raise InputError(
            f"cutoff_hz = {cutoff_hz:g} Hz, but samples at {rate_hz:g} Hz hold nothing above half their rate, "
            f"{rate_hz / 2:g} Hz: what was faster has become slow noise already and passes ({cutoff_hz:g} Hz looks "
            f"like {alias(cutoff_hz, rate_hz):g} Hz). Give 0 < cutoff_hz < {rate_hz / 2:g}; for this arm 2 to 10 Hz"
        )
    from scipy.signal import butter

    return butter(order, cutoff_hz, fs=rate_hz, output="sos")


def _settled(sections, x):
    """Memory of the filter after a signal that has been x (a number or (k,)) for ever."""
    from scipy.signal import sosfilt_zi

    return np.multiply.outer(sosfilt_zi(sections), x)


def _signal(x):
    x = numbers("x", x)
    if x.ndim not in (1, 2) or len(x) < 2:
        raise InputError(f"x has shape {x.shape}; give at least two samples, (n,) or (n, k), time first")
    if not np.isfinite(x).all():
        raise InputError(f"x holds {first_not_finite(x)}: repair that sample before filtering, it would spread")
    return x
