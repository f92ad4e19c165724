"""fit_line: the line through points that scatter, and how sure it is."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def fit_line(x, y):
    """Return slope, offset and the covariance (2, 2) of both, of the least-squares line through points x, y (n,)."""
    n = len(x)
    A = np.column_stack([x, np.ones(n)])
    N = A.T @ A
    slope, offset = np.linalg.solve(N, A.T @ y)
    rest = y - slope * x - offset
    variance = np.sum(rest**2) / (n - 2)
    covariance = variance * np.linalg.solve(N, np.eye(2))
    return slope, offset, covariance


def _points():
    rng = np.random.default_rng(101)
    lines = (
        (10, 0, 5, 2.0, -1.0, 0.5),
        (6, -3, 4, -1.5, 2.0, 0.4),  # falls
        (3, 0, 2, 1.0, 0.5, 0.6),  # the fewest
        (40, 300, 800, 0.09, -45.0, 0.5),  # counts, far from 0, and degrees
        (12, -9, -2, 0.7, 3.0, 0.3),  # all left of 0
        (8, 2, 9, 0.0, 1.2, 0.5),  # level
    )
    cases = []
    for n, low, high, slope, offset, noise in lines:
        x = rng.uniform(low, high, n)  # in no order
        cases.append((x, slope * x + offset + rng.normal(0, noise, n)))
    whole = np.array([5, 1, 4, 2, 3])
    return [*cases, (whole, 2 * whole - 3)]  # exactly on a line


_SAYS = sentences("fit_line", __file__)


def _symptom(case, returned, expected):
    spread, right = np.asarray(returned[2]), expected[2]
    if spread.shape != (2, 2):
        return ""
    if np.any(np.diag(spread) < 0):
        return _SAYS["negative"]
    if spread[0, 1] * right[0, 1] < 0:
        return _SAYS["sign"]
    return _SAYS["size"] if np.allclose(spread[0, 1] * right, right[0, 1] * spread, 0, 1e-6) else ""


TASK = task_of(
    fit_line,
    cases=_points,
    results=("slope", "offset", "covariance"),
    tolerance=(1e-7, 1e-5, 1e-6),
    symptom=_symptom,
)
