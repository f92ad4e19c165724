"""Bounded and physically consistent estimates: inertial and friction terms are not negative, offsets are free."""

import numpy as np
from scipy.optimize import lsq_linear

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.least_squares import Solution
from ir50p_lab.identification.parameters import NAMES, OFFSETS, ONLY_THESIS

_FREE = (*OFFSETS, *ONLY_THESIS)


def checked_bounds(bounds):
    """{name: (low, high)} for all parameters: >= 0 but for offsets and the thesis' products of inertia, or as given.

    Raises InputError for an unknown name or low >= high.
    """
    limits = {name: (-np.inf if name in _FREE else 0.0, np.inf) for name in NAMES}
    for name, pair in (bounds or {}).items():
        if name not in limits:
            raise InputError(f"bounds for {name!r}: no such parameter; choose among {', '.join(NAMES)}")
        try:
            low, high = map(float, pair)
        except (TypeError, ValueError):
            raise InputError(f"bounds of {name} are {pair!r}: give (low, high), -inf or inf for none") from None
        if not low < high:
            raise InputError(f"bounds of {name} are ({low}, {high}): low must be below high")
        limits[name] = low, high
    return limits


def bounded(problem, limits):
    """min |y - A beta|^2 with limits on the parameters, a convex problem, by scipy.optimize.lsq_linear on R.

    Standard errors are those without bounds: a bound can only make an estimate surer.
    """
    low, high = (np.array([limits[name][side] for name in problem.names]) * problem.scale for side in (0, 1))
    # y may be of any size: scaled to 1, so that the solver's tolerances mean the same for every unit
    size = np.linalg.norm(problem.Qty) or 1.0
    result = lsq_linear(problem.R, problem.Qty / size, (low / size, high / size), method="bvls", tol=1e-14)
    if not result.success:
        raise IdentificationError(f"{problem.who}the bounded fit failed ({result.message}); use 'ls' or wider bounds")
    beta = result.x * size
    at = [
        f"{name} = {value:.4g}"
        for name, value, active in zip(problem.names, beta / problem.scale, result.active_mask, strict=True)
        if active
    ]
    notes = [f"{problem.who}at a bound: {', '.join(at)}; the data alone would go beyond"] if at else []
    return Solution(beta, np.eye(len(beta)), problem.Q, problem.residuals(beta), notes)
