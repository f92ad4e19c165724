"""Exercises of notebook 12: right answers by another route."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import inverse_dynamics


def test_the_step_is_least_squares_with_a_first_guess():
    """theta = 2 with P = 0.5 is a measurement of theta itself, of variance 0.5, beside y = 3 theta of variance 1."""
    A, y = np.array([[np.sqrt(2)], [3.0]]), np.array([2 * np.sqrt(2), 9.0])
    assert solution("ident-1") == pytest.approx(np.linalg.lstsq(A, y)[0][0])


def test_what_a_clamped_joint_hides():
    """Another route: how many directions of theta change any torque, by differences of the inverse dynamics."""
    q, qd, qdd = np.random.default_rng(3).uniform(-2, 2, (3, 60, 3))
    qd[:, 0] = qdd[:, 0] = 0.0
    columns = []
    for k in range(20):
        theta = np.zeros((3, 20))
        theta[:, k] = 1.0
        columns.append(inverse_dynamics(theta, q, qd, qdd).ravel())
    kept = [column for k, column in enumerate(columns) if k not in (6, 7)]
    assert solution("ident-2") == np.linalg.matrix_rank(np.array(kept))
