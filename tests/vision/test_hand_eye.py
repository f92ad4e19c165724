"""Camera in the base frame from arm poses: exact on exact input, honest with potentiometers, poor poses refused."""

from functools import cache

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision.board_pose import board_points, board_pose, inverse_transform, transform
from ir50p_lab.vision.hand_eye import hand_eye, tool_poses
from ir50p_lab.vision.pinhole import Pinhole
from ir50p_lab.vision.rendering.places import look_at

cv2.setNumThreads(1)
CAMERA = Pinhole([[702, 0, 323.5], [0, 699, 236], [0, 0, 1]], (-0.12, 0.08, 8e-4, -6e-4))
BOARD = board_points((9, 6), 0.012, np.eye(4))
T_TOOL_BOARD = transform([2.1, 2.3, 0.1], [0.01, -0.05, 0.01])  # held across the hand, its print to the front
T_BASE_CAM = inverse_transform(look_at((1.0, 0.05, 0.62), (0.40, 0.0, 0.0)))
COUNT = 1 / np.array([189.1, 122.1, 191.7])  # rad
SCATTER = np.array([1e-3, 1e-3, 1e-3])  # rad, play and noise


def drawn_poses(n, seed=0):
    """Poses in which the board is in the picture and faces the camera."""
    rng, kept = np.random.default_rng(seed), []
    T_cam_base = inverse_transform(T_BASE_CAM)
    while len(kept) < n:
        q = rng.uniform((-1.2, -0.4, -2.2), (1.2, 1.4, 0.3))
        T = T_cam_base @ tool_poses(IR50P, q)[0] @ T_TOOL_BOARD
        X = BOARD @ T[:3, :3].T + T[:3, 3]
        if X[:, 2].min() < 0.3 or T[2, 2] < 0.3:
            continue
        xy = CAMERA.project(np.eye(4), X)
        if xy.min() > 5 and xy[:, 0].max() < 634 and xy[:, 1].max() < 474:
            kept.append(q)
    return np.array(kept)


@cache
def views(n=20, seed=0, px=0.0):
    """True angles and corners."""
    rng = np.random.default_rng([seed, 1])
    q = drawn_poses(n, seed)
    T = inverse_transform(T_BASE_CAM) @ tool_poses(IR50P, q) @ T_TOOL_BOARD
    corners = np.array([CAMERA.project(one, BOARD) for one in T])
    return q, corners + rng.normal(0, px, corners.shape) if px else corners


def seen(corners):
    return [board_pose(CAMERA, one, BOARD) for one in corners]


def far(T, other):
    """Angle rad and distance m between two transforms."""
    return np.linalg.norm(cv2.Rodrigues(T[:3, :3].T @ other[:3, :3])[0]), np.linalg.norm(T[:3, 3] - other[:3, 3])


def test_exact_poses_give_the_exact_camera():
    q, corners = views()
    found = hand_eye(IR50P, q, seen(corners))
    assert max(found.rms) < 1e-6
    assert max(far(found.T_base_cam, T_BASE_CAM)) < 1e-6
    assert max(far(found.T_tool_board, T_TOOL_BOARD)) < 1e-6


def measured(q, *, seed, offset=(0, 0, 0)):
    """What potentiometers show: a constant error, scatter (play, noise), whole counts."""
    shown = q + np.array(offset) + np.random.default_rng([seed, 2]).normal(0, SCATTER, q.shape)
    return np.round(shown / COUNT) * COUNT


def test_a_constant_error_of_joint_1_hides_in_a_turn_of_the_camera():
    q, corners = views(20, 1, 0.1)
    shown = measured(q, seed=1)
    plain, turned = (hand_eye(IR50P, shown + np.array([off, 0, 0]), seen(corners)) for off in (0, 0.05))
    assert np.allclose(plain.rms, turned.rms, rtol=1e-3)
    assert far(plain.T_base_cam, turned.T_base_cam)[0] == pytest.approx(0.05, rel=1e-3)


# ---- bad input


def test_too_few_and_parallel_poses_are_refused():
    q, corners = views()
    with pytest.raises(CalibrationError, match="at least 4"):
        hand_eye(IR50P, q[:3], seen(corners[:3]))
    for fixed in ((0,), (1, 2)):  # joint 1 still, or only joint 1 turned
        still = q.copy()
        still[:, fixed] = q[0, fixed]
        T = inverse_transform(T_BASE_CAM) @ tool_poses(IR50P, still) @ T_TOOL_BOARD
        with pytest.raises(CalibrationError, match="one axis only"):
            hand_eye(IR50P, still, T)


def test_inverted_and_mixed_up_views_are_refused():
    q, corners = views()
    T = [pose.T_cam_board for pose in seen(corners)]
    with pytest.raises(CalibrationError, match="inverted"):
        hand_eye(IR50P, q, [inverse_transform(one) for one in T])
    with pytest.raises(CalibrationError, match="disagree"):
        hand_eye(IR50P, q, T[::-1])
    with pytest.raises(InputError, match="one of each"):
        hand_eye(IR50P, q, T[:-1])


@pytest.mark.parametrize(("n", "seed"), [(8, 0), (8, 1), (15, 2), (25, 3)])
def test_inverted_views_are_refused_however_few_the_poses(n, seed):
    """Their residuals can be as small as 70 mm, with the camera 0.7 m off."""
    q, corners = views(n, seed, 0.1)
    shown = measured(q, seed=seed, offset=(0, 0.012, 0))
    T = [pose.T_cam_board for pose in seen(corners)]
    assert far(hand_eye(IR50P, shown, T).T_base_cam, T_BASE_CAM)[1] < 0.02
    with pytest.raises(CalibrationError, match="inverted"):
        hand_eye(IR50P, shown, [inverse_transform(one) for one in T])


@pytest.mark.parametrize("n", [5, 15, 25])
def test_the_worst_of_wrong_views_is_named(n):
    """One of 15 shifts the camera by centimetres."""
    q, corners = views(25, 3, 0.1)
    shown = measured(q, seed=3)[:n]
    T = [pose.T_cam_board for pose in seen(corners)][:n]
    with pytest.raises(CalibrationError, match=r"most in pose 2 \(counted from 0\)"):
        hand_eye(IR50P, shown, [*T[:2], T[3], *T[3:]])
    if n > 8:
        with pytest.raises(CalibrationError, match=r"most in pose [14] "):
            hand_eye(IR50P, shown, [T[0], T[4], T[2], T[3], T[1], *T[5:]])
        slipped = T[1].copy()
        slipped[0, 3] += 0.05
        with pytest.raises(CalibrationError, match=r"most in pose 1 "):
            hand_eye(IR50P, shown, [T[0], slipped, *T[2:]])


@pytest.mark.parametrize("bad", [None, ["a"] * 20])
def test_bad_poses_are_refused(bad):
    with pytest.raises(InputError, match="T_cam_board"):
        hand_eye(IR50P, views()[0], bad)
