"""Motions from which the parameters can be told apart: Fourier series with the condition number made small."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.parameters import RIGID_ON
from ir50p_lab.inputs import number, whole
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.signals.fourier import Fourier, at_rest, fourier, heights, limits_of, series

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


def regressor_condition(reference):
    """Condition number of the regressor along one period of a motion, its columns scaled to length 1: (3,), per joint.

    1 is best: every parameter is seen apart from the others. 100: of some combination the data say 100 times less.
    reference: Fourier, or any Reference with a finite duration > 0. Raises InputError.
    """
    length = getattr(reference, "period", None) or getattr(reference, "duration", 0.0)
    if not (math.isfinite(length) and length > 0):
        raise InputError(f"the reference lasts {length} s: give a motion of finite length > 0, such as `fourier`")
    t = getattr(reference, "start", 0.0) + length * (np.arange(500) + 0.5) / 500
    return _conditions(regressor(*np.swapaxes(reference.sample(t), 0, 1))[None])[0]


def _conditions(Phi):
    """Condition number of each joint's columns, scaled to length 1: (m, 3) for (m, n, 3, 20); inf from _WORST on."""
    found = np.empty((len(Phi), 3))
    for joint, columns in enumerate(RIGID_ON):
        A = Phi[:, :, joint, columns]
        G = np.swapaxes(A, 1, 2) @ A
        size = np.sqrt(np.einsum("mpp->mp", G))
        size[size == 0] = np.inf
        values = np.linalg.eigvalsh(G / (size[:, :, None] * size[:, None, :]))
        found[:, joint] = np.sqrt(values[:, -1] / np.maximum(values[:, 0], 1e-300))
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
    whole("periods", periods, 1, 10**6)
    whole("starts", starts, 1, 10**4)
    whole("iterations", iterations, 1, 10**5)
    whole("seed", seed, 0, 2**63)
    number("standing", standing, ">= 0", hint="the price of time near standstill")
    number("period", period, "> 0", unit="s")
    limits = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    problem = _Problem(arm, period, harmonics, limits, standing)
    generator = np.random.default_rng(seed)
    first, found = [], []
    from tqdm.auto import tqdm

    with tqdm(total=starts * iterations, disable=not progress, unit="step", desc="excitation") as bar:
        for start in range(starts):
            x = problem.start(generator)
            if x is None:
                continue
            first.append(x)
            found.append(problem.improve(x, iterations, bar.update))
            bar.update((start + 1) * iterations - bar.n)
            bar.set_postfix_str(f"condition {math.exp(min(value for value, _ in found)):.3g}")
    if not found:
        raise IdentificationError(
            f"no motion was found inside the limits in {starts} starts: widen the joint limits, lower the table "
            f"({table}), take less margin ({margin} rad), or give another seed"
        )
    best = min(found, key=lambda pair: pair[0])[1]
    options = {"period": period, "periods": periods, "arm": arm, "max_joint_speed": max_joint_speed}
    options |= {"table": table, "margin": margin, "ends": "adjust"}  # rounding only
    reference, before = (fourier(a, b, q0=q0, **options) for a, b, q0 in map(problem.split, (best, first[0])))
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
        self.size = 3 + 6 * (harmonics - 1)
        self._last = None

    def start(self, generator, tries=50):
        """Random coefficients, as large as the limits allow; None if not even the mean pose is allowed."""
        for _ in range(tries):
            q0 = self.low + (self.high - self.low) * generator.uniform(0.3, 0.7, 3)
            a, b = at_rest(*generator.normal(size=(2, 3, len(self.Za))) / np.arange(1, len(self.Za) + 1))
            free = np.hstack([a @ self.Za, b @ self.Zb])
            if (self.both(np.r_[q0, 0 * free.ravel()])[1:] < 0).any():
                continue
            for joint in range(3):
                free[joint] *= self._largest(q0, free, joint)
            if np.abs(free).max(axis=1).min() > 1e-3:
                return np.r_[q0, free.ravel()]
        return None

    def _largest(self, q0, free, joint):
        """Factor for the coefficients of one joint at which a bound is met; joints that follow stand still."""
        moving = np.where(np.arange(3)[:, None] <= joint, free, 0.0)
        inside, outside = 0.0, 4.0
        for _ in range(30):
            moving[joint] = 0.5 * (inside + outside) * free[joint]
            fits = (self.both(np.r_[q0, moving.ravel()])[1:] >= 0).all()
            inside, outside = (0.5 * (inside + outside), outside) if fits else (inside, 0.5 * (inside + outside))
        return inside

    def evaluate(self, x):
        """For m points x (m, size): mean log condition with the price of standing, then the room left at each bound.

        Returns (m, 12): room (>= 0 inside) per joint above, below and in speed; then of elbow and tip over the table.
        """
        motions = [series(*self.split(one), self.period, self.t) for one in x]
        q, qd, qdd = np.moveaxis(motions, 2, 0)
        Phi = regressor(*(rows.reshape(-1, 3) for rows in (q, qd, qdd)), sign=_TURN)
        still = np.mean(1 / (1 + (qd / _SLOW) ** 2), axis=(1, 2))
        conditions = _conditions(Phi.reshape(*q.shape[:2], 3, 20))
        cost = np.log(np.minimum(conditions, _WORST)).mean(axis=1) + self.standing * still
        low, high = q.min(axis=1), q.max(axis=1)
        more = _HIDDEN / 2 * (high - low)
        fast = np.abs(qd).max(axis=1) * (1 + _HIDDEN)
        joints = np.stack([self.high - high - more, low - more - self.low, self.speed - fast], axis=2)
        over = [height.reshape(len(x), -1).min(axis=1) for height in heights(self.l, q.reshape(-1, 3))]
        table = -np.inf if self.table is None else self.table + _HIDDEN * (self.l[1] + self.l[2])
        over = np.minimum(np.column_stack(over) - table, 1e3)
        return np.column_stack([cost, joints.reshape(len(x), 9), over])

    def both(self, x):
        """`evaluate` of one point x (size,): (12,)."""
        return self.evaluate(x[None])[0]

    def slopes(self, x):
        """Derivatives of `both` by differences: (12, size)."""
        if self._last is None or not np.array_equal(self._last[0], x):
            here, ahead = self.both(x), self.evaluate(x + _STEP * np.eye(self.size))
            self._last = x.copy(), np.column_stack(ahead - here) / _STEP  # rows in one piece: SLSQP reads no others
        return self._last[1]

    def value(self, x):
        return float(self.both(x)[0])

    def improve(self, x, iterations, step):
        """SLSQP from x: (value, point) of the best point inside the bounds that was visited."""
        from scipy.optimize import minimize

        best = [self.value(x), x]

        def seen(x):
            step(1)
            for share in (1.0, 0.999, 0.99, 0.97, 0.94):  # a little less of a motion that is just outside
                less = np.r_[x[:3], share * x[3:]]
                value, *room = self.both(less)
                if min(room) >= 0:
                    best[:] = min(best, [value, less], key=lambda pair: pair[0])
                    return

        room = {"type": "ineq", "fun": lambda x: self.both(x)[1:] - 1e-6, "jac": lambda x: self.slopes(x)[1:]}
        options = {"maxiter": iterations, "ftol": 1e-5}
        slope = {"jac": lambda x: self.slopes(x)[0]}
        minimize(self.value, x, **slope, constraints=[room], method="SLSQP", callback=seen, options=options)
        return best

    def split(self, x):
        """(a, b, q0) of the point x."""
        a, b = np.split(x[3:].reshape(3, -1), 2, axis=1)
        return a @ self.Za.T, b @ self.Zb.T, x[:3]


def _null_space(weight):
    """Orthonormal columns (N, N - 1) whose sums with `weight` are 0."""
    return np.linalg.qr(np.column_stack([weight, np.eye(len(weight))[:, 1:]]))[0][:, 1:]
