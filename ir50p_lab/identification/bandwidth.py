"""How fast a recording may be looked at: the cut-off below which the angle is motion, above which it is noise."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.identification.columns import quantum_of

_BIAS = 1e-3  # noise power in the acceleration over its own: the inertia is too small by about as much
_MOTION = 0.99  # share of the velocity's power that must stay below the cut-off, whatever the noise
_BEARABLE = 0.05  # the same, up to which the cut-off is raised to keep the motion
_SIGN = 0.02  # the same for the speed whose sign is taken
_HIGHEST = 0.2  # of the rate: above, central differences themselves are wrong by more than a quarter


@dataclass(frozen=True)
class Bandwidth:
    """What the spectrum of an angle tells.

    cutoff_hz: of the low pass for a regression, Hz. sign_cutoff_hz: higher, for the speed whose sign is taken: a smooth
    speed turns too late or too early. noise: rms of the angle, rad (white part). speed: rad/s rms of the motion;
    speed_noise: rad/s rms; acceleration_share: noise power over power of the acceleration; all three below cutoff_hz.
    """

    cutoff_hz: float
    sign_cutoff_hz: float
    noise: float
    speed_noise: float
    acceleration_share: float
    speed: float


def bandwidth(q, rate_hz, cutoff_hz=None):
    """Choose the cut-off for q (n,) rad, evenly sampled at rate_hz, or judge a given one.

    White noise of the sensor is what the spectrum holds between a quarter and half of the rate; the steps of a coarse
    one count as noise too, spread over the frequencies at which they come. The highest cut-off is taken whose
    acceleration holds at most 0.1 % of noise power (noise in a regressor pulls its parameter towards zero by that
    share), but at least the one that keeps 99 % of the velocity's power, as long as that holds no more than 5 %.
    """
    from scipy.signal import welch

    n = len(q)
    f, power = welch(q - q.mean(), rate_hz, nperseg=min(n, max(256, n // 6)), detrend="linear")
    f, power = f[1:], power[1:]
    step = f[1] - f[0]
    floor = float(np.median(power[f >= rate_hz / 4])) / math.log(2)  # median of a chi-squared with 2 degrees
    floor = max(floor, _coarseness(q, rate_hz))
    w2 = (2 * np.pi * f) ** 2
    above = np.clip(power - floor, 0.0, None)
    above[power < 3 * floor] = 0.0
    speed, speed_noise = np.cumsum(w2 * above) * step, np.cumsum(w2) * floor * step
    share = np.cumsum(w2**2) * floor / np.maximum(np.cumsum(w2**2 * above), 1e-300)
    speed_share = speed_noise / np.maximum(speed, 1e-300)
    highest = int(np.searchsorted(f, _HIGHEST * rate_hz))
    if cutoff_hz is None:
        good = np.flatnonzero(share[:highest] <= _BIAS)
        bearable = np.flatnonzero(share[:highest] <= _BEARABLE)
        needed = min(int(np.searchsorted(speed, _MOTION * speed[-1])), int(bearable[-1]) if len(bearable) else highest)
        at = min(max(int(good[-1]) if len(good) else 0, needed), highest - 1)
        cutoff_hz = float(f[at])
    at = min(int(np.searchsorted(f, cutoff_hz)), len(f) - 1)
    good = np.flatnonzero(speed_share[:highest] <= _SIGN)
    sign_at = max(at, int(good[-1]) if len(good) else 0)
    return Bandwidth(
        cutoff_hz=float(cutoff_hz),
        sign_cutoff_hz=max(float(f[sign_at]), float(cutoff_hz)),
        noise=math.sqrt(floor * rate_hz / 2),
        speed_noise=math.sqrt(speed_noise[at]),
        acceleration_share=float(min(share[at], 1e6)),
        speed=math.sqrt(speed[at]),
    )


def _coarseness(q, rate_hz):
    """Power density of the steps of a coarse angle, rad^2/Hz: step^2/12 over as many Hz as steps come in a second."""
    step = quantum_of(q)
    if step == 0:
        return 0.0
    path = float(np.abs(np.diff(q)).sum())
    steps_per_second = path / step * rate_hz / len(q)
    return step**2 / 12 / min(max(steps_per_second, rate_hz / len(q)), rate_hz / 2)
