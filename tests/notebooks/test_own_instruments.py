"""The cells with which a student measures a real arm and a webcam: what they keep counts for that board."""

import shutil
from pathlib import Path

import nbformat
import numpy as np
import pytest
from fake_board import FakeBoard
from notebook_runner import FOLDER

import ir50p_lab.vision
from ir50p_lab.bench import JointCalibration, SerialBench, fit_calibration, nominal_calibration
from ir50p_lab.course import my_robot, save_result
from ir50p_lab.course.at_the_bench import measure_views
from ir50p_lab.course.lab_book.results import newest_result
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import Calibration, PictureFolder, TablePlane, calibrate
from ir50p_lab.vision.rendering import CAMERA_BENCH

PICTURES = Path(__file__).parents[2] / "data/calibration"


def cell(notebook, name):
    (path,) = FOLDER.glob(f"{notebook}_*.ipynb")
    (found,) = [one for one in nbformat.read(path, as_version=4).cells if one.get("id") == name]
    return found.source


@pytest.fixture
def board(monkeypatch, tmp_path):
    """A board with an id; `connect()` finds it."""
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    board = FakeBoard(nominal_calibration(IR50P))
    board.board_id = 0x0A1B2C
    monkeypatch.setattr("ir50p_lab.bench.connect", lambda **_: opened(board))
    return board


def opened(board):
    return SerialBench(board, clock=board, arm=IR50P, record_to=False).open()


def test_calibration_of_a_real_arm(board, monkeypatch):
    """Poses in degrees and the counts that the hand reads: the line of this board, and nothing has moved."""
    monkeypatch.setattr(measure_views, "connect", lambda **_: opened(board))
    truth = nominal_calibration(IR50P)
    degrees = np.random.default_rng(0).uniform(-60, 60, (12, 3)).round()
    counts = []
    for pose in degrees:
        board.q = np.radians(pose)
        counts.append(measure_views.counts_by_hand().tolist())
        assert np.array_equal(board.q, np.radians(pose))
    lists = f"my_degrees, my_counts = {degrees.tolist()}, {counts}"
    names = {"np": np, "arm": IR50P, "views": measure_views, "visit": opened(board), "my_robot": my_robot}
    exec(cell("10", "measure-15").replace("my_degrees, my_counts = [], []", lists), names)
    angles, read = names["readings"]
    names |= {"JointCalibration": JointCalibration, "save_result": save_result}
    names["fits"] = [my_robot.fit_line(read[:, k], angles[:, k]) for k in range(3)]
    names["slopes"], names["offsets"] = np.transpose([fit[:2] for fit in names["fits"]])
    exec(cell("10", "measure-40"), names)
    assert newest_result("calibration", opened(board)) is None  # the line is the course's
    monkeypatch.setattr(my_robot, "whose", lambda name: "yours")
    exec(cell("10", "measure-40"), names)
    bench = opened(board)
    assert bench.calibration.source.startswith("yours, calibration-1")
    judged = fit_calibration(angles, read)
    for error in ("stderr_slope", "stderr_zero"):
        np.testing.assert_allclose(getattr(bench.calibration, error), getattr(judged, error), rtol=1e-6)
    off = np.abs(np.subtract(bench.calibration.slope, truth.slope))
    assert np.all(off < 0.01 * np.array(truth.slope)) and np.all(off < 4 * np.array(bench.calibration.stderr_slope))


def test_calibration_of_a_webcam(board, monkeypatch, tmp_path):
    """Photographs, one a key press, make a camera that counts for this board, and the last says where it stands."""
    pressed, folder = [], tmp_path / "seen"
    shutil.copytree(PICTURES / "flat", folder)
    shutil.copy(PICTURES / "table/board.jpg", folder / "z.jpg")
    monkeypatch.setattr("builtins.input", pressed.append)
    monkeypatch.setattr(ir50p_lab.vision, "open_camera", lambda number: PictureFolder(folder))
    lies = np.diag([1.0, -1, -1, 1])
    lies[:3, 3] = 0.32, 0.08, 0
    names = {
        "calibrate": calibrate,
        "save_result": save_result,
        "np": np,
        "TablePlane": TablePlane,
        "T_base_board": lies,
    }
    exec(cell("17", "pixel-webcam").replace("my_square = None", "my_square = 0.025"), names)
    exec(cell("17", "pixel-webcam-kept"), names)
    kept = newest_result("camera", opened(board))
    assert len(pressed) == 21 and not kept.simulated
    camera = Calibration.load(kept.path)
    assert camera.rms < 0.15
    np.testing.assert_allclose(camera.T_base_cam[:3, 3], CAMERA_BENCH, atol=3e-3)
