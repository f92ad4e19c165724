"""The answers of notebooks 01 and A2, worked out by hand: no function of the package on this side."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import grade, solution
from ir50p_lab.course.exercises.pose import EXERCISES

BY_NAME = {exercise.name: exercise for exercise in EXERCISES}
BY_HAND = {
    "pose-2": 55 * np.pi / 180,
    "pose-3": [-0.1, 0.3, -0.2],
}


def test_every_exercise_is_worked_out_here():
    assert list(BY_HAND) == list(BY_NAME)


@pytest.mark.parametrize("name", BY_HAND)
def test_the_answer_by_hand_is_right(name):
    assert grade(BY_NAME[name], BY_HAND[name]).state == "right"
    np.testing.assert_allclose(solution(name), BY_HAND[name], atol=1e-12)
