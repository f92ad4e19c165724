"""`fit`: the 20 parameters from a regressor and measured torque or PWM, by one of six estimators."""

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import estimators
from ir50p_lab.identification.estimate import Estimate, impossible_values, indefinite_mass
from ir50p_lab.identification.fit_input import blocks, checked_data
from ir50p_lab.identification.parameters import ACTS_ON, NAMES, chosen_columns
from ir50p_lab.identification.problem import prepare
from ir50p_lab.identification.qr import product
from ir50p_lab.identification.regression import lag_one, parameters_of
from ir50p_lab.inputs import choice, number, vectors3

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
    instruments=None,
    unit="PWM",
):
    """Parameters theta of y = Phi theta    (2.35), with standard errors and what the data cannot say.

    ========== =====================================================================================================
    method     minimises, or solves
    ========== =====================================================================================================
    "ls"       sum of squares, by QR
    "weighted" sum of weighted squares: weights (n, 3) or (3,), 1/variance, as 1/sigma^2 of a first fit
    "huber"    squares up to `threshold` standard deviations, absolute value beyond: outliers pull little
    "ridge"    squares plus strength |theta|^2, on columns scaled to length 1: calmer and biased
    "bounded"  squares with inertial and friction terms >= 0 and offsets free
    "iv"       instruments^T (y - Phi theta) = 0: no bias from noise in Phi; instruments (n, 3, 20), for example the
               regressor of the reference, of a simulation, or of a repeated run
    ========== =====================================================================================================

    Args:
        Phi: (n, 3, 20) as `regressor` returns; y: (n, 3), in `unit`.
        rows: "joint": each joint its own parameters, right for motors of unequal gain. "shared": one theta for all,
            as the thesis: right for torque, or for equal motors (2.47 corrected).
        columns: "rigid" (all but theta7 and theta8, which no rigid body has), "thesis" (all 20), or names.
        l2: length of the upper arm, m: ties theta6 = l2 theta4, as for every in-line arm.
        use: (n, 3) bool: samples of a joint that count, as `Motion.use`; default all.

    Returns: Estimate. Columns that depend on others within the data are left out: 0 with stderr inf, and named. Its
    standard errors hold for residuals that are correlated in time, too (after a filter they are). They assume that Phi
    is free of noise; noise in it biases all methods but "iv".
    Raises: InputError on bad arguments; IdentificationError if there are too few samples, no motion, or an estimator
        cannot settle.
    """
    choice("unit", unit, ("PWM", "N m"))
    choice("method", method, METHODS)
    choice("rows", rows, ("joint", "shared"))
    number("threshold", threshold, "> 0")
    number("strength", strength, "> 0")
    if l2 is not None and number("l2", l2, "> 0", unit="m") > 10:
        raise InputError(f"l2 = {l2} m is longer than 10 m: is it in millimetres? Give metres")
    Phi, y = checked_data(Phi, y)
    used = np.ones(y.shape) if use is None else _checked_use(use, y)
    root_weights = used * np.sqrt(_checked_weights(weights, y)) if method == "weighted" else used
    all_alike = (root_weights == 1).all()
    Z = _checked_instruments(instruments, Phi) if method == "iv" else None
    chosen = chosen_columns(columns)
    theta, stderr, covariance = np.zeros((3, 20)), np.full((3, 20), np.nan), np.zeros((3, 20, 20))
    condition, freedom, lost, notes = np.zeros(3), np.zeros(3), [], []
    for joints in [[0, 1, 2]] if rows == "shared" else [[0], [1], [2]]:
        who = "" if rows == "shared" else f"joint {joints[0] + 1}: "
        here, ties, fitted = _acting(joints, chosen, l2)
        # rows of zeros say nothing, and leave the others at their place in time
        A = _columns(Phi, joints, here, ties, None if all_alike else root_weights)
        problem = prepare(who, fitted, A, (y * root_weights)[:, joints].ravel(), len(y))
        back = ties[:, [fitted.index(name) for name in problem.names]]
        if method == "huber":
            solution = estimators.huber(problem, threshold)
        elif method == "ridge":
            solution = estimators.ridge(problem, strength)
        elif method == "bounded":
            solution = estimators.bounded(problem)
        elif method == "iv":
            solution = estimators.instrumental_variables(problem, _columns(Z, joints, here, back))
        else:
            solution = estimators.plain(problem)
        x, spread = parameters_of(problem, solution)
        spread = back @ spread @ back.T
        found = back.any(axis=1)
        count = used[:, joints].sum()
        for j in joints:
            theta[j, here] = back @ x
            stderr[j, here] = np.where(found, np.sqrt(np.maximum(np.diag(spread), 0.0)), np.inf)
            covariance[j][np.ix_(here, here)] = spread
            condition[j] = problem.condition
            freedom[j] = count / max(count - len(x), 1.0)
        lost += [who + NAMES[k] for k, known in zip(here, found, strict=True) if not known]
        notes += [*problem.notes, *problem.hardly_told_apart(), *solution.notes]
    residuals = y - np.einsum("nij,ij->ni", Phi, theta)
    return Estimate(
        theta=theta,
        stderr=stderr,
        covariance=covariance,
        condition=condition,
        residuals=residuals,
        sigma=np.sqrt(np.sum(used * residuals**2, axis=0) / used.sum(axis=0) * freedom),
        correlation=lag_one(residuals * used),
        columns=tuple(tuple(NAMES[k] for k in np.flatnonzero(np.isfinite(row))) for row in stderr),
        unidentifiable=tuple(lost),
        warnings=(*notes, *impossible_values(theta, stderr, rows), *indefinite_mass(theta)),
        unit=unit,
        method=method,
        rows=rows,
    )


def _acting(joints, chosen, l2):
    """Columns that act on some joints; theta[columns] = ties beta, where l2 makes beta shorter; names of beta."""
    here = [k for k in chosen if any(k in ACTS_ON[j] for j in joints)]
    if not here:
        raise InputError(f"no column chosen acts on joint {joints[0] + 1}: add one, or fit rows='shared'")
    ties, kept = np.eye(len(here)), list(range(len(here)))
    if l2 is not None and _THETA4 in here and _THETA6 in here:
        ties[here.index(_THETA6), here.index(_THETA4)] = l2
        kept.remove(here.index(_THETA6))
    return here, ties[:, kept], [NAMES[here[k]] for k in kept]


def _columns(Phi, joints, here, ties, weights=None):
    """Phi (n, 3, 20) of some joints as rows, sample by sample, in the parameters behind the ties: (n k, p)."""
    A = Phi[:, joints[0] : joints[-1] + 1, here]
    if weights is not None:
        A *= weights[:, joints, None]
    A = A.reshape(-1, len(here))
    return A if np.array_equal(ties, np.eye(len(here))) else product(A, ties)


def _checked_weights(weights, y):
    if weights is None:
        raise InputError("method='weighted' needs weights, (3,) or (n, 3): 1/variance of each measurement")
    weights = vectors3("weights", weights, unit="1/unit^2")
    if weights.shape not in ((3,), y.shape) or (weights < 0).any():
        raise InputError(
            f"weights have shape {weights.shape} and least value {weights.min():g}; "
            "give (3,) or (n, 3), all >= 0: 1/variance of each measurement"
        )
    return weights


def _checked_use(use, y):
    use = np.asarray(use)
    if use.dtype != bool or use.shape != y.shape:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    if use.sum(axis=0).min() < 40:
        raise IdentificationError(
            f"only {use.sum(axis=0).tolist()} samples of the joints are to be used; give 40 or more of each: record "
            "longer or faster motion, or leave out fewer near standstill"
        )
    return use.astype(float)


def _checked_instruments(instruments, Phi):
    if instruments is None:
        raise InputError(
            "method='iv' needs instruments (n, 3, 20): the regressor of a signal that moves as the arm does but has "
            "other noise: the reference, a simulation, a repeated run"
        )
    Z = blocks("instruments", instruments)
    if Z.shape != Phi.shape:
        raise InputError(f"instruments have {len(Z)} samples, Phi has {len(Phi)}: one for each")
    return Z
