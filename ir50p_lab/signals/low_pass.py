"""Low-pass filters for sampled signals: for a record at once, and sample by sample in a loop (4.1.3 corrected)."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, number, numbers, whole


def low_pass(x, cutoff_hz, rate_hz, *, order=1, kind="causal"):
    """Butterworth low pass of a record; gain 1/sqrt(2) at the cut-off (zero-phase: 1/2).

    kind="causal" uses the past only, as a loop must: it starts settled on the first sample and comes late by `lag`.
    kind="zero-phase" runs forward and backward over the finished record: no lag, double the order, not for a loop.

    Args: x: (n,) or (n, k), time first; cutoff_hz: Hz, below rate_hz/2; rate_hz: samples per s; order: 1..8.
    Returns: array like x. Raises InputError for a cut-off at or above half the rate (the thesis' 300 Hz at 100 Hz), for
    numbers that are not finite, and for records too short to be run backward.
    """
    sections = _sections(cutoff_hz, rate_hz, order)
    x = _signal(x)
    from scipy.signal import sosfilt, sosfilt_zi, sosfiltfilt

    if kind == "causal":
        start = sosfilt_zi(sections).reshape(len(sections), 2, *[1] * (x.ndim - 1)) * x[0]
        return sosfilt(sections, x, axis=0, zi=start)[0]
    if kind != "zero-phase":
        raise InputError(f"kind = {kind!r}: choose 'causal' or 'zero-phase'")
    pad = max(3 * (2 * len(sections) + 1), min(len(x) - 1, math.ceil(rate_hz / cutoff_hz)))
    if len(x) <= pad:
        raise InputError(f"x has {len(x)} samples; to run backward it needs more than {pad}")
    return sosfiltfilt(sections, x, axis=0, padlen=pad)


class LowPass:
    """The causal filter of `low_pass`, sample by sample: the same numbers, for loops.

        smooth = LowPass(3.0, 100.0)
        for sample in bench.run(seconds=5):
            q = smooth.step(sample.q)

    Args as in `low_pass`. The first sample sets the size and counts as having been there for ever.
    """

    def __init__(self, cutoff_hz, rate_hz, *, order=1):
        self.sections = _sections(cutoff_hz, rate_hz, order)
        self.cutoff_hz, self.rate_hz, self.order = float(cutoff_hz), float(rate_hz), order
        self.reset()

    def reset(self):
        """Forget the past."""
        self._state = None

    def step(self, x):
        """The filtered sample; x: a number or (k,), always of the same shape. Raises InputError if not finite."""
        x = np.asarray(x, dtype=float)
        if not np.isfinite(x).all():
            raise InputError(f"x = {x.tolist()}: every sample must be finite; leave it out or repair it")
        if self._state is None:
            from scipy.signal import sosfilt_zi

            self._state = [[z * x for z in pair] for pair in sosfilt_zi(self.sections).tolist()]
        elif np.shape(self._state[0][0]) != x.shape:
            raise InputError(f"x has shape {x.shape}, the samples before {np.shape(self._state[0][0])}; reset first")
        for (b0, b1, b2, _, a1, a2), state in zip(self.sections.tolist(), self._state, strict=True):
            y = b0 * x + state[0]
            state[0] = b1 * x - a1 * y + state[1]
            state[1] = b2 * x - a2 * y
            x = y
        return x


def low_pass_lag(cutoff_hz, rate_hz, *, order=1, at_hz=0.0):
    """How late the causal filter is for slow motion (or at the frequency `at_hz`): its group delay, s.

    Order 1: about 1/(2 pi cutoff) = 53 ms at 3 Hz. Args as in `low_pass`; at_hz: number or (m,), below rate_hz/2.
    """
    sections, w = _sections(cutoff_hz, rate_hz, order), _angle(at_hz, rate_hz)
    z = np.exp(-1j * np.atleast_1d(w))[:, None]  # one sample of delay
    delay = np.zeros(len(z))
    for section in sections:
        for sign, c in ((1, section[:3]), (-1, section[3:])):  # - d phase/d w = Re(sum k c_k z^k / sum c_k z^k)
            powers = c * z ** np.arange(3)
            delay += sign * np.real((powers * np.arange(3)).sum(axis=1) / powers.sum(axis=1))
    delay /= rate_hz
    return float(delay[0]) if np.ndim(at_hz) == 0 else delay


@dataclass(frozen=True)
class FrequencyResponse:
    """f (m,) Hz; gain (m,), 1 = unchanged; phase (m,) rad, < 0 is late."""

    f: np.ndarray
    gain: np.ndarray
    phase: np.ndarray


def low_pass_response(cutoff_hz, rate_hz, *, order=1, f=None):
    """What the causal filter does to each frequency (Figure 4.3): FrequencyResponse; default f: up to half the rate."""
    sections = _sections(cutoff_hz, rate_hz, order)
    from scipy.signal import freqz_sos

    f = np.geomspace(rate_hz / 2000, 0.499 * rate_hz, 400) if f is None else np.atleast_1d(f).astype(float)
    _, H = freqz_sos(sections, worN=_angle(f, rate_hz))
    return FrequencyResponse(f=f, gain=np.abs(H), phase=np.unwrap(np.angle(H)))


def alias(f_hz, rate_hz):
    """Frequency that `f_hz` is taken for when sampled at `rate_hz`: 0..rate/2, Hz. 300 Hz at 100 Hz looks like 0."""
    rate_hz = _rate(rate_hz)
    f = np.asarray(f_hz, dtype=float)
    return np.abs(f - rate_hz * np.rint(f / rate_hz))


def _sections(cutoff_hz, rate_hz, order):
    rate_hz = _rate(rate_hz)
    whole("order", order, 1, 8)
    cutoff_hz = number("cutoff_hz", cutoff_hz, "> 0 or inf", unit="Hz")
    if cutoff_hz >= rate_hz / 2:
        raise InputError(
            f"cutoff_hz = {cutoff_hz:g} Hz, but samples at {rate_hz:g} Hz hold nothing above half their rate, "
            f"{rate_hz / 2:g} Hz: what was faster has become slow noise already and passes ({cutoff_hz:g} Hz looks "
            f"like {alias(cutoff_hz, rate_hz):g} Hz). Give 0 < cutoff_hz < {rate_hz / 2:g}; for this arm 2 to 10 Hz"
        )
    return _butterworth(order, float(cutoff_hz), rate_hz).copy()


@lru_cache(maxsize=64)  # a slider asks for the same few again and again
def _butterworth(order, cutoff_hz, rate_hz):
    from scipy.signal import butter

    return butter(order, cutoff_hz, fs=rate_hz, output="sos")


def _rate(rate_hz):
    return number("rate_hz", rate_hz, "> 0", hint="samples per second")


def _angle(f, rate_hz):
    f = np.asarray(f, dtype=float)
    if not ((f >= 0) & (f < rate_hz / 2)).all():
        raise InputError(f"frequency {f.tolist()} Hz: give 0 to below half the rate, {rate_hz / 2:g} Hz")
    return 2 * np.pi * f / rate_hz


def _signal(x):
    x = numbers("x", x)
    if x.ndim not in (1, 2) or len(x) < 2:
        raise InputError(f"x has shape {x.shape}; give at least two samples, (n,) or (n, k), time first")
    if not np.isfinite(x).all():
        raise InputError(f"x holds {first_not_finite(x)}: repair that sample before filtering, it would spread")
    return x
