"""Least squares for any regressor matrix: columns that say nothing are named, standard errors hold."""

import numpy as np

from ir50p_lab.identification import least_squares


def test_general_least_squares_of_more_equations_a_sample():
    rng = np.random.default_rng(0)
    A = rng.normal(size=(300, 2, 4))
    A[:, :, 3] = 2 * A[:, :, 1]
    x = np.array([1.0, -2.0, 0.5, 0.0])
    z = []
    for seed in range(60):
        found = least_squares(A, A @ x + np.random.default_rng(seed).normal(size=(300, 2)))
        assert found.dropped == ("x4",) and np.isinf(found.stderr[3]) and found.residuals.shape == (300, 2)
        z.append(((found.x - x) / found.stderr)[:3])
    assert 0.75 < np.std(z) < 1.15
