"""homography: from four pixels and their places on the table to the matrix that takes every pixel there."""

import numpy as np

from ir50p_lab.course.checking.shape_checks import no_numbers
from ir50p_lab.course.checking.task import sentences, task_of


def homography(pixels, table):
    """Return H (3, 3), last entry 1: w (X, Y, 1) = H (u, v, 1) takes undistorted pixels (4, 2) to places (4, 2) m."""
    A = np.zeros((8, 8))
    b = np.zeros(8)
    for k in range(4):
        u, v = pixels[k]
        X, Y = table[k]
        A[2 * k] = [u, v, 1, 0, 0, 0, -X * u, -X * v]
        A[2 * k + 1] = [0, 0, 0, u, v, 1, -Y * u, -Y * v]
        b[2 * k] = X
        b[2 * k + 1] = Y
    h = np.linalg.solve(A, b)
    return np.array([h[0:3], h[3:6], [h[6], h[7], 1]])


def _boards():
    rng = np.random.default_rng(171)
    around = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    cases = []
    for _ in range(7):
        table = rng.uniform(-0.4, 0.4, 2) + around * rng.uniform(0.15, 0.3, 2) + rng.uniform(-0.02, 0.02, (4, 2))
        pixels = rng.uniform(100, 250, 2) + around * rng.uniform(120, 250, 2) + rng.uniform(-40, 40, (4, 2))
        cases.append((pixels, table))
    from_above = np.array([(100, 100), (200, 100), (200, 180), (100, 180)])  # whole numbers, too
    return [*cases, (from_above, np.array([(0.3, 0.1), (0.5, 0.1), (0.5, -0.06), (0.3, -0.06)]))]


def _same(returned, expected):
    """A homography times a number is the same one."""
    one, other = (np.asarray(H, dtype=float) for H in (returned, expected))
    if one.shape != (3, 3) or other.shape != (3, 3) or not one[2, 2] * other[2, 2]:
        return one.shape == other.shape and bool(np.allclose(one, other))
    return bool(np.allclose(one / one[2, 2], other / other[2, 2], rtol=1e-6, atol=1e-9))


_SAYS = sentences("homography", __file__)


def _symptom(case, returned, expected):
    """Which of the four points go where they belong, in X and in Y."""
    if says := no_numbers(returned, expected):
        return says
    pixels, table = case
    X, Y, w = np.asarray(returned, dtype=float) @ np.column_stack([pixels, np.ones(4)]).T
    with np.errstate(all="ignore"):
        arrives = np.isclose(np.array([X, Y]) / w, table.T, atol=1e-6).T
    if arrives.all(axis=0).any():
        return _SAYS["X alone" if arrives[:, 0].all() else "Y alone"]
    points = arrives.all(axis=1).sum()
    return _SAYS["some"].format(points) if points else _SAYS["none"]


TASK = task_of(homography, cases=_boards, compare=_same, symptom=_symptom)
