"""Motions from which the parameters can be told apart: Fourier series with the condition number made small."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.excitation_kernel import BOUNDS, evaluate, slopes
from ir50p_lab.identification.parameters import ACTS_ON, chosen_columns
from ir50p_lab.inputs import check_arm, choice, number, switch, whole
from ir50p_lab.signals.fourier import Fourier, at_rest, fourier, limits_of

_PER_HARMONIC = 32  # points of the grid per period of the fastest harmonic
_HIDDEN = 1 / math.cos(math.pi / _PER_HARMONIC) - 1  # of half the range: what may hide between the points


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """What `optimise_excitation` found.

    reference: Fourier, ready for a bench (`q_start` first); before: the plain motion to compare with, random
    coefficients as large as the limits allow. condition_before, condition_after: (3,), one per joint (rows="shared":
    one number), of the columns scaled to length 1. starts: what each start ended with, geometric mean of
    the condition numbers times the price of standing.
    """

    reference: Fourier
    before: Fourier
    condition_before: np.ndarray
    condition_after: np.ndarray
    starts: tuple

    def __str__(self):
        pairs = zip(np.atleast_1d(self.condition_before), np.atleast_1d(self.condition_after), strict=True)
        return "condition number " + ", ".join(f"{a:.3g} -> {b:.3g}" for a, b in pairs)


def regressor_condition(reference, *, rows="joint", columns="rigid", samples=500):
    """Condition number of the regressor along one period of a motion, its columns scaled to length 1.

    1 is best: every parameter is seen apart from the others. 100: of some combination the data say 100 times less.

    Args: reference: Fourier, or any Reference with a finite duration > 0; rows, columns: as in `fit`; samples: points.
    Returns: (3,), one per joint, or with rows="shared" one number. Raises InputError.
    """
    choice("rows", rows, ("joint", "shared"))
    whole("samples", samples, 20, 10**6)
    length = getattr(reference, "period", None) or getattr(reference, "duration", 0.0)
    if not (math.isfinite(length) and length > 0):
        raise InputError(f"the reference lasts {length} s: give a motion of finite length > 0, such as `fourier`")
    start = getattr(reference, "start", 0.0)
    motion = reference.sample(start + length * (np.arange(samples) + 0.5) / samples)
    Phi = regressor(motion[:, 0], motion[:, 1], motion[:, 2])
    picked = _columns(columns)
    if rows == "shared":
        return _condition(Phi[:, :, picked.any(axis=0)].reshape(3 * samples, -1))
    return np.array([_condition(Phi[:, i, picked[i]]) for i in range(3)])


def optimise_excitation(
    arm,
    *,
    period=10.0,
    harmonics=5,
    periods=11,
    max_joint_speed=None,
    table=0.0,
    margin=0.05,
    rows="joint",
    columns="rigid",
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
        max_joint_speed, table, margin: as in `fourier`. rows, columns: as in `fit`: what is to be estimated.
        standing: price of time spent near standstill, where a joint may stick and no theta says what u does: with 4, a
            share of 10 % (of 1/(1 + (qd/0.1 rad/s)^2)) counts as much as a condition number half as large again. On
            the simulated bench 4 raised, with 3 harmonics, the fit that any theta reaches from 89/61/96 to 94/91/96 %;
            with 5, on 20 pairs of motions, 30 in place of 8 raised joint 2 from 91.9 to 92.5 %.
        starts, iterations: more take longer (default: some ten seconds) and find a little better.
        seed: the same seed gives the same motion. progress: show a bar.

    Returns: Excitation. Raises: InputError on bad arguments; IdentificationError if no motion fits the limits.
    """
    _check(arm, harmonics, starts, iterations, seed)
    choice("rows", rows, ("joint", "shared"))
    standing = number("standing", standing, ">= 0", hint="the price of time near standstill")
    table, margin = number("table", table, unit="m"), number("margin", margin, ">= 0", unit="rad")
    whole("periods", periods, 1, 10**6)
    switch("progress", progress)
    period = number("period", period, "> 0", unit="s")
    picked = _columns(columns)
    limits = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    problem = _Problem(arm, period, harmonics, limits, rows, picked, float(standing))
    generator = np.random.default_rng(seed)
    best, plain, ends = None, None, []
    from tqdm.auto import tqdm

    with tqdm(total=starts * iterations, disable=not progress, unit="step", desc="excitation") as bar:
        for start in range(starts):
            x = problem.start(generator)
            if x is None:
                continue
            plain = x if plain is None else plain
            found = problem.improve(x, iterations, bar.update)
            bar.update((start + 1) * iterations - bar.n)
            ends.append(math.exp(problem.value(found)))
            bar.set_postfix_str(f"condition {min(ends):.3g}")
            if best is None or problem.value(found) < problem.value(best):
                best = found
    if best is None:
        raise IdentificationError(
            f"no motion was found inside the limits in {starts} starts: widen the joint limits, lower the table "
            f"({table}), take less margin ({margin} rad), or give another seed"
        )
    options = {"period": period, "periods": periods, "arm": arm, "max_joint_speed": max_joint_speed}
    options |= {"table": table, "margin": margin, "ends": "adjust"}  # rounding only
    reference, before = (fourier(a, b, q0=q0, **options) for a, b, q0 in map(problem.split, (best, plain)))
    return Excitation(
        reference=reference,
        before=before,
        condition_before=regressor_condition(before, rows=rows, columns=columns),
        condition_after=regressor_condition(reference, rows=rows, columns=columns),
        starts=tuple(ends),
    )


class _Problem:
    """The optimisation in coordinates that end at rest: x = (q0, then the free coefficients of a and b per joint)."""

    def __init__(self, arm, period, harmonics, limits, rows, picked, standing=0.0):
        low, high, speed, table = limits
        self.low, self.high, self.N = low, high, harmonics
        k = np.arange(1.0, harmonics + 1)
        self.Za, self.Zb = _null_space(k), _null_space(k**2)  # (N, N - 1)
        n = _PER_HARMONIC * harmonics
        w = 2 * np.pi / period * k  # rad/s
        angle = (np.arange(n) + 0.5)[:, None] / n * 2 * np.pi * k
        s, c = np.sin(angle), np.cos(angle)
        # free coefficients -> q, qd, qdd: (3, n, 2 (N - 1))
        sine, cosine = self.Za, -self.Zb
        self.basis = np.ascontiguousarray(
            [
                np.hstack([s @ sine, c @ cosine]),
                np.hstack([(c * w) @ sine, (-s * w) @ cosine]),
                np.hstack([(-s * w**2) @ sine, (-c * w**2) @ cosine]),
            ]
        )
        self.picked = picked.astype(np.int64)
        self.shared = rows == "shared"
        bounds = np.r_[low, high, speed, -np.inf if table is None else table, arm.l, _HIDDEN, standing]
        self.fixed = (self.basis, self.picked, self.shared, bounds)
        self.size = 3 + 6 * (harmonics - 1)
        self._last = None

    def start(self, generator, tries=50):
        """Random coefficients, as large as the limits allow; None if not even the mean pose is allowed."""
        for _ in range(tries):
            q0 = self.low + (self.high - self.low) * generator.uniform(0.3, 0.7, 3)
            a, b = at_rest(*generator.normal(size=(2, 3, self.N)) / np.arange(1, self.N + 1))
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

    def both(self, x):
        """Mean log condition, then the room left at each bound (>= 0 inside)."""
        out = np.empty(1 + BOUNDS)
        evaluate(x, *self.fixed, out)
        return out

    def value(self, x):
        return float(self.both(x)[0])

    def improve(self, x, iterations, step):
        """SLSQP from x; the best point inside the bounds that was visited."""
        from scipy.optimize import minimize

        best = [self.value(x), x]

        def jacobian(x):
            if self._last is None or not np.array_equal(self._last[0], x):
                out = np.empty((1 + BOUNDS, self.size))
                slopes(x, *self.fixed, out)
                self._last = (x.copy(), out)
            return self._last[1]

        def seen(x):
            step(1)
            x = self._inside(x)
            if x is not None and self.value(x) < best[0]:
                best[:] = [self.value(x), x]

        room = {"type": "ineq", "fun": lambda x: self.both(x)[1:] - 1e-6, "jac": lambda x: jacobian(x)[1:]}
        minimize(
            self.value,
            x,
            jac=lambda x: jacobian(x)[0],
            constraints=[room],
            method="SLSQP",
            callback=seen,
            options={"maxiter": iterations, "ftol": 1e-5},
        )
        return best[1]

    def _inside(self, x):
        """x, or a little less of its motion where it is just outside the bounds; None if it is far outside."""
        for share in (1.0, 0.999, 0.99, 0.97, 0.94):
            less = np.r_[x[:3], share * x[3:]]
            if (self.both(less)[1:] >= 0).all():
                return less
        return None

    def split(self, x):
        """(a, b, q0) of the point x."""
        free = x[3:].reshape(3, -1)
        return free[:, : self.N - 1] @ self.Za.T, free[:, self.N - 1 :] @ self.Zb.T, x[:3]


def _null_space(weight):
    """Orthonormal columns (N, N - 1) whose sums with `weight` are 0."""
    return np.linalg.qr(np.column_stack([weight, np.eye(len(weight))[:, 1:]]))[0][:, 1:]


def _columns(columns):
    """(3, 20) bool: the columns asked for that act on each joint."""
    chosen = chosen_columns(columns)
    picked = np.zeros((3, 20), dtype=bool)
    for joint, acting in enumerate(ACTS_ON):
        picked[joint, [k for k in acting if k in chosen]] = True
    if not picked.any(axis=1).all():
        raise InputError("columns holds none that acts on one of the joints; name at least one for each")
    return picked


def _condition(A):
    size = np.linalg.norm(A, axis=0)
    return float("inf") if (size == 0).any() else float(np.linalg.cond(A / size))


def _check(arm, harmonics, starts, iterations, seed):
    check_arm(arm)
    if not np.isfinite([*arm.q_min, *arm.q_max]).all():
        raise InputError(f"{arm.name} has no joint limits: give q_min and q_max, dataclasses.replace(arm, q_min=...)")
    for name, value, least, most in (
        ("harmonics", harmonics, 2, 12),
        ("starts", starts, 1, 10**4),
        ("iterations", iterations, 1, 10**5),
        ("seed", seed, 0, 2**63),
    ):
        whole(name, value, least, most)
