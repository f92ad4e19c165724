"""Motions that tell the parameters apart: Fourier series that give the regressor a small condition number."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError, UnreachableError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.inputs import number, whole
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.signals.fourier import Fourier, fourier

_SLOW = 0.1  # rad/s: if a joint is slower, it may stick
_POINTS = 300  # points of a period at which the regressor is computed
_FIRST, _LAST = 0.3, 0.01  # rad: standard deviation of the first random changes, and of the smallest
_STARTS = 400  # random motions tried at first, from full size down to 2 %, until one stays inside the limits


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """What `optimise_excitation` found.

    reference: Fourier, ready for a bench (move to its `q_start` first); before: the random motion with which the search
    began. condition_before, condition_after: (3,), one per joint, of the columns scaled to length 1.
    """

    reference: Fourier
    before: Fourier
    condition_before: np.ndarray
    condition_after: np.ndarray


def regressor_condition(motion):
    """Return the condition number (3,) of the regressor along one period of a Fourier motion, one number per joint.

    Its columns are scaled to length 1. 1 is best: every parameter acts on the torque in its own way. 100 means that
    some combination of parameters acts on it 100 times less than another, and is found with 100 times the error.
    """
    return _judged(motion)[0]


def _judged(motion):
    """Condition numbers (3,) along one period, and the share of it near standstill, 1/(1 + (qd/0.1 rad/s)^2)."""
    t = motion.period * (np.arange(_POINTS) + 0.5) / _POINTS
    q, qd, qdd = np.swapaxes(motion.sample(t), 0, 1)
    Phi = regressor(q, qd, qdd)
    parts = [Phi[:, joint, columns] for joint, columns in enumerate(RIGID_ON)]
    conditions = [np.linalg.cond(A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)) for A in parts]
    return np.array(conditions), np.mean(1 / (1 + (qd / _SLOW) ** 2))


def optimise_excitation(
    arm,
    *,
    period=10.0,
    harmonics=5,
    periods=11,
    max_joint_speed=None,
    table=0.0,
    margin=0.05,
    standing=0.0,
    tries=2000,
    seed=0,
    progress=True,
):
    """Find a Fourier motion with a small condition number of the regressor, inside the limits of the arm    (4.2).

    It is a random search: the coefficients and the mean pose are changed at random, and a change is kept if the motion
    stays inside the limits and the cost becomes smaller: the mean logarithm of the joints' condition numbers (of the
    columns that act on the joint, each scaled to length 1), plus the price `standing`. Every motion goes from rest to
    rest by construction. Of the arm only lengths, limits and no-load speeds are used: what a drawing and a data sheet
    tell.

    Args:
        arm: Arm with finite joint limits. period: s; harmonics: 2..12; periods: whole number, length of the record.
        max_joint_speed, table, margin: as in `fourier`.
        standing: price of time near standstill, where a joint may stick and the model does not hold. With 4, a tenth of
            the time there (mean of 1/(1 + (qd/0.1 rad/s)^2)) costs as much as a condition number 1.5 times as large.
        tries: number of changes; more take longer (default: some seconds) and find a slightly better motion.
        seed: the same seed gives the same motion. progress: whether a bar is shown.

    Returns: Excitation. Raises: InputError on bad arguments; IdentificationError if no motion fits the limits.
    """
    lengths(arm)  # raises for anything but an Arm
    low, high = np.array(arm.q_min), np.array(arm.q_max)
    if not np.isfinite([low, high]).all():
        raise InputError(f"{arm.name} has no joint limits: give q_min and q_max, dataclasses.replace(arm, q_min=...)")
    whole("harmonics", harmonics, 2, 12)
    whole("tries", tries, 0, 10**9)
    number("standing", standing, ">= 0", hint="the price of time near standstill")
    limits = {"arm": arm, "max_joint_speed": max_joint_speed, "table": table, "margin": margin}
    generator, size = np.random.default_rng(seed), _FIRST
    decay = np.r_[1.0, np.tile(1 / np.arange(1.0, harmonics + 1), 2)]  # mean pose, a, b: fast harmonics change less

    def motion_of(x):
        """The motion of x (3, 1 + 2 N), rows (q0, a, b), or None if it leaves the limits."""
        a, b = np.split(x[:, 1:], 2, axis=1)
        try:
            return fourier(a, b, period=period, periods=periods, q0=x[:, 0], ends="adjust", **limits)
        except UnreachableError:
            return None

    def change():
        return size * decay * generator.normal(size=(3, len(decay)))

    def cost(motion):
        conditions, still = _judged(motion)
        return np.log(conditions).mean() + standing * still

    for share in np.geomspace(1, 0.02, _STARTS):
        x = share * change()
        x[:, 0] = low + (high - low) * generator.uniform(0.3, 0.7, 3)
        if (before := motion_of(x)) is not None:
            break
    else:
        remedy = f"widen the joint limits, lower the table ({table}), take less margin ({margin} rad) or another seed"
        raise IdentificationError(f"no motion was found inside the limits: {remedy}")
    from tqdm.auto import trange

    best, least = before, cost(before)
    for _ in trange(tries, disable=not progress, desc="excitation"):
        new = x + change()
        motion = motion_of(new)
        found = np.inf if motion is None else cost(motion)
        if found < least:
            x, best, least, size = new, motion, found, 1.1 * size
        else:
            size = max(_LAST, 0.98 * size)
    conditions = {"condition_before": regressor_condition(before), "condition_after": regressor_condition(best)}
    return Excitation(reference=best, before=before, **conditions)
