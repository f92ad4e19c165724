"""The answers of notebook 01, worked out by hand: no function of the package on this side."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import judge, solution
from ir50p_lab.course.exercises.pose import EXERCISES

BY_NAME = {exercise.name: exercise for exercise in EXERCISES}
COS15, SIN15 = (np.sqrt(6) + np.sqrt(2)) / 4, (np.sqrt(6) - np.sqrt(2)) / 4
HALF = np.sqrt(2) / 2


def tip_by_hand(q1, q2, q3):
    """Tip of a 0.285, 0.200, 0.372 m arm by plane trigonometry."""
    radius = 0.2 * np.cos(q2) + 0.372 * np.cos(q2 + q3)
    return [radius * np.cos(q1), radius * np.sin(q1), 0.285 + 0.2 * np.sin(q2) + 0.372 * np.sin(q2 + q3)]


BY_HAND = {
    "pose-1": [0.1, 0, 0.1 * np.sqrt(3)],
    "pose-2": 55 * np.pi / 180,
    "pose-3": [-0.1, 0.3, -0.2],
    "pose-4": [0.2 * HALF + 0.372 * COS15, 0.2 * HALF - 0.372 * SIN15, 0],
    "pose-5": tip_by_hand,
}


def test_every_exercise_is_worked_out_here():
    assert list(BY_HAND) == list(BY_NAME)


@pytest.mark.parametrize("name", BY_HAND)
def test_the_answer_by_hand_is_right(name):
    assert judge(BY_NAME[name], BY_HAND[name]).state == "right"
    if name != "pose-5":
        np.testing.assert_allclose(solution(name), BY_HAND[name], atol=1e-12)


@pytest.mark.parametrize(
    ("name", "answer", "hint"),
    [
        ("pose-1", [-0.1, 0, 0.1732], "the other way"),
        ("pose-1", [0, -0.1, 0.1732], "about x"),
        ("pose-1", [0.1732, 0, 0.1], "swapped"),
        ("pose-1", [100, 0, 173.2], "mm|millimetre"),
        ("pose-2", -15 * np.pi / 180, "difference"),
        ("pose-2", 55, "degrees"),
        ("pose-2", 20 * np.pi / 180, "third turn got lost"),
        ("pose-3", [-0.3, -0.1, -0.2], "along the axes of"),
        ("pose-3", [0.1, -0.3, -0.2], "transposed"),
        ("pose-3", [0.1, -0.3, 0.2], "seen from"),
        ("pose-4", tip_by_hand(*np.radians([30, 45, -60])), "base frame"),
        ("pose-4", [0.2 * HALF, 0.2 * HALF, 0], "one matrix early"),
        ("pose-4", [0.4, 0.4, 0.4], "expected 3 numbers"),
        ("pose-5", lambda q: [tip_by_hand(*q)[0], tip_by_hand(*q)[0], tip_by_hand(*q)[2]], "s1, not c1"),
        ("pose-5", lambda q: tip_by_hand(q[0], q[1], q[2] - q[1]), "from the horizon"),
        ("pose-5", lambda q: tip_by_hand(*np.radians(q)), "as degrees"),
        ("pose-5", lambda q: tip_by_hand(q[0], -q[1], -q[2]), "lift the arm"),
    ],
)
def test_typical_wrong_answers_are_told_apart(name, answer, hint):
    verdict = judge(BY_NAME[name], answer)
    assert verdict.state in ("slip", "wrong")
    assert any(part in verdict.text for part in hint.split("|")), verdict.text


def test_a_function_of_three_angles_is_as_good():
    assert judge(BY_NAME["pose-5"], lambda q: tip_by_hand(*q)).state == "right"
    assert judge(BY_NAME["pose-5"], tip_by_hand).state == "right"


def test_the_stubs_of_the_notebook_are_open():
    def answer(q): ...

    assert judge(BY_NAME["pose-5"], answer).state == "open"
    assert judge(BY_NAME["pose-1"], ...).state == "open"
