"""Exercises of notebooks 17 and 18: each solution by another route."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P, forward_kinematics
from ir50p_lab.vision import Checkerboard, calibrate_corners
from ir50p_lab.vision.calibration.rendered import board_poses
from ir50p_lab.vision.reaching.plan import nearest_reachable
from ir50p_lab.vision.rendering import bench_camera

STILL = np.zeros(3)
LENS = ("k1", "k2", "p1", "p2")


def test_a_pixel_by_opencv():
    K = np.array([[700.0, 0, 320], [0, 690, 240], [0, 0, 1]])
    xy, _ = cv2.projectPoints(np.array([[-0.08, 0.06, 0.5]]), STILL, STILL, K, None)
    assert np.ravel(xy) == pytest.approx(solution("calib-1"))


def test_the_lens_by_opencv():
    k = (-0.3, 0.12, 0.004, -0.002)
    for x, y in ((0.2, -0.3), (-0.5, 0.1)):
        bent, _ = cv2.projectPoints(np.array([[x, y, 1.0]]), STILL, STILL, np.eye(3), np.array(k))
        assert np.ravel(bent) == pytest.approx(solution("calib-2")(x, y, *k))


def test_a_wrong_square_spoils_the_distances_only():
    camera, _ = bench_camera()
    board = Checkerboard().points
    seen = [camera.project(T, board) for T in board_poses(camera, 5, seed=3)]
    right, wrong = (calibrate_corners(scale * board, seen, camera.size, lens=LENS) for scale in (1, 25 / 24))
    assert np.allclose(right.K, wrong.K, atol=1e-3)
    assert wrong.views[0].T_cam_board[2, 3] / right.views[0].T_cam_board[2, 3] == pytest.approx(25 / 24)
    assert solution("calib-3") == "distances"


def test_a_ball_read_on_the_table_by_a_line_and_a_plane():
    lens, ball = np.array([0.0, 0.6]), np.array([0.5, 0.03])  # along the table, height
    on_table = lens + (ball - lens) * lens[1] / (lens[1] - ball[1])
    assert on_table[1] == pytest.approx(0) and on_table[0] - 0.5 == pytest.approx(solution("calib-4"))


def test_a_ball_in_the_base_by_the_way_back():
    T = np.array([[0, 0.6, -0.8, 0.9], [1, 0, 0, 0.1], [0, -0.8, -0.6, 0.7], [0, 0, 0, 1.0]])
    back = np.linalg.solve(T, [*solution("reach-1"), 1.0])
    assert back[:3] == pytest.approx((0.05, 0.10, 0.80))


def test_what_is_missing_by_a_search():
    goal = np.array([0.56, 0.12, 0.09])
    missing = np.linalg.norm(nearest_reachable(IR50P, goal) - goal)  # to the limits less 0.03 rad, and that is less
    assert missing == pytest.approx(solution("reach-2"), abs=5e-4)


def test_one_count_by_moving_the_arm():
    q = np.array([0.0, 0.5, -1.4])
    moved = forward_kinematics(IR50P, q + np.array([0, 1 / 122, 0])) - forward_kinematics(IR50P, q)
    assert 1e3 * np.linalg.norm(moved) == pytest.approx(solution("reach-3"), rel=0.01)


def test_the_marker_is_the_tip_of_a_shorter_arm():
    l1, l2, l3 = IR50P.l
    short = replace(IR50P, l=(l1, l2, l3 - 0.042))
    for q in np.random.default_rng(0).uniform(-1, 1, (5, 3)):
        assert solution("reach-4")(q) == pytest.approx(forward_kinematics(short, q))
