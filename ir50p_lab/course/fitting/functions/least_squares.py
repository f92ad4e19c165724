"""least_squares: the numbers that explain equations best, and how sure they are."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


def least_squares(A, y):
    """Return the theta (p,) with which A (n, p) theta is nearest to y (n,), and its standard errors (p,)    (2.34)."""
    N = A.T @ A
    theta = np.linalg.solve(N, A.T @ y)
    rest = y - A @ theta
    variance = np.sum(rest**2) / (len(y) - len(theta))
    inverse = np.linalg.solve(N, np.eye(len(theta)))
    errors = np.sqrt(variance * np.diag(inverse))
    return theta, errors


def _equations():
    rng = np.random.default_rng(121)
    sizes = ((12, 2, 0.3), (30, 3, 0.1), (7, 3, 0.5), (40, 5, 0.2), (9, 4, 1.0), (5, 1, 0.3), (200, 10, 2.0))
    cases = []
    for n, p, noise in sizes:
        A = rng.normal(size=(n, p)) @ (np.eye(p) + 0.5) * rng.uniform(0.3, 3, p)  # of unequal size, not at right angles
        cases.append((A, A @ rng.uniform(-3, 3, p) + rng.normal(0.4, noise, n)))
    whole = np.array([[1, 0], [2, 1], [1, 2], [0, 3], [1, 1]])
    return [*cases, (whole, np.array([1, 3, 2, 5, 2]))]


TASK = task_of(least_squares, cases=_equations, results=("theta", "errors"), tolerance=1e-7)
