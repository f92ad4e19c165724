"""`fit`: the 20 parameters from a regressor and measured torque or PWM, by one of six estimators."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification import estimators
from ir50p_lab.identification.estimate import Estimate, impossible_values, indefinite_mass
from ir50p_lab.identification.fit_input import checked_data, checked_instruments, checked_use, checked_weights
from ir50p_lab.identification.parameters import ACTS_ON, NAMES, chosen_columns
from ir50p_lab.identification.problem import prepare
from ir50p_lab.identification.regression import lag_one, sandwich
from ir50p_lab.inputs import choice, number

METHODS = ("ls", "weighted", "huber", "ridge", "bounded", "iv")
_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")


def fit(
    Phi,
    y,
    *,
    method="ls",
    rows="joint",
    columns="rigid",
    l2=None,
    weights=None,
    use=None,
    threshold=1.345,
    strength=1e-3,
    bounds=None,
    instruments=None,
    errors="hac",
    every=1,
    unit="PWM",
):
    """Parameters theta of y = Phi theta    (2.35), with standard errors and what the data cannot say.

    ========== =====================================================================================================
    method     minimises, or solves
    ========== =====================================================================================================
    "ls"       sum of squares, by QR
    "weighted" sum of weighted squares: weights (n, 3) or (3,), 1/variance; with rows="shared" and none given, one
               weight per joint from the residuals of a first fit
    "huber"    squares up to `threshold` standard deviations, absolute value beyond: outliers pull little
    "ridge"    squares plus strength |theta|^2, on columns scaled to length 1: calmer and biased
    "bounded"  squares with inertial and friction terms >= 0 and offsets free; bounds={"theta3": (low, high)} changes it
    "iv"       instruments^T (y - Phi theta) = 0: no bias from noise in Phi; instruments (n, 3, 20), for example the
               regressor of the reference, of a simulation, or of a repeated run
    ========== =====================================================================================================

    Args:
        Phi: (n, 3, 20) as `regressor` returns; y: (n, 3), in `unit`.
        rows: "joint": each joint its own parameters, right for motors of unequal gain. "shared": one theta for all,
            as the thesis: right for torque, or for equal motors (2.47 corrected).
        columns: "rigid" (all but theta7 and theta8, which no rigid body has), "thesis" (all 20), or names or indices.
        l2: length of the upper arm, m: ties theta6 = l2 theta4, as for every in-line arm.
        errors: standard errors: "hac" also for residuals that are correlated in time (after a filter they are), or
            "classical" for white ones. Both assume that Phi is free of noise; noise in it biases all methods but "iv".
        use: (n, 3) bool: samples of a joint that count, as `Motion.use`; default all.
        every: fit each `every`-th sample only (decimation).

    Returns: Estimate. Columns that depend on others within the data are left out: 0 with stderr inf, and named.
    Raises: InputError on bad arguments; IdentificationError if there are too few samples, no motion, or an estimator
        cannot settle.
    """
    for name, value, choices in (
        ("unit", unit, ("PWM", "N m")),
        ("method", method, METHODS),
        ("rows", rows, ("joint", "shared")),
        ("errors", errors, ("hac", "classical")),
    ):
        choice(name, value, choices)
    number("threshold", threshold, "> 0")
    number("strength", strength, "> 0")
    if l2 is not None and number("l2", l2, "> 0", unit="m") > 10:
        raise InputError(f"l2 = {l2} m is longer than 10 m: is it in millimetres? Give metres")
    Phi, y = checked_data(Phi, y, every)
    use = None if use is None else checked_use(use, len(y), every)
    chosen = chosen_columns(columns)
    limits = estimators.checked_bounds(bounds) if method == "bounded" else None
    Z = checked_instruments(instruments, Phi.shape, every) if method == "iv" else None
    if method == "weighted":
        weights = _weights(weights, Phi, y, use, rows, chosen, l2, every)
    solver = {
        "ls": lambda part, problem: estimators.plain(problem),
        "weighted": lambda part, problem: estimators.plain(problem),
        "huber": lambda part, problem: estimators.huber(problem, threshold),
        "ridge": lambda part, problem: estimators.ridge(problem, strength),
        "bounded": lambda part, problem: estimators.bounded(problem, limits),
        "iv": lambda part, problem: estimators.instrumental_variables(problem, part.columns_of(Z, problem.names)),
    }[method]
    parts = [_Part.of(joints, chosen, l2) for joints in ([[0, 1, 2]] if rows == "shared" else [[0], [1], [2]])]
    root_weights = np.sqrt(weights) if method == "weighted" else None
    if use is not None:  # rows of zeros say nothing, and leave the others at their place in time
        root_weights = use.astype(float) if root_weights is None else root_weights * use
    solved = [_solve(part, Phi, y, root_weights, solver, errors) for part in parts]
    return _gather(parts, solved, Phi, y, use, method, rows, errors, unit)


@dataclass(frozen=True, eq=False)
class _Part:
    """The columns `here` of some joints, and theta[here] = matrix beta: ties make beta shorter."""

    joints: list
    here: list
    fitted: tuple
    matrix: np.ndarray

    @classmethod
    def of(cls, joints, chosen, l2):
        here = sorted(set(chosen) & {k for j in joints for k in ACTS_ON[j]})
        if not here:
            raise InputError(f"no column chosen acts on joint {joints[0] + 1}: add one, or fit rows='shared'")
        matrix, kept = np.eye(len(here)), list(range(len(here)))
        if l2 is not None and _THETA4 in here and _THETA6 in here:
            matrix[here.index(_THETA6), here.index(_THETA4)] = l2
            kept.remove(here.index(_THETA6))
        return cls(joints, here, tuple(NAMES[here[k]] for k in kept), matrix[:, kept])

    @property
    def who(self):
        return "" if len(self.joints) == 3 else f"joint {self.joints[0] + 1}: "

    def columns_of(self, Phi, names=None):
        """Rows of Phi for these joints, sample by sample, (N, p): the columns `names` (default all) after the ties."""
        A = (
            Phi[:, :, self.here].reshape(-1, len(self.here))
            if len(self.joints) == 3
            else Phi[:, self.joints[0], self.here]
        )
        if len(self.fitted) < len(self.here):
            A = A @ self.matrix
        return A if names is None else A[:, [self.fitted.index(name) for name in names]]


def _solve(part, Phi, y, root_weights, estimator, errors):
    """(problem, theta of part.here, its covariance, sentences)."""
    A, target = part.columns_of(Phi), y[:, part.joints].ravel()
    if root_weights is not None:
        w = root_weights[:, part.joints].ravel()
        A, target = A * w[:, None], target * w
    problem = prepare(part.who, part.fitted, A, target, len(y))
    solution = estimator(part, problem)
    in_q = sandwich(solution.bread, solution.rows, solution.residuals, len(y), errors)
    back = part.matrix[:, [part.fitted.index(name) for name in problem.names]] / problem.scale
    whole = back @ problem.R_inverse
    covariance = whole @ in_q @ whole.T
    notes = [*problem.notes, *problem.hardly_told_apart(), *solution.notes]
    return problem, back, back @ solution.beta, covariance, notes


def _gather(parts, solved, Phi, y, use, method, rows, errors, unit):
    """One Estimate from the solutions of all parts."""
    theta, stderr, covariance = np.zeros((3, 20)), np.full((3, 20), np.nan), np.zeros((3, 20, 20))
    condition, freedom, names, lost, notes = np.zeros(3), np.zeros(3), [(), (), ()], [], []
    used = np.ones(y.shape) if use is None else use.astype(float)
    for part, (problem, back, values, spread, sentences) in zip(parts, solved, strict=True):
        found = back.any(axis=1)
        for j in part.joints:
            theta[j, part.here] = values
            stderr[j, part.here] = np.where(found, np.sqrt(np.maximum(np.diag(spread), 0.0)), np.inf)
            covariance[j][np.ix_(part.here, part.here)] = spread
            condition[j] = problem.condition
            count = used[:, part.joints].sum()
            freedom[j] = count / max(count - len(problem.names), 1.0)
            names[j] = tuple(NAMES[k] for k, here in zip(part.here, found, strict=True) if here)
        lost += [part.who + NAMES[k] for k, here in zip(part.here, found, strict=True) if not here]
        notes += sentences
    residuals = y - np.einsum("nij,ij->ni", Phi, theta)
    correlation = lag_one(residuals * used)
    notes += impossible_values(theta, stderr, rows) + indefinite_mass(theta)
    strongest = np.abs(correlation).max()
    if errors == "classical" and strongest > max(0.1, 4 / np.sqrt(len(y))):
        notes.append(
            f"neighbouring residuals are correlated (up to {strongest:.2f}): classical standard errors are wrong then. "
            "Use errors='hac', or decimate with every="
        )
    return Estimate(
        theta=theta,
        stderr=stderr,
        covariance=covariance,
        condition=condition,
        residuals=residuals,
        sigma=np.sqrt(np.sum(used * residuals**2, axis=0) / used.sum(axis=0) * freedom),
        correlation=correlation,
        columns=tuple(names),
        unidentifiable=tuple(lost),
        warnings=tuple(notes),
        unit=unit,
        method=method,
        rows=rows,
    )


def _weights(weights, Phi, y, use, rows, chosen, l2, every):
    """Given weights, or one per joint from a first fit of one theta for all."""
    if weights is not None:
        return checked_weights(weights, len(y), every)
    if rows == "joint":
        raise InputError("method='weighted' with rows='joint' needs weights (n, 3): 1/variance of each measurement")
    first = fit(Phi, y, rows="shared", columns=[NAMES[k] for k in chosen], l2=l2, use=use)
    floor = 1e-9 * np.sqrt(np.mean(y**2)) or 1.0
    return np.broadcast_to(1 / np.maximum(first.sigma, floor) ** 2, y.shape)
