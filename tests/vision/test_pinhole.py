"""The pinhole camera: our formula against OpenCV's, back and forth, refusals."""

import cv2
import numpy as np
import pytest
from refusals import refused

from ir50p_lab.errors import CalibrationError, ImageError
from ir50p_lab.vision import Pinhole
from ir50p_lab.vision.arguments import rigid
from ir50p_lab.vision.rendering import look_at, pose

LENSES = [(), (-0.25, 0.09), (-0.12, 0.08, 0.001, -0.0006), (0.1, -0.2, -0.001, 0.002, 0.05), (-0.3, 0.1, 0, 0, -0.01)]
K = np.array([[702.0, 0, 323.5], [0, 699.0, 236.0], [0, 0, 1]])


@pytest.mark.parametrize("lens", LENSES)
def test_projection_agrees_with_opencv(lens):
    rng = np.random.default_rng(1)
    camera, T = Pinhole(K, lens), look_at((0.9, -0.1, 0.6), (0.4, 0.05, 0.0))
    X = rng.uniform((0.1, -0.3, 0.0), (0.6, 0.3, 0.1), (50, 3))
    theirs, _ = cv2.projectPoints(X, cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], K, camera.distortion)
    assert np.abs(camera.project(T, X) - theirs[:, 0]).max() < 1e-9
    assert camera.project(T, X[0]) == pytest.approx(theirs[0, 0])


@pytest.mark.parametrize("lens", LENSES)
def test_undistorted_points_come_back(lens):
    camera = Pinhole(K, lens)
    xy = np.random.default_rng(2).uniform((-0.5, -0.5), (639.5, 479.5), (200, 2))
    flat = camera.undistort_points(xy)
    assert np.abs(camera.to_pixels(camera.distort(flat)) - xy).max() < 1e-9
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-14)
    theirs = cv2.undistortPointsIter(xy[:, None], K, camera.distortion, None, None, criteria)[:, 0]
    assert np.abs(flat - theirs).max() < 1e-8


def test_a_straightened_picture_shows_what_a_lens_that_does_not_bend_shows():
    bends, T = Pinhole(K, LENSES[4]), np.eye(4)
    places = np.array([[x, y, 1.0] for x in (-0.3, 0.0, 0.3) for y in (-0.2, 0.0, 0.2)])
    picture = np.zeros((480, 640, 3), np.uint8)
    for x, y in bends.project(T, places):
        cv2.circle(picture, (round(x), round(y)), 4, (255, 255, 255), -1)
    straight = bends.straighten(picture)[:, :, 0]
    for x, y in Pinhole(K).project(T, places).round().astype(int):
        rows, columns = np.nonzero(straight[y - 12 : y + 13, x - 12 : x + 13] > 127)
        assert np.hypot(rows.mean() - 12, columns.mean() - 12) < 1.5
    refused("640x480, not 320x240", bends.straighten, picture[::2, ::2], error=CalibrationError)
    refused("", bends.straighten, picture[:, :, 0], error=ImageError)


def test_rays_point_at_what_is_projected():
    camera, T = Pinhole(K, LENSES[2]), look_at((1.0, 0.05, 0.62), (0.4, 0, 0))
    X = np.array([[0.4, 0.1, 0.03], [0.3, -0.2, 0.0]])
    rays = camera.rays(camera.project(T, X))
    X_cam = X @ T[:3, :3].T + T[:3, 3]
    assert np.linalg.norm(rays, axis=1) == pytest.approx(1)
    assert np.abs(np.cross(rays, X_cam)).max() < 1e-12


def test_the_middle_of_a_simple_camera_is_the_middle_of_the_picture():
    camera = Pinhole.simple(500, (640, 480))
    assert camera.project(np.eye(4), (0, 0, 2.0)) == pytest.approx((319.5, 239.5))
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (500, 500, 319.5, 239.5)


def test_scaled_picture_keeps_the_field_of_view():
    camera = Pinhole(K, LENSES[2])
    large = camera.scaled((1280, 960))
    corners = np.array([[-0.5, -0.5], [639.5, 479.5]])
    assert large.undistort_points(corners * 2 + 0.5) == pytest.approx(camera.undistort_points(corners))
    wide = camera.scaled((1920, 1080))  # rows cut at top and bottom alike
    assert wide.undistort_points([959.5, 539.5]) == pytest.approx(camera.undistort_points([319.5, 239.5]))


def test_look_at_puts_the_target_on_the_axis_and_up_upwards():
    T = look_at((1.0, 0.2, 0.5), (0.4, 0.0, 0.0))
    assert (T @ (0.4, 0, 0, 1))[:2] == pytest.approx(0, abs=1e-12)
    assert (T @ (0.4, 0, 0.1, 1))[1] < 0  # y points down
    assert T[:3, :3] @ T[:3, :3].T == pytest.approx(np.eye(3)) and np.linalg.det(T[:3, :3]) == pytest.approx(1)
    assert (T @ (1.0, 0.2, 0.5, 1))[:3] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Pinhole(np.eye(2)), "3x3"),
        (lambda: Pinhole("K"), "numbers"),
        (lambda: Pinhole(K.T), r"K\.T"),
        (lambda: Pinhole(np.diag([-1.0, 1, 1])), "fx, fy > 0"),
        (lambda: Pinhole(K * np.nan), "finite"),
        (lambda: Pinhole(K, (1, 2, 3)), "k1, k2"),
        (lambda: Pinhole(K, (np.inf, 0)), "inf"),
        (lambda: Pinhole(K, "barrel"), "k1"),
        (lambda: Pinhole(K, (), (640,)), "width, height"),
        (lambda: Pinhole(K, (), (640.5, 480)), "whole pixels"),
        (lambda: Pinhole(K, (), (0, 480)), "at least 1"),
        (lambda: Pinhole(K).project(np.eye(4), (0, 0, -1)), "behind the camera"),
        (lambda: Pinhole(K).project(np.eye(3), (0, 0, 1)), "rigid"),
        (lambda: Pinhole(K).project(pose((0, 0, 1)).T, (0, 0, 1)), "rigid"),
        (lambda: Pinhole(K).project(np.eye(4), (0, 1)), "shape"),
        (lambda: Pinhole(K).project(np.eye(4), (0, np.nan, 1)), "finite"),
        (lambda: Pinhole(K).undistort_points([[1, 2, 3]]), "shape"),
        (lambda: Pinhole(K, (-0.4, 0)).undistort_points((4000, 3000)), "sends no ray"),
    ],
)
def test_refusals(make, words):
    refused(words, make)


def test_frozen():
    with pytest.raises(ValueError, match="read-only"):
        Pinhole(K).K[0, 0] = 1


def test_a_transform_that_was_computed_is_rigid():
    T = look_at((0.9, -0.1, 0.6), (0.4, 0.05, 0.0))
    T[3] += [1e-17, -2e-16, 0, 2e-16]  # as an inverse rounds on some processors
    assert rigid("T_base_cam", T) is not None
    bent = T + np.diag([0, 0, 0, 1e-3])
    refused("not a rigid transform", rigid, "T_base_cam", bent)
