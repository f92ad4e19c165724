"""Noise against lag: every filter pays for one with the other. Numbers for one signal and many filters."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.signals.lag import measured_lag
from ir50p_lab.signals.low_pass import low_pass
from ir50p_lab.signals.velocity import VelocityKalman, difference_velocity


@dataclass(frozen=True)
class NoiseAndLag:
    """What one estimator of velocity does: name; noise: rms at rest, rad/s; lag: s, in motion; qd: (n,) rad/s."""

    name: str
    noise: float
    lag: float
    qd: np.ndarray


def velocity_estimators(rate_hz, *, noise, cutoffs_hz=(2.0, 5.0, 10.0), changes=(3.0, 10.0, 30.0)):
    """Estimators to compare: dict of name -> function from angles (n,) rad to velocities (n,) rad/s.

    rate_hz: samples per s; noise: rad rms of the angle, for the Kalman filters; cutoffs_hz: of differences behind a
    first-order low pass, Hz; changes: rad/s^2, of Kalman filters with constant velocity.
    """

    def difference(cutoff):
        return lambda q: difference_velocity(q, rate_hz, cutoff_hz=cutoff)

    def kalman(change):
        filter_ = VelocityKalman(1 / rate_hz, noise=noise, change=change)
        return lambda q: filter_.estimate(np.column_stack([q, q, q]))[1][:, 0]

    found = {"difference": difference(None)}
    found |= {f"difference, low pass {cutoff:g} Hz": difference(cutoff) for cutoff in cutoffs_hz}
    return found | {f"Kalman, {change:g} rad/s²": kalman(change) for change in changes}


def noise_and_lag(q, rate_hz, *, rest, motion, truth=None, estimators=None, max_lag=0.5):
    """Compare velocity estimators on one record of one joint.

    The lag is that of slow motion: truth and estimate pass the same zero-phase filter (2 Hz) before `measured_lag`
    compares them, which moves neither and takes away noise.

    Args:
        q: (n,) rad, measured. rate_hz: samples per s.
        rest, motion: slice or bool mask of the stretch where the joint stands, and of one where it speeds up and slows
            down (one run of samples).
        truth: (n,) rad/s, velocity to measure the lag against; default: `difference_velocity` of the record,
            zero-phase at 3 Hz, which has no lag.
        estimators: dict name -> function q (n,) -> qd (n,); default: `velocity_estimators`, with the noise found in
            the stretch at rest.
        max_lag: s, largest lag looked for.

    Returns: list of NoiseAndLag. Raises InputError on bad shapes, or if nothing moves in `motion`.
    """
    q = np.asarray(q, dtype=float)
    if q.ndim != 1 or not np.isfinite(q).all():
        raise InputError(f"q has shape {q.shape}: give the finite angles of one joint, (n,) rad")
    if truth is None:
        truth = difference_velocity(q, rate_hz, cutoff_hz=3.0, order=2, kind="zero-phase")
    truth = np.asarray(truth, dtype=float)
    for name, where in (("rest", rest), ("motion", motion)):
        if truth.shape != q.shape or len(q[where]) < 10:
            raise InputError(f"{name} holds {len(q[where])} samples and truth {truth.shape}: give 10 or more, and (n,)")
    same = min(2.0, rate_hz / 10)  # Hz: the motion is slow; noise above would hide where the two are most alike

    def slow(signal):
        return low_pass(signal, same, rate_hz, order=2, kind="zero-phase")[motion]

    if estimators is None:
        noise = max(float(np.std(q[rest])), 1e-6)
        estimators = velocity_estimators(rate_hz, noise=noise)
    found = []
    for name, estimate in estimators.items():
        qd = estimate(q)
        spread = float(np.sqrt(np.mean((qd[rest] - np.mean(qd[rest])) ** 2)))
        found.append(NoiseAndLag(name, spread, measured_lag(slow(truth), slow(qd), rate_hz, max_lag=max_lag), qd))
    return found
