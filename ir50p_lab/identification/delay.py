"""The delay between a command and its effect, from a recording; and how well a recording can tell it."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.columns import columns_of, sampling_period
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.identification.processing import process

_FLAT = 1.01  # a residual this near to the smallest does not speak against a delay
_FEWEST = 200  # samples in motion, of each joint
_LONGEST = 0.15  # s
_BLOCKS = 6  # stretches of the record that are compared for the standard error


@dataclass(frozen=True, kw_only=True, eq=False)
class DelayEstimate:
    """What `estimate_delay` found.

    delay: s, median of the joints; stderr: s, the larger of what the joints and what stretches of the record differ by.
    per_joint (k,) s. delays (m,) s: those tried; rms (m, k): residual of the best model with each.
    warnings: tuple of str.
    """

    delay: float
    stderr: float
    per_joint: np.ndarray
    delays: np.ndarray
    rms: np.ndarray
    warnings: tuple


def estimate_delay(recording, q=None, u=None, *, cutoff_hz=3.0, slow=0.1):
    """Delay from a sample to the moment its u acts: the one with which the best model leaves the smallest residual.

    For each delay that is tried, u is shifted, the model is fitted anew (three joints: the rigid arm with friction; one
    joint: inertia, friction, offset), and what is left is compared; u, q and all columns pass the same filter.

    How well this can be done (simulated bench, delays of 0, 2 and 5 periods of 10 ms): from steps of the set point
    within one or two periods, for there u jumps and the joint answers; from a Fourier excitation it is off by up to ten
    periods, for there a delay looks like a little more inertia and friction. Backlash and a dead zone look like delay.

    Args: recording, or t, q, u: as in `process`. cutoff_hz, slow: as in `process`; slow leaves out where a joint may
    stick. Delays from 0 to 0.15 s are tried, by whole periods.

    Returns: DelayEstimate. Raises: InputError on bad arguments; IdentificationError if too little motion is left.
    """
    t, q, u = columns_of(recording, q, u)
    joints = q.shape[1]
    if joints not in (1, 3):
        raise InputError(f"q has {joints} columns: give one joint, or all three")
    step = sampling_period(t)
    delays = step * np.arange(max(int(_LONGEST / step + 1e-9), 3) + 1)
    options = {"cutoff_hz": cutoff_hz, "slow": slow, "filter_u": True, "trim": max(delays[-1], 0.5)}
    motion = process(t, q, u, **options)
    fewest = int(motion.use.sum(axis=0).min())
    if fewest < _FEWEST:
        raise IdentificationError(f"only {fewest} samples faster than slow = {slow} rad/s: record steps for a minute")
    driven = [process(t, q, u, delay=float(delay), **options).u for delay in delays]
    left = [_left(motion, driven, joint) ** 2 for joint in range(joints)]
    per_joint = np.array([_least(delays, one.sum(axis=0)) for one in left])
    parts = zip(*(np.array_split(one, _BLOCKS) for one in left), strict=True)
    by_block = [np.median([_least(delays, one.sum(axis=0)) for one in part]) for part in parts]
    stderr = max(np.std(by_block, ddof=1) / np.sqrt(_BLOCKS), np.std(per_joint) / np.sqrt(joints), 0.3 * step)
    rms = np.sqrt(np.column_stack([one.mean(axis=0) for one in left]))
    flat = max(np.ptp(np.flatnonzero(one <= _FLAT * one.min())) * step for one in rms.T)
    unsure, warnings = max(np.ptp(per_joint), flat), ()
    if unsure > 3 * step or (per_joint >= delays[-1]).any():
        warnings = (f"this record tells the delay only within {unsure:.2g} s: record steps, where u jumps",)
    return DelayEstimate(
        delay=float(np.median(per_joint)),
        stderr=float(stderr),
        per_joint=per_joint,
        delays=delays,
        rms=rms,
        warnings=warnings,
    )


def _left(motion, driven, joint):
    """What the model of one joint leaves of each u in `driven`, (m, len(driven)), of the samples to be used."""
    use = motion.use[:, joint]
    if motion.q.shape[1] == 3:
        A = regressor(motion.q, motion.qd, motion.qdd)[use, joint][:, RIGID_ON[joint]]
    else:
        v = motion.qd[use, 0]
        A = np.column_stack([motion.qdd[use, 0], v, np.sign(v), np.ones_like(v)])
    y = np.column_stack([u[use, joint] for u in driven])
    A = A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)
    return y - A @ np.linalg.lstsq(A, y, rcond=1e-9)[0]


def _least(delays, power):
    """Delay of the smallest power, between the points by a parabola."""
    m = int(power.argmin())
    if m in (0, len(power) - 1):
        return float(delays[m])
    before, here, after = power[m - 1 : m + 2]
    bend = before - 2 * here + after
    return float(delays[m] + (0.5 * (before - after) / bend if bend > 0 else 0.0) * (delays[1] - delays[0]))
