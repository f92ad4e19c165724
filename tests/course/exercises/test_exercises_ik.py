"""The answers of notebook 03, worked out by hand: no function of the package on this side."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import grade, solution
from ir50p_lab.course.exercises.ik import EXERCISES

BY_NAME = {exercise.name: exercise for exercise in EXERCISES}


def velocity_by_hand(row_2_from="sin"):
    """Chain rule for a 0.285, 0.200, 0.372 m arm at (30, 45, -60) degrees and (0.5, -0.2, 0.4) rad/s."""
    q1, q2, q23 = np.radians([30, 45, -15])
    radius = 0.2 * np.cos(q2) + 0.372 * np.cos(q23)
    radius_rate = -0.2 * np.sin(q2) * -0.2 - 0.372 * np.sin(q23) * (-0.2 + 0.4)
    height_rate = 0.2 * np.cos(q2) * -0.2 + 0.372 * np.cos(q23) * (-0.2 + 0.4)
    x_rate = radius_rate * np.cos(q1) - radius * np.sin(q1) * 0.5
    y_rate = radius_rate * np.sin(q1) + radius * np.cos(q1) * 0.5
    return [x_rate, x_rate if row_2_from == "cos" else y_rate, height_rate]


BY_HAND = {
    "ik-1": velocity_by_hand(),
}


def test_every_exercise_is_worked_out_here():
    assert list(BY_HAND) == list(BY_NAME)


@pytest.mark.parametrize("name", BY_HAND)
def test_the_answer_by_hand_is_right(name):
    assert grade(BY_NAME[name], BY_HAND[name]).state == "right"
    np.testing.assert_allclose(solution(name), BY_HAND[name], atol=1e-12)
