"""Motions from which the parameters can be told apart: Fourier series with the condition number made small."""

import functools
import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.inputs import number, whole
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.signals.fourier import Fourier, fourier, heights, limits_of, series

_PER_HARMONIC = 32  # points of the grid per period of the fastest harmonic
_HIDDEN = 1 / math.cos(math.pi / _PER_HARMONIC) - 1  # of half the range: what may hide between the points
_TURN = 0.03  # rad/s: sgn(qd) as tanh(qd/_TURN), for a jump has no slope to follow
_SLOW = 0.1  # rad/s: about where a dry joint may stick
_WORST = 1e8  # condition number that counts as endless
_STEP = 1e-6  # rad, of the differences


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """What `optimise_excitation` found.

    reference: Fourier, ready for a bench (`q_start` first); before: the plain motion to compare with, random
    coefficients as large as the limits allow. condition_before, condition_after: (3,), one per joint, of the columns
    scaled to length 1.
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
    t = motion.start + motion.period * (np.arange(500) + 0.5) / 500
    return _conditions(regressor(*np.swapaxes(motion.sample(t), 0, 1)))


def _conditions(Phi):
    """Condition number of each joint's columns, scaled to length 1: (3,) for (n, 3, 20); inf from _WORST on."""
    parts = [Phi[:, joint, columns] for joint, columns in enumerate(RIGID_ON)]
    found = np.array([np.linalg.cond(A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)) for A in parts])
    return np.where(found < _WORST, found, np.inf)


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
    starts=4,
    iterations=80,
    seed=0,
    progress=True,
):
    """Fourier motion with the smallest condition number of the regressor that the limits of the arm allow    (4.2).

    Minimises the mean logarithm of the condition numbers of the joints' columns (those that act on the joint, each
    scaled to length 1) over the coefficients and the mean pose, by SLSQP from several random starts. From rest to rest
    by construction. Of the arm only lengths, limits and no-load speeds are used: what a drawing and a data sheet tell.

    Args:
        arm: Arm with finite joint limits. period: s; harmonics: 2..12; periods: whole number, length of the record.
        max_joint_speed, table, margin: as in `fourier`.
        standing: price of time spent near standstill, where a joint may stick and no theta says what u does: with 4, a
            share of 10 % (of 1/(1 + (qd/0.1 rad/s)^2)) counts as much as a condition number half as large again. On
            the simulated bench 4 raised, with 3 harmonics, the fit that any theta reaches from 89/61/96 to 94/91/96 %;
            with 5, on 20 pairs of motions, 30 in place of 8 raised joint 2 from 91.9 to 92.5 %.
        starts, iterations: more take longer (default: some ten seconds) and find a little better.
        seed: the same seed gives the same motion. progress: show a bar.

    Returns: Excitation. Raises: InputError on bad arguments; IdentificationError if no motion fits the limits.
    """
    lengths(arm)  # refuses what is no Arm
    if not np.isfinite([*arm.q_min, *arm.q_max]).all():
        raise InputError(f"{arm.name} has no joint limits: give q_min and q_max, dataclasses.replace(arm, q_min=...)")
    whole("harmonics", harmonics, 2, 12)
    number("standing", standing, ">= 0", hint="the price of time near standstill")
    number("period", period, "> 0", unit="s")
    limits = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    problem = _Problem(arm, period, harmonics, limits, standing)
    generator = np.random.default_rng(seed)
    found = []
    from tqdm.auto import tqdm

    for _ in tqdm(range(starts), disable=not progress, unit="start", desc="excitation"):
        x = problem.start(generator)
        if x is not None:
            found.append((*problem.improve(x, iterations), x))
    if not found:
        remedy = f"widen the joint limits, lower the table ({table}), take less margin ({margin} rad) or another seed"
        raise IdentificationError(f"no motion was found inside the limits in {starts} starts: {remedy}")
    best, first = min(found, key=lambda one: one[0])[1], found[0][2]
    options = {"period": period, "periods": periods, "arm": arm, "max_joint_speed": max_joint_speed}
    options |= {"table": table, "margin": margin, "ends": "adjust"}  # rounding only
    reference, before = (fourier(a, b, q0=q0, **options) for a, b, q0 in map(problem.split, (best, first)))
    return Excitation(
        reference=reference,
        before=before,
        condition_before=regressor_condition(before),
        condition_after=regressor_condition(reference),
    )


class _Problem:
    """The optimisation in coordinates that end at rest: x = (q0, then the free coefficients of a and b per joint)."""

    def __init__(self, arm, period, harmonics, limits, standing=0.0):
        self.l, self.standing = arm.l, standing
        self.low, self.high, self.speed, self.table = limits
        k = np.arange(1.0, harmonics + 1)
        self.Za, self.Zb = _null_space(k), _null_space(k**2)  # (N, N - 1)
        n = _PER_HARMONIC * harmonics
        self.period, self.t = period, (np.arange(n) + 0.5) / n * period

    def start(self, generator, tries=50):
        """Random coefficients, as large as the limits allow; None if not even the mean pose is allowed."""
        decay = np.tile(np.arange(1, self.Za.shape[1] + 1), 2)
        for _ in range(tries):
            q0 = self.low + (self.high - self.low) * generator.uniform(0.3, 0.7, 3)
            free = generator.normal(size=(3, len(decay))) / decay
            free *= (self.high - self.low)[:, None] / np.abs(free).sum(axis=1, keepdims=True)
            for size in np.geomspace(1, 0.03, 40):
                x = np.r_[q0, size * free.ravel()]
                if (self.evaluate(x)[1:] >= 0).all():
                    return x
        return None

    def evaluate(self, x):
        """Mean log condition with the price of standing, then the room left at each bound, >= 0 inside: (12,).

        Room per joint above, below and in speed; then of elbow and tip over the table.
        """
        q, qd, qdd = np.swapaxes(series(*self.split(x), self.period, self.t), 0, 1)
        still = np.mean(1 / (1 + (qd / _SLOW) ** 2))
        conditions = _conditions(regressor(q, qd, qdd, sign=_TURN))
        cost = np.log(np.minimum(conditions, _WORST)).mean() + self.standing * still
        more = _HIDDEN / 2 * np.ptp(q, axis=0)
        speed = self.speed - np.abs(qd).max(axis=0) * (1 + _HIDDEN)
        joints = [self.high - q.max(axis=0) - more, q.min(axis=0) - more - self.low, speed]
        table = -np.inf if self.table is None else self.table + _HIDDEN * (self.l[1] + self.l[2])
        over = [min(height.min() - table, 1e3) for height in heights(self.l, q)]
        return np.r_[cost, np.transpose(joints).ravel(), over]

    def improve(self, x, iterations):
        """SLSQP from x: (value, point) of the best point inside the bounds that was visited."""
        from scipy.optimize import minimize

        best = [self.evaluate(x)[0], x]

        def seen(x):
            for share in (1.0, 0.999, 0.99, 0.97, 0.94):  # a little less of a motion that is just outside
                less = np.r_[x[:3], share * x[3:]]
                value, *room = self.evaluate(less)
                if min(room) >= 0:
                    best[:] = min(best, [value, less], key=lambda pair: pair[0])
                    return

        @functools.lru_cache(2 * len(x))
        def known(x):
            return self.evaluate(np.frombuffer(x))

        inside = {"type": "ineq", "fun": lambda x: known(x.tobytes())[1:] - 1e-6}
        options = {"maxiter": iterations, "ftol": 1e-5, "eps": _STEP}
        minimize(lambda x: known(x.tobytes())[0], x, (), "SLSQP", constraints=inside, callback=seen, options=options)
        return best

    def split(self, x):
        """(a, b, q0) of the point x."""
        a, b = np.split(x[3:].reshape(3, -1), 2, axis=1)
        return a @ self.Za.T, b @ self.Zb.T, x[:3]


def _null_space(weight):
    """Orthonormal columns (N, N - 1) whose sums with `weight` are 0."""
    return np.linalg.qr(np.column_stack([weight, np.eye(len(weight))[:, 1:]]))[0][:, 1:]
