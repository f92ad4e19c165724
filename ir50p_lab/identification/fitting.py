"""`fit`: the 20 parameters from a regressor and measured torque or PWM, with or without physical bounds."""

import numpy as np
from scipy.optimize import lsq_linear

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.estimate import Estimate, impossible_values, indefinite_mass
from ir50p_lab.identification.fit_input import checked_data
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, FREE_OF_SIGN, NAMES, metres
from ir50p_lab.identification.regression import Problem
from ir50p_lab.inputs import choice

_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")


def fit(Phi, y, *, method="ls", rows="joint", columns="rigid", l2=None, use=None, unit="PWM"):
    """Parameters theta of y = Phi theta    (2.35), with standard errors and what the data cannot say.

    Args:
        Phi: (n, 3, 20) as of `regressor`; y: (n, 3) torque or command, time first.
        method: "ls", or "bounded": inertial and friction terms >= 0 (a convex problem).
        rows: "joint": a theta for each joint; "shared": one for all, as in the thesis (2.47).
        columns: "rigid" leaves out theta7 and theta8, which no rigid body has; "thesis": all.
        l2: m, keeps theta6 = l2 theta4. use: (n, 3) bool, which samples count, as `Motion.use`. unit: "PWM" or "N m".

    Returns: Estimate. Raises: InputError on bad arguments; IdentificationError if there are too few samples or no motion.
    """
    choice("unit", unit, ("PWM", "N m"))
    choice("method", method, ("ls", "bounded"))
    choice("rows", rows, ("joint", "shared"))
    choice("columns", columns, tuple(COLUMNS))
    if l2 is not None:
        metres("l2", l2)
    Phi, y = checked_data(Phi, y)
    used = np.ones(y.shape) if use is None else _checked_use(use, y)
    theta, stderr, covariance = np.zeros((3, 20)), np.full((3, 20), np.nan), np.zeros((3, 20, 20))
    condition, freedom, lost, notes = np.zeros(3), np.zeros(3), [], []
    for joints in [slice(0, 3)] if rows == "shared" else [slice(j, j + 1) for j in range(3)]:
        who = "" if rows == "shared" else f"joint {joints.stop}: "
        here, ties, names = _acting(joints, COLUMNS[columns], l2)
        # rows of zeros (samples that do not count) say nothing, and leave the others at their place in time
        A = (Phi[:, joints, here] * used[:, joints, None]).reshape(-1, len(here)) @ ties
        problem = Problem(A, (y * used)[:, joints].ravel(), names, len(y), who=who)
        ties = ties[:, problem.kept]
        x, spread = problem.estimate()
        if method == "bounded":
            x = _bounded(problem)
        found = ties.any(axis=1)
        spread = ties @ spread @ ties.T
        count = used[:, joints].sum()
        theta[joints, here] = ties @ x
        stderr[joints, here] = np.where(found, np.sqrt(np.maximum(np.diag(spread), 0.0)), np.inf)
        covariance[joints, np.array(here)[:, None], here] = spread
        condition[joints] = problem.condition
        freedom[joints] = count / max(count - len(x), 1.0)
        lost += [who + NAMES[k] for k, known in zip(here, found, strict=True) if not known]
        notes += problem.notes
    residuals = y - np.einsum("nij,ij->ni", Phi, theta)
    return Estimate(
        theta=theta,
        stderr=stderr,
        covariance=covariance,
        condition=condition,
        residuals=residuals,
        sigma=np.sqrt(np.sum(used * residuals**2, axis=0) / used.sum(axis=0) * freedom),
        columns=tuple(tuple(NAMES[k] for k in np.flatnonzero(np.isfinite(row))) for row in stderr),
        unidentifiable=tuple(lost),
        warnings=(*notes, *impossible_values(theta, stderr, rows), *indefinite_mass(theta)),
        unit=unit,
        method=method,
        rows=rows,
    )


def _bounded(problem):
    """Inertial and friction terms >= 0: scipy's lsq_linear on R; y scaled to 1, for the solver's tolerances."""
    low = [-np.inf if name in FREE_OF_SIGN else 0.0 for name in problem.names]
    size = np.linalg.norm(problem.Qty) or 1.0
    result = lsq_linear(problem.R, problem.Qty / size, (low, np.inf), method="bvls", tol=1e-14)
    if not result.success:
        raise IdentificationError(f"{problem.who}the bounded fit failed ({result.message}); use 'ls'")
    at = [f"{name} = 0" for name, active in zip(problem.names, result.active_mask, strict=True) if active]
    if at:
        problem.notes.append(f"{problem.who}at a bound: {', '.join(at)}; the data alone would go beyond")
    return result.x * size / problem.scale  # a bound exactly


def _acting(joints, chosen, l2):
    """Columns that act on some joints; theta[columns] = ties beta, where l2 makes beta shorter; names of beta."""
    here = [k for k in chosen if any(k in acting for acting in ACTS_ON[joints])]
    ties, kept = np.eye(len(here)), list(range(len(here)))
    if l2 is not None and _THETA4 in here:
        ties[here.index(_THETA6), here.index(_THETA4)] = l2
        kept.remove(here.index(_THETA6))
    return here, ties[:, kept], [NAMES[here[k]] for k in kept]


def _checked_use(use, y):
    use = np.asarray(use)
    if use.dtype != bool or use.shape != y.shape:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    if use.sum(axis=0).min() < 40:
        raise IdentificationError(f"only {use.sum(axis=0)} samples to be used, 40 are needed: record more motion")
    return use.astype(float)
