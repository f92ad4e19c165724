"""Camera in the base frame from arm poses: exact on exact input, honest with potentiometers, poor poses refused."""

from functools import cache

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision.board_pose import board_points, board_pose, inverse_transform, transform
from ir50p_lab.vision.hand_eye import camera_from_board, hand_eye, loop_errors, tool_poses
from ir50p_lab.vision.hand_eye_refined import JOINT_TERMS, JointCorrection, refine_hand_eye
from ir50p_lab.vision.pinhole import Pinhole
from ir50p_lab.vision.rendering.places import look_at

cv2.setNumThreads(1)
CAMERA = Pinhole([[702, 0, 323.5], [0, 699, 236], [0, 0, 1]], (-0.12, 0.08, 8e-4, -6e-4))
BOARD = board_points((9, 6), 0.012, np.eye(4))
T_TOOL_BOARD = transform([2.1, 2.3, 0.1], [0.01, -0.05, 0.01])  # held across the hand, its print to the front
T_BASE_CAM = inverse_transform(look_at((1.0, 0.05, 0.62), (0.40, 0.0, 0.0)))
COUNT = 1 / np.array([189.1, 122.1, 191.7])  # rad
SCATTER = np.array([1e-3, 1e-3, 1e-3])  # rad, play and noise
SIGMA_Q = np.hypot(SCATTER, COUNT / np.sqrt(12))  # with the rounding to whole counts


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
    turn, _ = loop_errors(T, np.eye(4), other[None], np.eye(4)[None])
    return turn[0], np.linalg.norm(T[:3, 3] - other[:3, 3])


def test_exact_poses_give_the_exact_camera_by_every_method():
    q, corners = views()
    found = hand_eye(IR50P, q, seen(corners))
    assert max(found.rms) < 1e-6
    assert max(far(found.T_base_cam, T_BASE_CAM)) < 1e-6
    assert max(far(found.T_tool_board, T_TOOL_BOARD)) < 1e-6
    assert len(found.methods) == 6
    assert max(found.methods.values()) < 1e-5
    assert "mm" in found.table()


def test_the_board_on_the_table_gives_the_same_camera():
    T_base_board = np.array([[1, 0, 0, 0.3], [0, -1, 0, 0.1], [0, 0, -1, 0.0], [0, 0, 0, 1.0]])
    T_cam_board = inverse_transform(T_BASE_CAM) @ T_base_board
    assert np.allclose(camera_from_board(T_cam_board, T_base_board), T_BASE_CAM, atol=1e-12)


def measured(q, *, seed, terms=None):
    """What potentiometers show: the inverse of a smooth error, and scatter (play, noise); then whole counts."""
    shown = JointCorrection.of(IR50P, terms or {}).back(q)
    shown = shown + np.random.default_rng([seed, 2]).normal(0, SCATTER, q.shape)
    return np.round(shown / COUNT) * COUNT


TERMS = {"offset2": 0.012, "slope1": 0.008, "slope2": -0.010, "slope3": 0.009, "bow2": 0.008, "bow3": -0.006}


def test_refinement_takes_out_what_can_be_told_of_the_potentiometers():
    q, corners = views(30, 1, 0.1)
    shown = measured(q, seed=1, terms=TERMS)
    start = hand_eye(IR50P, shown, seen(corners))
    fit = refine_hand_eye(
        IR50P, CAMERA, shown, corners, BOARD, start, terms=tuple(TERMS), sigma_px=0.1, sigma_q=SIGMA_Q
    )
    off = np.array([fit.correction.terms[name] - TERMS[name] for name in TERMS])
    assert (np.abs(off) < 4 * np.array([fit.stderr[name] for name in TERMS])).all()
    assert far(fit.T_base_cam, T_BASE_CAM)[1] < far(start.T_base_cam, T_BASE_CAM)[1]
    assert far(fit.T_base_cam, T_BASE_CAM)[1] < 4 * fit.camera_stderr
    assert np.sqrt((fit.pose_rms**2).mean()) < 0.2
    assert np.allclose(fit.joint_errors.std(axis=0), SIGMA_Q, rtol=0.5)


def test_standard_errors_are_those_of_trials():
    """A constant error of joint 1 hides in the camera's turn about the column: its standard error counts that."""
    off, place = [], []
    for trial in range(12):
        q, corners = views(20, 2, 0.1)
        hidden = np.random.default_rng([trial, 3]).normal(0, SIGMA_Q[0])
        shown = measured(q, seed=trial, terms={"offset1": hidden, "offset2": 0.01})
        start = hand_eye(IR50P, shown, seen(corners))
        fit = refine_hand_eye(IR50P, CAMERA, shown, corners, BOARD, start, sigma_px=0.1, sigma_q=SIGMA_Q)
        off.append((fit.correction.terms["offset2"] - 0.01) / fit.stderr["offset2"])
        place.append(far(fit.T_base_cam, T_BASE_CAM)[1] / fit.camera_stderr)
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.7
    assert 0.5 < np.sqrt(np.mean(np.square(place))) < 1.7


@pytest.mark.parametrize(("term", "why"), [("offset1", "known_T_base_cam"), ("offset3", "known_T_tool_board")])
def test_offsets_that_hide_behind_another_unknown_are_refused(term, why):
    q, corners = views()
    start = hand_eye(IR50P, q, seen(corners))
    with pytest.raises(CalibrationError, match=why):
        refine_hand_eye(IR50P, CAMERA, q, corners, BOARD, start, terms=(term,))


def test_knowing_camera_and_gripper_makes_all_offsets_visible():
    q, corners = views()
    true = {"offset1": 0.01, "offset2": -0.01, "offset3": 0.012}
    shown = JointCorrection.of(IR50P, true).back(q)
    start = hand_eye(IR50P, shown, seen(corners))
    known = {"known_T_base_cam": (T_BASE_CAM, 1e-4, 1e-4), "known_T_tool_board": (T_TOOL_BOARD, 1e-4, 1e-4)}
    fit = refine_hand_eye(IR50P, CAMERA, shown, corners, BOARD, start, terms=tuple(true), **known)
    for name, value in true.items():
        assert fit.correction.terms[name] == pytest.approx(value, abs=5e-4)


def test_a_correction_and_its_inverse():
    rng = np.random.default_rng(5)
    terms = dict(zip(JOINT_TERMS, rng.normal(0, 0.01, 9), strict=True))
    correction = JointCorrection.of(IR50P, terms)
    q = rng.uniform(-1, 1, (20, 3))
    assert np.allclose(correction(correction.back(q)), q, atol=1e-7)
    assert np.abs(correction(q) - q).max() > 1e-3
    assert np.allclose(JointCorrection.of(IR50P)(q), q)


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


@pytest.mark.parametrize("n", [8, 15, 25])
@pytest.mark.parametrize("seed", range(4))
def test_inverted_views_are_refused_however_few_the_poses(n, seed):
    """Their residuals can be as small as 70 mm, with the camera 0.7 m off."""
    q, corners = views(n, seed, 0.1)
    shown = measured(q, seed=seed, terms={"offset2": 0.012})
    T = [pose.T_cam_board for pose in seen(corners)]
    assert far(hand_eye(IR50P, shown, T).T_base_cam, T_BASE_CAM)[1] < 0.02
    with pytest.raises(CalibrationError, match="inverted"):
        hand_eye(IR50P, shown, [inverse_transform(one) for one in T])


@pytest.mark.parametrize("n", [5, 15, 25])
def test_single_wrong_views_are_named(n):
    """One of 15 shifts the camera by centimetres."""
    q, corners = views(25, 3, 0.1)
    shown = measured(q, seed=3)[:n]
    T = [pose.T_cam_board for pose in seen(corners)][:n]
    with pytest.raises(CalibrationError, match=r"do not belong to the others \(counted from 0\): 2;"):
        hand_eye(IR50P, shown, [*T[:2], T[3], *T[3:]])
    if n > 8:
        with pytest.raises(CalibrationError, match=r"from 0\): 1, 4;"):
            hand_eye(IR50P, shown, [T[0], T[4], T[2], T[3], T[1], *T[5:]])
        slipped = T[1].copy()
        slipped[0, 3] += 0.05
        with pytest.raises(CalibrationError, match=r"from 0\): 1;"):
            hand_eye(IR50P, shown, [T[0], slipped, *T[2:]])


def test_bad_arguments_of_the_refinement_are_refused():
    q, corners = views()
    start = hand_eye(IR50P, q, seen(corners))
    with pytest.raises(InputError, match="corners"):
        refine_hand_eye(IR50P, CAMERA, q[:-1], corners, BOARD, start)
    with pytest.raises(InputError, match="terms"):
        refine_hand_eye(IR50P, CAMERA, q, corners, BOARD, start, terms=("offset4",))
    with pytest.raises(InputError, match="finite"):
        refine_hand_eye(IR50P, CAMERA, q, corners * np.nan, BOARD, start)
    with pytest.raises(InputError, match="sigmas"):
        refine_hand_eye(IR50P, CAMERA, q, corners, BOARD, start, known_T_base_cam=(T_BASE_CAM, 0, 1))
    for name, bad in {"sigma_px": 0, "sigma_q": (0, 1, 1)}.items():
        with pytest.raises(InputError, match=name):
            refine_hand_eye(IR50P, CAMERA, q, corners, BOARD, start, **{name: bad})
    with pytest.raises(InputError, match="start = None"):
        refine_hand_eye(IR50P, CAMERA, q, corners, BOARD, None)
    with pytest.raises(InputError, match="corners must hold numbers"):
        refine_hand_eye(IR50P, CAMERA, q, [corners[0][:3], *corners[1:]], BOARD, start)
    for bad in (None, ["a"] * len(q)):
        with pytest.raises(InputError, match="T_cam_board"):
            hand_eye(IR50P, q, bad)
