"""Least squares for any regressor matrix: columns that say nothing are named, standard errors hold."""

import numpy as np
import pytest

from ir50p_lab.identification import least_squares


def test_general_least_squares_of_more_equations_a_sample():
    rng = np.random.default_rng(0)
    A = rng.normal(size=(300, 2, 4))
    A[:, :, 3] = 2 * A[:, :, 1]
    x = np.array([1.0, -2.0, 0.5, 0.0])
    z = []
    for seed in range(60):
        found = least_squares(A, A @ x + np.random.default_rng(seed).normal(size=(300, 2)), names="abcd")
        assert found.dropped == ("d",) and np.isinf(found.stderr[3]) and found.residuals.shape == (300, 2)
        z.append(((found.x - x) / found.stderr)[:3])
    assert 0.75 < np.std(z) < 1.15


def test_doubled_and_empty_columns_are_dropped():
    rng = np.random.default_rng(0)
    a = rng.normal(size=(100, 3))
    A = np.column_stack([a, np.zeros(100), a[:, 0] * 2])
    found = least_squares(A, a @ [1, 2, 3])
    assert found.dropped == ("x4", "x5") and found.x == pytest.approx([1, 2, 3, 0, 0])
    assert np.isinf(found.stderr[[3, 4]]).all()
