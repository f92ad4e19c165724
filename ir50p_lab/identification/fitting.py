"""`fit`: the 20 parameters from a regressor and measured torque or PWM, either free or within physical bounds."""

import numpy as np
from scipy.optimize import lsq_linear

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.estimate import Estimate, impossible_values, indefinite_mass
from ir50p_lab.identification.fit_input import checked_data
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, FREE_OF_SIGN, NAMES, metres
from ir50p_lab.identification.recording_checks import at_bounds
from ir50p_lab.identification.regression import Problem
from ir50p_lab.inputs import choice

_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")


def fit(Phi, y, *, method="ls", rows="joint", columns="rigid", l2=None, use=None, unit="PWM"):
    """Fit theta of y = Phi theta    (2.35); find its standard errors, and which parameters the data do not determine.

    Args:
        Phi: (n, 3, 20) as `regressor` returns; y: (n, 3), in `unit`.
        method: "ls": the least sum of squares, by QR; "bounded": the same with inertial and friction terms >= 0 and
            offsets free. For weights, multiply the rows of Phi and y by 1/sigma.
        rows: "joint": each joint has its own parameters, which is right for motors of unequal gain. "shared": one theta
            for all, as in the thesis, which is right for torque, or for equal motors (2.47 corrected).
        columns: "rigid" (all except theta7 and theta8, which no rigid body has), "thesis" (all 20).
        l2: length of the upper arm, m: ties theta6 = l2 theta4, as in every in-line arm.
        use: (n, 3) bool: the samples of each joint that count, as `Motion.use`; default all. unit: "PWM" or "N m".

    Returns: Estimate. A column that is a combination of others in these data is left out and named: its parameter is
    0 with stderr inf. A parameter that "bounded" leaves at a bound is named, too, and its stderr is inf. The standard
    errors also hold for residuals that are correlated in time, as they are after a filter. They assume that Phi is free
    of noise; noise in it biases both methods.
    Raises: InputError on bad arguments; IdentificationError if there are too few samples, no motion, or the bounded fit
        cannot settle.
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
    fitted = np.zeros((3, 20), dtype=bool)
    for joints in [slice(0, 3)] if rows == "shared" else [slice(j, j + 1) for j in range(3)]:
        who = "" if rows == "shared" else f"joint {joints.stop}: "
        here, ties, names = _acting(joints, COLUMNS[columns], l2)
        A = _equations(Phi, used, joints, here) @ ties
        problem = Problem(A, (y * used)[:, joints].ravel(), names, len(y), who=who)
        ties = ties[:, problem.kept]
        x, spread = _bounded(problem) if method == "bounded" else problem.estimate(problem.Qty)
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


def _equations(Phi, used, joints, here):
    """The columns `here` of Phi (n, 3, 20) for k joints, sample by sample, times `used` (n, 3): (n k, p).

    Samples that are not used become rows of zeros: these tell nothing, and the others keep their place in time.
    """
    return (Phi[:, joints, here] * used[:, joints, None]).reshape(-1, len(here))


def _bounded(problem):
    """min |y - A x|^2 with inertial and friction terms >= 0, a convex problem, by scipy.optimize.lsq_linear on R.

    Standard errors are those without bounds; of what is left at its bound the error is infinite.
    """
    low = np.where(np.isin(problem.names, FREE_OF_SIGN), -np.inf, 0.0)
    size = np.linalg.norm(problem.Qty) or 1.0  # y is scaled to 1: the solver's tolerances then suit every unit
    result = lsq_linear(problem.R, problem.Qty / size, (low, np.inf), method="bvls", tol=1e-14)
    if not result.success:
        raise IdentificationError(f"{problem.who}the bounded fit failed ({result.message}); use 'ls'")
    said, at = at_bounds(problem.names, result.x, low, np.inf)
    problem.notes += [problem.who + sentence for sentence in said]
    problem.at_bound = np.flatnonzero(at)
    _, covariance = problem.estimate(problem.R @ result.x * size)
    return result.x * size / problem.scale, covariance  # not from `estimate`: a parameter at its bound is exactly 0


def _checked_use(use, y):
    use = np.asarray(use)
    if use.dtype != bool or use.shape != y.shape:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    if use.sum(axis=0).min() < 40:
        raise IdentificationError(f"only {use.sum(axis=0)} samples to be used, 40 are needed: record more motion")
    return use.astype(float)
