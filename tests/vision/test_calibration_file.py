"""A calibration as a file, in numbers of its own, over the picture, and in the two notations."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from board_pictures import SIZE, corner_sets, look

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision import (
    Calibration,
    Charuco,
    Checkerboard,
    Pinhole,
    calibrate,
    calibrate_corners,
    column_camera_matrix,
    direction_stderr,
    row_camera_matrix,
    to_rows,
)
from ir50p_lab.vision.calibration.rendered import board_poses
from ir50p_lab.vision.pinhole import as_pinhole
from ir50p_lab.vision.rendering import Scene, bench_camera
from tests.support.drawn_board import Board, board_pictures
from tests.support.scene_truth import scene_truth

POINTS = Checkerboard().points


@pytest.fixture(scope="module")
def calibration():
    found = calibrate_corners(POINTS, corner_sets(POINTS, 8, seed=1), SIZE)
    return replace(found, warnings=(*found.warnings, 'a "quoted" warning: 100 %'))


def test_saved_and_loaded_is_the_same(calibration, tmp_path):
    path = calibration.save(tmp_path / "kamera_ä.yml")
    again = Calibration.load(path, size=SIZE)
    assert str(again) == str(calibration) and again.model == calibration.model
    for name in ("K", "distortion", "covariance"):
        assert np.array_equal(getattr(again, name), getattr(calibration, name))
    assert again.warnings == calibration.warnings and again.board == calibration.board
    for ours, theirs in zip(again.views, calibration.views, strict=True):
        assert np.array_equal(ours.residuals, theirs.residuals) and ours.name == theirs.name
    assert np.array_equal(again.coverage.counts, calibration.coverage.counts)


def test_opencv_reads_it(calibration, tmp_path):
    path = calibration.save(tmp_path / "camera.yml")
    file = cv2.FileStorage(str(path), cv2.FileStorage_READ)
    assert np.array_equal(file.getNode("camera_matrix").mat(), calibration.K)
    assert np.array_equal(file.getNode("distortion_coefficients").mat().ravel(), calibration.distortion)
    assert (file.getNode("image_width").real(), file.getNode("image_height").real()) == SIZE


def test_another_size_is_refused(calibration, tmp_path):
    path = calibration.save(tmp_path / "camera.yml")
    with pytest.raises(CalibrationError, match="640x480, not 1280x720"):
        Calibration.load(path, size=(1280, 720))
    with pytest.raises(CalibrationError, match="calibrate it at the new one"):
        Calibration.load(path, size=(320, 240))


@pytest.mark.parametrize("size", [5, ["camera.yml"], "640x480"])
def test_what_is_no_size(calibration, size, tmp_path):
    with pytest.raises(InputError, match="size = "):
        Calibration.load(calibration.save(tmp_path / "camera.yml"), size=size)


def test_a_calibration_in_place_of_a_pinhole(calibration):
    assert as_pinhole(calibration.pinhole).size == SIZE
    assert np.array_equal(as_pinhole(calibration).K, calibration.K)
    assert np.array_equal(board_poses(calibration, 2), board_poses(calibration.pinhole, 2))
    T = bench_camera()[1]
    assert np.array_equal(Scene(pinhole=calibration, T_cam_world=T).pinhole.K, calibration.K)
    for nothing in (None, 5, np.eye(3)):
        with pytest.raises(InputError, match="give a Pinhole") as caught:
            as_pinhole(nothing)
        assert len(str(caught.value)) < 150


@pytest.mark.parametrize(
    "text", ["", "hello", "%YAML:1.0\n---\na: 1\n", "%YAML:1.0\n---\nimage_width: 640\n", "{", "\x00\x01"]
)
def test_what_is_no_calibration(text, tmp_path):
    path = tmp_path / "camera.yml"
    path.write_text(text)
    with pytest.raises(CalibrationError):
        Calibration.load(path)


def test_files_that_cannot_be(calibration, tmp_path):
    with pytest.raises(CalibrationError, match="no file"):
        Calibration.load(tmp_path / "none.yml")
    with pytest.raises(CalibrationError, match="cannot be written"):
        calibration.save(tmp_path / "no" / "folder.yml")


def test_damaged_numbers_are_refused(calibration, tmp_path):
    path = calibration.save(tmp_path / "camera.yml")
    path.write_text(path.read_text().replace('\\"size\\": [640', '\\"size\\": [-640'))
    with pytest.raises(CalibrationError, match="damaged"):
        Calibration.load(path)


def test_coverage_counts_every_corner(calibration):
    cover = calibration.coverage
    assert cover.counts.sum() == 8 * 54 and cover.share == np.mean(cover.counts > 0) and 0.3 < cover.reach <= 1


def test_next_view_keeps_its_promise(calibration):
    """The advised picture, taken, makes the camera as sure as foretold; a copy of an old view helps less."""
    following = calibration.next_view()
    assert following.after < following.before and "take one with the board" in str(following)
    flat = POINTS.reshape(6, 9, 3)[[0, 0, -1, -1], [0, -1, -1, 0]]
    ok, rvec, tvec = cv2.solvePnP(
        flat, following.outline, calibration.K, calibration.distortion, flags=cv2.SOLVEPNP_IPPE
    )
    assert ok
    advised = cv2.projectPoints(POINTS, rvec, tvec, calibration.K, calibration.distortion)[0][:, 0]
    old = [view.corners for view in calibration.views]
    grid = np.stack(np.meshgrid((np.arange(8) + 0.5) * 80, (np.arange(6) + 0.5) * 80), axis=-1).reshape(-1, 2)

    def error(extra):
        noisy = extra + np.random.default_rng(1).normal(0, calibration.sigma, (54, 2))
        more = calibrate_corners(POINTS, [*old, noisy], SIZE, lens=calibration.model, bend=False)
        V = np.zeros((9, 9))
        scale = np.array(
            [more.stderr_corners[n] / more.stderr[n] if more.stderr[n] == more.stderr[n] else 0 for n in more.stderr]
        )
        V = more.covariance * np.outer(scale, scale) if scale.any() else V
        return np.sqrt((direction_stderr(replace(more, covariance=V), grid) ** 2).mean())

    assert abs(error(advised) / following.after - 1) < 0.25
    assert error(advised) < error(old[0])


def test_next_view_fills_empty_cells_where_it_costs_nothing(calibration):
    """Views of one half of the picture: of the poses that bring nearly the most, none fills more empty cells."""
    left = [view.corners for view in calibration.views if view.corners[:, 0].mean() < 330]
    half = calibrate_corners(POINTS, left, SIZE, lens=("k1", "k2"), bend=False)
    following = half.next_view()
    afters = [after for _, _, after, _ in following.tried]
    assert afters == sorted(afters) and following.after <= following.before - 0.9 * (following.before - afters[0])
    enough = following.before - 0.9 * (following.before - afters[0])
    assert following.new == max(new for *_, after, new in following.tried if after <= enough) > 0
    assert f"{following.new} empty cell" in str(following) and following.outline[:, 0].mean() > 320


def test_rows_and_columns_are_transposes():
    camera, T = bench_camera()
    rows, columns = row_camera_matrix(*to_rows(camera.K, T)), column_camera_matrix(camera.K, T)
    assert rows.shape == (4, 3) and np.allclose(rows, columns.T)
    X = np.array([0.4, -0.1, 0.03])
    w = np.append(X, 1) @ rows
    assert np.allclose(w[:2] / w[2], Pinhole(camera.K).project(T, X))


def test_rendered_set_gives_its_camera_back():
    """Another renderer than the painter of these tests, another lens, JPEG."""
    camera, _ = bench_camera()
    images, truth = board_pictures(camera, 7, seed=6)
    found = calibrate(images, progress=False)
    assert len(found.views) == 7
    for view in found.views:
        assert (
            np.sqrt(((view.corners - scene_truth(truth[view.index].scene).boards[0].corners) ** 2).sum(axis=1).mean())
            < 0.12
        )
    error = np.array([found.fx - camera.fx, found.fy - camera.fy, found.cx - camera.cx, found.cy - camera.cy])
    assert (np.abs(error) < 3 * np.array([found.stderr[n] for n in ("fx", "fy", "cx", "cy")])).all()


def test_charuco_set_gives_its_camera_back():
    camera, _ = bench_camera()
    printed = Board(kind="charuco")
    images, _ = board_pictures(camera, 6, seed=7, board=printed)
    found = calibrate(images, board=Charuco(printed.pattern, printed.square, printed.marker, printed.dictionary))
    assert len(found.views) == 6 and found.rms < 0.15
    assert abs(found.fx - camera.fx) < 3 * found.stderr["fx"] + 0.5


def test_poses_are_in_view_and_tilted():
    camera, _ = bench_camera()
    poses = board_poses(camera, 5, seed=3)
    assert len(poses) == 5
    for T in poses:
        xy = camera.project(T, POINTS)
        assert (xy > 0).all() and (xy < SIZE).all()
    assert np.allclose(look()[:3, :3], np.eye(3))
