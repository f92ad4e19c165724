"""What the spectrum of an angle tells: below which frequency it is motion, above which it is noise."""

import math
from types import SimpleNamespace

import numpy as np

from ir50p_lab.identification.columns import quantum_of

_BIAS = 1e-3  # noise power in the acceleration over its own: the inertia is too small by about as much
_MOTION = 0.99  # share of the velocity's power that must stay below the cut-off, whatever the noise
_BEARABLE = 0.05  # the same as _BIAS, up to which the cut-off is raised to keep the motion
_SIGN = 0.02  # the same for the speed whose sign is taken
_STRETCH = 8  # periods of the cut-off, at least, in a stretch of steady speed
_SAW = 0.06  # step^2, a little more than 1/(2 pi^2)
_HIGHEST = 0.2  # of the rate: above, central differences themselves are wrong by more than a quarter


def spectrum(pieces, rate_hz, cutoff_hz=None, *, of_speed=False):
    """Choose the cut-off for an angle, or check a given one. pieces: list of (n,) rad, each evenly sampled at rate_hz;
    with of_speed a measured speed, rad/s, in place of the angle.

    White noise of the sensor is what the spectrum holds between a quarter and half of the rate; the steps of a coarse
    one count as noise too, spread over the frequencies at which they come. The highest cut-off is taken whose
    acceleration holds at most 0.1 % of noise power (noise in a regressor pulls its parameter towards zero by that
    share), but at least the one that keeps 99 % of the velocity's power, as long as that holds no more than 5 %.
    Steady speed, which the spectrum does not show, counts as motion.

    Returns a namespace. cutoff_hz: of the low pass for a regression, the highest that noise allows, Hz. lowest_hz: that
    keeps 99 % of the velocity's power. sign_cutoff_hz: higher, for the speed whose sign is taken: a smooth speed turns
    too late or too early. speed: rad/s rms of the motion; speed_noise: rad/s rms; acceleration_share: noise power over
    power of the acceleration; all three below cutoff_hz. unfiltered_noise: of a measured speed without low pass,
    rad/s rms: what its spectrum and its bends both show.
    """
    from scipy.signal import welch

    length = min(max(map(len, pieces)), max(256, sum(map(len, pieces)) // 6))
    pieces = [q for q in pieces if len(q) >= length]
    spectra = [welch(q - q.mean(), rate_hz, nperseg=length, detrend="linear") for q in pieces]
    sizes = np.array([len(q) for q in pieces], dtype=float)
    f, power = spectra[0][0][1:], np.average([density for _, density in spectra], axis=0, weights=sizes)[1:]
    steady = _steady_speed([np.cumsum(q) / rate_hz for q in pieces] if of_speed else pieces, length, rate_hz)
    step = f[1] - f[0]
    floor = float(np.median(power[f >= rate_hz / 4])) / math.log(2)  # median of a chi-squared with 2 degrees
    floor = max(floor, _coarseness(pieces, rate_hz))
    w2 = (2 * np.pi * f) ** 2
    above = np.clip(power - floor, 0.0, None)
    # a slow ramp seen in steps is a saw with lines of (step/pi)^2/2: no motion either
    above[(power < 3 * floor) | (power * step < _SAW * quantum_of(np.concatenate(pieces)) ** 2)] = 0.0
    to_speed = np.ones_like(f) if of_speed else w2
    speed, speed_noise = np.cumsum(to_speed * above) * step, np.cumsum(to_speed) * floor * step
    noise, motion = np.cumsum(w2 * to_speed) * floor, np.cumsum(w2 * to_speed * above)
    share, speed_share = noise / np.maximum(motion, 1e-12 * noise), speed_noise / np.maximum(speed, 1e-12 * speed_noise)
    highest = int(np.searchsorted(f, _HIGHEST * rate_hz))
    lowest = int(np.searchsorted(speed, _MOTION * speed[-1]))
    if cutoff_hz is None:
        good = np.flatnonzero(share[:highest] <= _BIAS)
        bearable = np.flatnonzero(share[:highest] <= _BEARABLE)
        needed = min(lowest, int(bearable[-1]) if len(bearable) else highest)
        if steady**2 > speed[-1]:  # sweeps of steady speeds: a filter shorter than the stretches
            needed = lowest = max(needed, _STRETCH)
        cutoff_hz = float(f[min(max(int(good[-1]) if len(good) else 0, needed), highest - 1)])
    at = min(int(np.searchsorted(f, cutoff_hz)), len(f) - 1)
    good = np.flatnonzero(speed_share[:highest] <= _SIGN)
    sign_at = max(at, int(good[-1]) if len(good) else 0)
    return SimpleNamespace(
        cutoff_hz=float(cutoff_hz),
        lowest_hz=float(f[min(lowest, len(f) - 1)]),
        sign_cutoff_hz=max(float(f[sign_at]), float(cutoff_hz)),
        speed_noise=math.sqrt(speed_noise[at]),
        unfiltered_noise=min(math.sqrt(speed_noise[-1]), _bends(pieces)),
        acceleration_share=float(min(share[at], 1e6)),
        speed=math.hypot(math.sqrt(speed[at]), steady),
    )


def _steady_speed(pieces, length, rate_hz):
    """Root mean square of the mean speeds of stretches of `length` samples, rad/s: what detrending takes away."""
    ends = [q[k * length : (k + 1) * length][[0, -1]] for q in pieces for k in range(len(q) // length)]
    return float(np.sqrt(np.mean(np.diff(ends, axis=1) ** 2))) * rate_hz / max(length - 1, 1)


def _bends(pieces):
    """Noise, rms, that would have these second differences: steady stretches and steps between them have none."""
    bends = np.abs(np.concatenate([np.diff(x, 2) for x in pieces]))
    return float(np.median(bends)) / 0.6745 / math.sqrt(6)


def _coarseness(pieces, rate_hz):
    """Power density of the steps of a coarse angle, rad^2/Hz: step^2/12 over as many Hz as steps come in a second."""
    q = np.concatenate(pieces)
    step = quantum_of(q)
    if step == 0:
        return 0.0
    steps_per_second = sum(float(np.abs(np.diff(piece)).sum()) for piece in pieces) / step * rate_hz / len(q)
    return step**2 / 12 / min(max(steps_per_second, rate_hz / len(q)), rate_hz / 2)
