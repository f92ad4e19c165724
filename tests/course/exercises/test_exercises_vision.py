"""Exercises of notebooks 17 and 18: each solution by another route."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P, forward_kinematics

STILL = np.zeros(3)


def test_the_lens_by_opencv():
    k = (-0.3, 0.12, 0.004, -0.002)
    for x, y in ((0.2, -0.3), (-0.5, 0.1)):
        bent, _ = cv2.projectPoints(np.array([[x, y, 1.0]]), STILL, STILL, np.eye(3), np.array(k))
        assert np.ravel(bent) == pytest.approx(solution("calib-2")(x, y, *k))


def test_a_ball_read_on_the_table_by_a_line_and_a_plane():
    lens, ball = np.array([0.0, 0.6]), np.array([0.5, 0.03])  # along the table, height
    on_table = lens + (ball - lens) * lens[1] / (lens[1] - ball[1])
    assert on_table[1] == pytest.approx(0) and on_table[0] - 0.5 == pytest.approx(solution("calib-4"))


def test_one_count_by_moving_the_arm():
    q = np.array([0.0, 0.5, -1.4])
    moved = forward_kinematics(IR50P, q + np.array([0, 1 / 122, 0])) - forward_kinematics(IR50P, q)
    assert 1e3 * np.linalg.norm(moved) == pytest.approx(solution("reach-3"), rel=0.01)


def test_the_marker_is_the_tip_of_a_shorter_arm():
    l1, l2, l3 = IR50P.l
    short = replace(IR50P, l=(l1, l2, l3 - 0.042))
    for q in np.random.default_rng(0).uniform(-1, 1, (5, 3)):
        assert solution("reach-4")(q) == pytest.approx(forward_kinematics(short, q))
