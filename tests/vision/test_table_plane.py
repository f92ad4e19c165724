"""From pixel to table: two routes, exact on exact input, bad input refused by name."""

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.errors import CalibrationError, VisionError
from ir50p_lab.vision.board_pose import board_points, board_pose, inverse_transform, transform
from ir50p_lab.vision.pinhole import Pinhole
from ir50p_lab.vision.rendering import look_at
from ir50p_lab.vision.table_plane import TablePlane

CAMERA = Pinhole([[705, 0, 322.5], [0, 702, 238.1], [0, 0, 1]], (-0.28, 0.11, 6e-4, -4e-4, -0.02))


POSE = look_at((0.95, 0.25, 0.75), (0.38, 0.0, 0.0))
PLACES = np.array([[x, y] for x in (0.25, 0.35, 0.45) for y in (-0.2, 0.0, 0.2)])
LYING = np.array([[1, 0, 0, 0.28], [0, -1, 0, 0.06], [0, 0, -1, 0], [0, 0, 0, 1.0]])


def lifted(height):
    return np.column_stack([PLACES, np.full(len(PLACES), height)])


def by_rays(plane, xy, height):
    """The lines of sight cut with the plane: places without a homography."""
    rays = plane.pinhole.rays(xy) @ plane.T_cam_table[:3, :3]
    return (plane.centre + rays * ((height - plane.centre[2]) / rays[:, 2])[:, None])[:, :2]


@pytest.mark.parametrize("height", [0.0, 0.03, -0.01])
def test_a_projected_point_comes_back(height):
    xy = CAMERA.project(POSE, lifted(height))
    plane = TablePlane(CAMERA, POSE)
    assert np.allclose(plane.to_table(xy, height), PLACES, atol=1e-12)
    assert np.allclose(plane.to_image(lifted(height)), xy, atol=1e-9)
    assert plane.to_table(xy[0], height).shape == (2,)
    assert np.allclose(plane.to_points(xy, height), lifted(height), atol=1e-12)


def test_a_random_camera_gives_the_same_on_both_routes():
    rng = np.random.default_rng(1)
    for _ in range(50):
        eye = [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.3, 1.5)]
        plane = TablePlane(CAMERA, look_at(eye, (*rng.uniform(-0.1, 0.1, 2), 0)))
        height, xy = rng.uniform(0, 0.05), rng.uniform((200, 150), (440, 330), (20, 2))
        assert np.allclose(plane.to_table(xy, height), by_rays(plane, xy, height), atol=1e-12)


def test_the_homography_is_the_thesis_formula_with_the_third_row_dropped():
    T, K = POSE, CAMERA.K
    R_t = np.vstack([T[:3, :3].T, T[:3, 3]])  # [R; t] in the row notation of (3.7)
    assert np.linalg.matrix_rank(R_t @ K.T) == 3
    assert (R_t @ K.T).shape == (4, 3)  # no inverse
    H = TablePlane(Pinhole(K), T).homography()
    assert np.allclose((K @ H).T, np.delete(R_t, 2, axis=0) @ K.T)


# ---- the pose of a board


def test_the_board_gives_the_pose_back():
    points = board_points(T_table_board=LYING)
    corners = CAMERA.project(POSE, points)
    T, rms = board_pose(CAMERA, corners, points)
    assert np.allclose(T, POSE, atol=1e-7)
    assert rms < 1e-5
    noisy = corners + np.random.default_rng(3).normal(0, 0.3, corners.shape)
    T, rms = board_pose(CAMERA, noisy, points)
    assert np.linalg.norm(inverse_transform(T)[:3, 3] - inverse_transform(POSE)[:3, 3]) < 0.005
    assert 0.3 < rms < 0.5


def test_transforms_invert():
    T = transform([0.3, -0.2, 0.5], [1, 2, 3])
    assert np.allclose(inverse_transform(T) @ T, np.eye(4))


# ---- bad input


def test_corners_of_another_board_are_refused():
    points = board_points(T_table_board=LYING)
    corners = CAMERA.project(POSE, points)
    place, other = TablePlane.from_board, board_points((6, 9), T_table_board=LYING)
    refused("pattern and square size", place, CAMERA, corners, other, error=CalibrationError)
    refused("below the table", place, CAMERA, corners, points * [1, -1, 1])  # next rows towards +y: a mirror image
    refused("same number", place, CAMERA, corners[:-1], points)


def test_pixels_that_look_past_the_table_are_refused():
    plane = TablePlane(CAMERA, look_at((-0.5, 0, 0.5), (5.0, 0, 0.4)))
    refused("horizon", plane.to_table, (320, 100), error=VisionError)
    refused("no ray", plane.to_table, (1e4, 300))


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"T_cam_table": np.eye(3)}, "rigid"),
        ({"T_cam_table": np.diag([1, 1, 2, 1])}, "rigid"),
        ({"T_cam_table": POSE @ np.diag([1.0, -1, -1, 1])}, "below the table"),
        ({"camera": np.eye(3)}, "Pinhole"),
    ],
)
def test_a_plane_of_bad_numbers_is_refused(change, match):
    good = {"camera": CAMERA, "T_cam_table": POSE}
    refused(match, TablePlane, **good | change)


@pytest.mark.parametrize(
    ("xy", "options", "match"),
    [
        ([np.nan, 1], {}, "finite"),
        ([1, 2, 3], {}, "shape"),
        ("red", {}, "px"),
        ([1, 2], {"height": np.nan}, "height"),
    ],
)
def test_bad_pixels_are_refused(xy, options, match):
    refused(match, TablePlane(CAMERA, POSE).to_table, xy, **options)


def test_a_picture_of_another_size_than_the_calibration_is_refused():
    small = np.zeros((240, 320, 3), np.uint8)
    refused("640x480, not 320x240", TablePlane.from_picture, CAMERA, small, error=CalibrationError)
    scaled = CAMERA.scaled((320, 240))  # of the right size, without a board
    refused("not found", TablePlane.from_picture, scaled, small, error=CalibrationError)
