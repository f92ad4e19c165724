"""The delay between a command and its effect, from a recording, and how well the recording determines it."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.recording_checks import at_bounds
from ir50p_lab.identification.time_series import columns_of, sampling_period

_FLAT = 1.01  # times the smallest residual: a delay that leaves less fits as well as the best one
_FEWEST = 200  # samples: if a joint moves in fewer, the recording is refused
_LONGEST = 0.15  # s: the longest delay tried


@dataclass(frozen=True, kw_only=True, eq=False)
class DelayEstimate:
    """What `estimate_delay` found.

    delay: s, median of the joints; stderr: s, from their scatter, inf at a bound of the search. per_joint (3,) s.
    delays (m,) s: those tried; rms (m, 3): residual of the best model with each. warnings: tuple of str.
    """

    delay: float
    stderr: float
    per_joint: np.ndarray
    delays: np.ndarray
    rms: np.ndarray
    warnings: tuple


def estimate_delay(recording, q=None, u=None, *, cutoff_hz=3.0, slow=0.1):
    """Delay from a sample to the moment its u acts: the one with which the best model leaves the smallest residual.

    For each delay from 0 to 0.15 s u is shifted, the rigid arm with friction is fitted anew, and the residuals are
    compared; u, q and all columns pass the same filter. With steps of the set point the delay is right within a period
    or two; with a smooth excitation it is off by up to ten, for there a delay looks like a little more inertia and
    friction.

    Args: recording, or t, q, u: of three joints. cutoff_hz, slow: as in `process`.
    Returns: DelayEstimate; a delay at a bound, 0 or 0.15 s, is named, its error is inf. Raises: InputError on bad
    arguments; IdentificationError if too little motion is left.
    """
    t, q, u = columns_of(recording, q, u)
    step = sampling_period(t)
    delays = step * np.arange(max(int(_LONGEST / step + 1e-9), 3) + 1)
    options = {"cutoff_hz": cutoff_hz, "slow": slow, "filter_u": True, "trim": max(delays[-1], 0.5)}
    motion = process(t, q, u, **options)
    if (fewest := int(motion.use.sum(axis=0).min())) < _FEWEST:
        raise IdentificationError(f"only {fewest} samples faster than slow = {slow} rad/s: record steps for a minute")
    Phi = regressor(motion.q, motion.qd, motion.qdd)
    driven = [process(t, q, u, delay=float(delay), **options).u for delay in delays]
    rms = np.empty((len(delays), 3))
    for joint, use in enumerate(motion.use.T):
        A = Phi[use, joint][:, RIGID_ON[joint]]
        y = np.column_stack([one[use, joint] for one in driven])
        rms[:, joint] = np.sqrt(np.mean((y - A @ np.linalg.lstsq(A, y, rcond=1e-9)[0]) ** 2, axis=0))
    per_joint = delays[rms.argmin(axis=0)]
    flat = max(np.ptp(np.flatnonzero(one <= _FLAT * one.min())) * step for one in rms.T)
    unsure, delay = max(np.ptp(per_joint), flat), np.median(per_joint)
    warnings, at = at_bounds([f"delay of joint {joint}" for joint in (1, 2, 3)], per_joint, 0.0, delays[-1])
    if unsure > 3 * step:
        warnings.append(f"this record tells the delay only within {unsure:.2g} s: record steps, where u jumps")
    stderr = np.inf if at[per_joint == delay].any() else max(np.std(per_joint) / np.sqrt(3), 0.3 * step)
    numbers = {"delay": float(delay), "stderr": float(stderr), "per_joint": per_joint, "delays": delays, "rms": rms}
    return DelayEstimate(**numbers, warnings=tuple(warnings))
