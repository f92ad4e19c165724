"""`fit`: the 20 parameters from a regressor and measured torque or PWM, by one of six estimators."""

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import estimators
from ir50p_lab.identification.estimate import Estimate, impossible_values, indefinite_mass
from ir50p_lab.identification.fit_input import checked_data
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, NAMES, metres
from ir50p_lab.identification.regression import Problem
from ir50p_lab.inputs import choice, number, vectors3

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
    strength=1e-3,
    instruments=None,
    unit="PWM",
):
    """Parameters theta of y = Phi theta    (2.35), their standard errors, and which of them the data do not determine.

    ========== =====================================================================================================
    method     minimises, or solves
    ========== =====================================================================================================
    "ls"       sum of squares, by QR
    "weighted" sum of weighted squares: weights (n, 3) or (3,), 1/variance, as 1/sigma^2 of a first fit
    "huber"    squares up to 1.345 standard deviations, absolute value beyond: outliers pull little
    "ridge"    squares plus strength |theta|^2, on columns scaled to length 1: less scatter, but biased towards 0
    "bounded"  squares with inertial and friction terms >= 0 and offsets free
    "iv"       instruments^T (y - Phi theta) = 0: no bias from noise in Phi; instruments (n, 3, 20), for example the
               regressor of the reference, of a simulation, or of a repeated run
    ========== =====================================================================================================

    Args:
        Phi: (n, 3, 20) as `regressor` returns; y: (n, 3), in `unit`.
        rows: "joint": each joint its own parameters, right for motors of unequal gain. "shared": one theta for all,
            as the thesis: right for torque, or for equal motors (2.47 corrected).
        columns: "rigid" (all but theta7 and theta8, which no rigid body has), "thesis" (all 20).
        l2: length of the upper arm, m: ties theta6 = l2 theta4, as for every in-line arm.
        use: (n, 3) bool: samples of a joint that count, as `Motion.use`; default all. unit: "PWM" or "N m".

    Returns: Estimate. A column that is a combination of others in these data is left out, and named: its parameter is
    0 with stderr inf. What "bounded" leaves at a bound is named, its stderr is inf. Standard errors also hold for
    residuals that are correlated in time, as they are after a filter. They assume that Phi is free of noise; noise in
    it biases all methods but "iv".
    Raises: InputError on bad arguments; IdentificationError if there are too few samples, no motion, or an estimator
        cannot settle.
    """
    choice("unit", unit, ("PWM", "N m"))
    choice("method", method, ("ls", "weighted", "huber", "ridge", "bounded", "iv"))
    choice("rows", rows, ("joint", "shared"))
    choice("columns", columns, tuple(COLUMNS))
    number("strength", strength, "> 0")
    if l2 is not None:
        metres("l2", l2)
    Phi, y = checked_data(Phi, y)
    used = np.ones(y.shape) if use is None else _checked_use(use, y)
    share = used * np.sqrt(_checked_weights(weights, y)) if method == "weighted" else used
    Z = checked_data(instruments, y, "instruments")[0] if method == "iv" else None
    theta, stderr, covariance = np.zeros((3, 20)), np.full((3, 20), np.nan), np.zeros((3, 20, 20))
    condition, freedom, lost, notes = np.zeros(3), np.zeros(3), [], []
    fitted = np.zeros((3, 20), dtype=bool)
    for joints in [slice(0, 3)] if rows == "shared" else [slice(j, j + 1) for j in range(3)]:
        who = "" if rows == "shared" else f"joint {joints.stop}: "
        here, ties, names = _acting(joints, COLUMNS[columns], l2)
        A = _equations(Phi, share, joints, here) @ ties
        problem = Problem(A, (y * share)[:, joints].ravel(), names, len(y), who=who)
        ties = ties[:, problem.kept]
        if method == "iv":
            x, spread = estimators.instrumental_variables(problem, _equations(Z, share, joints, here) @ ties)
        elif method == "ridge":
            x, spread = estimators.ridge(problem, strength)
        elif method in ("huber", "bounded"):
            x, spread = getattr(estimators, method)(problem)
        else:
            x, spread = problem.estimate(problem.Qty)
        found = ties.any(axis=1)
        spread = ties @ spread @ ties.T
        count = used[:, joints].sum()
        theta[joints, here] = ties @ x
        known = found & ~ties[:, problem.at_bound].any(axis=1)
        fitted[joints, here] = found
        stderr[joints, here] = np.where(known, np.sqrt(np.maximum(np.diag(spread), 0.0)), np.inf)
        covariance[joints, np.array(here)[:, None], here] = spread
        condition[joints] = problem.condition
        freedom[joints] = count / max(count - len(x), 1.0)
        lost += [who + NAMES[k] for k in np.array(here)[~found]]
        notes += problem.notes
    residuals = y - np.einsum("nij,ij->ni", Phi, theta)
    return Estimate(
        theta=theta,
        stderr=stderr,
        covariance=covariance,
        condition=condition,
        residuals=residuals,
        sigma=np.sqrt(np.sum(used * residuals**2, axis=0) / used.sum(axis=0) * freedom),
        columns=tuple(tuple(NAMES[k] for k in np.flatnonzero(row)) for row in fitted),
        unidentifiable=tuple(lost),
        warnings=(*notes, *impossible_values(theta, stderr, rows), *indefinite_mass(theta)),
        unit=unit,
        method=method,
        rows=rows,
    )


def _acting(joints, chosen, l2):
    """(columns that act on some joints, ties, names of beta): theta[columns] = ties beta; l2 takes theta6 out."""
    here = [k for k in chosen if any(k in acting for acting in ACTS_ON[joints])]
    ties, kept = np.eye(len(here)), list(range(len(here)))
    if l2 is not None and _THETA4 in here:
        ties[here.index(_THETA6), here.index(_THETA4)] = l2
        kept.remove(here.index(_THETA6))
    return here, ties[:, kept], [NAMES[here[k]] for k in kept]


def _equations(Phi, share, joints, here):
    """The columns `here` of Phi (n, 3, 20) for k joints, sample by sample, times `share` (n, 3): (n k, p).

    Samples that are not used become rows of zeros: these tell nothing, and the others keep their place in time.
    """
    return (Phi[:, joints, here] * share[:, joints, None]).reshape(-1, len(here))


def _checked_weights(weights, y):
    weights = vectors3("weights", weights, unit="1/variance of each measurement")
    if weights.shape not in ((3,), y.shape) or (weights < 0).any():
        raise InputError(f"weights {weights.shape}, least {weights.min():g}: give 1/variance, (3,) or (n, 3), all >= 0")
    return weights


def _checked_use(use, y):
    use = np.asarray(use)
    if use.dtype != bool or use.shape != y.shape:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    if use.sum(axis=0).min() < 40:
        raise IdentificationError(f"only {use.sum(axis=0)} samples to be used, 40 are needed: record more motion")
    return use.astype(float)
