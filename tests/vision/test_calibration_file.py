"""A calibration as a file, in place of a pinhole, and from painted pictures of another camera."""

import json
from dataclasses import replace

import cv2
import numpy as np
import pytest
from board_pictures import SIZE, corner_sets, painted_set
from refusals import refused

from ir50p_lab.course.camera.board_poses import board_poses
from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision import Calibration, Checkerboard, calibrate, calibrate_corners
from ir50p_lab.vision.pinhole import as_pinhole
from ir50p_lab.vision.rendering import bench_camera

POINTS = Checkerboard().points


@pytest.fixture(scope="module")
def calibration():
    found = calibrate_corners(POINTS, corner_sets(POINTS, 8, seed=1), SIZE)
    return replace(found, warnings=(*found.warnings, 'a "quoted" warning: 100 %'))


def test_saved_and_loaded_is_the_same_and_opencv_reads_it(calibration, tmp_path):
    path = calibration.save(tmp_path / "kamera_ä.yml")
    again = Calibration.load(path, size=SIZE)
    assert str(again) == str(calibration) and again.model == calibration.model
    for name in ("K", "distortion", "covariance", "view_rms"):
        assert np.array_equal(getattr(again, name), getattr(calibration, name))
    assert again.warnings == calibration.warnings and again.board == calibration.board
    file = cv2.FileStorage(str(calibration.save(tmp_path / "camera.yml")), cv2.FileStorage_READ)
    assert np.array_equal(file.getNode("camera_matrix").mat(), calibration.K)
    assert np.array_equal(file.getNode("distortion_coefficients").mat().ravel(), calibration.distortion)
    assert (file.getNode("image_width").real(), file.getNode("image_height").real()) == SIZE


def test_where_the_camera_stands_is_kept_too_and_files_of_before_have_none(calibration, tmp_path):
    stands = np.linalg.inv(bench_camera()[1])
    path = replace(calibration, T_base_cam=stands).save(tmp_path / "camera.yml")
    np.testing.assert_allclose(Calibration.load(path).T_base_cam, stands, atol=1e-12)
    before = json.loads(path.read_text(encoding="utf-8"))
    details = json.loads("".join(before["details"]))
    del details["T_base_cam"]
    path.write_text(json.dumps(before | {"details": [json.dumps(details)]}), encoding="utf-8")
    assert Calibration.load(path).T_base_cam is None
    details["T_base_cam"] = (2 * stands).tolist()
    path.write_text(json.dumps(before | {"details": [json.dumps(details)]}), encoding="utf-8")
    refused("damaged", Calibration.load, path, error=CalibrationError)


def test_another_size_and_what_is_no_size_are_refused(calibration, tmp_path):
    path = calibration.save(tmp_path / "camera.yml")
    said = r"640x480, not 1280x720.*calibrate it at the new one"
    refused(said, Calibration.load, path, size=(1280, 720), error=CalibrationError)
    for size in (5, ["camera.yml"], "640x480"):
        refused("size = ", Calibration.load, path, size=size)


def test_a_calibration_in_place_of_a_pinhole(calibration):
    assert np.array_equal(as_pinhole(calibration).K, calibration.K) and as_pinhole(calibration).size == SIZE
    assert np.array_equal(board_poses(calibration, 2), board_poses(calibration.pinhole, 2))
    for nothing in (None, 5, np.eye(3)):
        with pytest.raises(InputError, match="give a Pinhole") as caught:
            as_pinhole(nothing)
        assert len(str(caught.value)) < 150


def test_files_that_are_no_calibration(calibration, tmp_path):
    path = calibration.save(tmp_path / "camera.yml")
    damaged = path.read_text().replace('\\"size\\": [640', '\\"size\\": [-640')
    for text in ("", "hello", "%YAML:1.0\n---\nimage_width: 640\n", "{", "\x00\x01", damaged):
        path.write_text(text)
        refused("damaged", Calibration.load, path, error=CalibrationError)
    refused("calibrate the camera, and save", Calibration.load, tmp_path / "none.yml", error=CalibrationError)
    refused("cannot be written", calibration.save, tmp_path / "no" / "folder.yml", error=CalibrationError)


@pytest.mark.parametrize("seed", range(2))
def test_pictures_give_their_camera_back(seed):
    """Another lens than that of the other tests, JPEG; the poses are in view, all over the picture."""
    camera, _ = bench_camera()
    found = calibrate(painted_set(camera, 8, seed, jpeg=90), progress=False)
    assert len(found.views) == 8 and found.rms < 0.12
    for name in ("fx", "fy", "cx", "cy"):
        assert abs(getattr(found, name) - getattr(camera, name)) < 3.5 * found.stderr[name]


def test_a_board_too_large_for_the_picture_has_no_poses():
    refused("0 of 3 poses", board_poses, bench_camera()[0], 3, board=Checkerboard((9, 60)))


def test_points_that_were_given_are_no_checkerboard(tmp_path):
    board = np.c_[np.mgrid[:13, :12].T.reshape(-1, 2) * 0.02, np.zeros(156)]
    found = calibrate_corners(board, corner_sets(board, 8, seed=3), SIZE)
    assert "given board" in str(found) and "9x6" not in str(found) and "25 mm" not in str(found)
    assert Calibration.load(found.save(tmp_path / "given.json")).board is None
