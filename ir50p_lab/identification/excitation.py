"""Motions from which the parameters can be told apart: Fourier series with the condition number made small."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError, LabError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.inputs import number, whole
from ir50p_lab.signals.fourier import Fourier, fourier

_SLOW = 0.1  # rad/s: about where a dry joint may stick
_POINTS = 300  # of a period
_BOLD = 0.3  # rad, of the first steps of the search


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """What `optimise_excitation` found.

    reference: Fourier, ready for a bench (`q_start` first); before: the random motion it began with; condition_before,
    condition_after: (3,), one per joint, of the columns scaled to length 1.
    """

    reference: Fourier
    before: Fourier
    condition_before: np.ndarray
    condition_after: np.ndarray


def regressor_condition(motion):
    """Condition number of the regressor along one period of a Fourier motion, its columns scaled to length 1: (3,).

    One per joint. 1 is best: every parameter is seen apart from the others. 100: of some combination the data say 100
    times less.
    """
    return _conditions(*_one_period(motion))


def _one_period(motion):
    t = motion.start + motion.period * (np.arange(_POINTS) + 0.5) / _POINTS
    return np.swapaxes(motion.sample(t), 0, 1)


def _conditions(q, qd, qdd):
    Phi = regressor(q, qd, qdd)
    parts = [Phi[:, joint, columns] for joint, columns in enumerate(RIGID_ON)]
    return np.array([np.linalg.cond(A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)) for A in parts])


def optimise_excitation(
    arm, *, period=10.0, harmonics=5, periods=11, max_joint_speed=None, table=0.0, margin=0.05, standing=4.0,
    tries=2000, seed=0, progress=True,
):  # fmt: skip
    """Fourier motion with a small condition number of the regressor, inside the limits of the arm    (4.2).

    Climbs: changes coefficients and mean pose at random, keeps what the limits allow (`fourier(..., arm=arm)`) and what
    makes the mean logarithm of the joints' condition numbers smaller. standing: price of time spent near standstill,
    where a joint may stick: the share of time, as 1/(1 + (qd/0.1 rad/s)^2), times this is added.

    Args: arm: Arm with finite joint limits. period: s; harmonics: 2..12; periods: length of the record; max_joint_speed,
    table, margin: as in `fourier`; tries; seed: the same seed gives the same motion; progress: show a bar.
    Returns: Excitation. Raises: InputError on bad arguments; IdentificationError if no motion fits the limits.
    """
    whole("harmonics", harmonics, 2, 12)
    number("period", period, "> 0", unit="s")
    low, high = np.array(arm.q_min), np.array(arm.q_max)
    if not np.isfinite([low, high]).all():
        raise InputError(f"{arm.name} has no joint limits: give q_min and q_max, dataclasses.replace(arm, q_min=...)")
    options = {"period": period, "periods": periods, "arm": arm, "max_joint_speed": max_joint_speed}
    options |= {"table": table, "margin": margin, "ends": "adjust"}
    generator, weight = np.random.default_rng(seed), 1 / np.tile(np.arange(1.0, harmonics + 1), 2)

    def motion_of(x):
        a, b = np.split(x[:, 1:], 2, axis=1)
        try:
            return fourier(a, b, q0=x[:, 0], **options)
        except LabError:
            return None

    def cost(motion):
        q, qd, qdd = _one_period(motion)
        return np.log(_conditions(q, qd, qdd)).mean() + standing * np.mean(1 / (1 + (qd / _SLOW) ** 2))

    def change(size):
        return size * generator.normal(size=(3, 1 + 2 * harmonics)) * np.r_[1.0, weight]

    for k in range(400):
        x = change(_BOLD * 0.99**k)
        x[:, 0] = low + (high - low) * generator.uniform(0.3, 0.7, 3)
        if (before := motion_of(x)) is not None:
            break
    else:
        remedy = f"widen the joint limits, lower the table ({table}), take less margin ({margin} rad) or another seed"
        raise IdentificationError(f"no motion was found inside the limits: {remedy}")
    from tqdm.auto import trange

    best, least, size = before, cost(before), _BOLD
    for _ in trange(tries, disable=not progress, desc="excitation"):
        motion = motion_of(new := x + change(size))
        found = np.inf if motion is None else cost(motion)
        if found < least:
            x, best, least = new, motion, found
        size = size * 1.1 if found <= least else max(0.01, 0.98 * size)
    return Excitation(
        reference=best,
        before=before,
        condition_before=regressor_condition(before),
        condition_after=regressor_condition(best),
    )
