"""A calibration as a file: YAML that cv2.FileStorage reads, with the names that OpenCV's own sample uses."""

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision.calibration.board import Charuco, Checkerboard
from ir50p_lab.vision.calibration.fit import NAMES
from ir50p_lab.vision.calibration.reasons import Reason, Rejected
from ir50p_lab.vision.calibration.view import View
from ir50p_lab.vision.checks import check_picture_size, picture_size

_DEEPEST = 1000  # lists within lists: a calibration has five
_LONGEST = 2000  # characters of one text in such a file: OpenCV takes 4096 bytes
_BASICS = ("K", "distortion", "rms", "size", "evidence")  # under OpenCV's names; evidence is not kept


def save(calibration, path):
    """Write a Calibration as YAML (or XML or JSON, by the ending). Returns the Path.

    Raises CalibrationError if the file cannot be written.
    """
    import cv2

    path = Path(path)
    # written in memory: OpenCV does not open paths with letters beyond ASCII everywhere, and says nothing
    file = cv2.FileStorage(path.suffix.lower() or ".yml", cv2.FileStorage_WRITE | cv2.FileStorage_MEMORY)
    file.writeComment(
        "camera calibration of the IR50P lab book: m, rad; pixel (0, 0) is the centre of the top left one"
    )
    file.write("image_width", calibration.size[0])
    file.write("image_height", calibration.size[1])
    file.write("camera_matrix", calibration.K)
    file.write("distortion_coefficients", calibration.distortion.reshape(-1, 1))
    file.write("avg_reprojection_error", calibration.rms)
    file.write("board_width", calibration.board.pattern[0])
    file.write("board_height", calibration.board.pattern[1])
    file.write("square_size", calibration.board.square)
    details = {name: value for name, value in asdict(calibration).items() if name not in _BASICS}
    text = json.dumps(details, default=np.ndarray.tolist)
    file.startWriteStruct("details", cv2.FileNode_SEQ)
    for start in range(0, len(text), _LONGEST):
        file.write("", text[start : start + _LONGEST])
    file.endWriteStruct()
    text = file.releaseAndGetString()
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CalibrationError(f"{path} cannot be written: {error.strerror}") from None
    return path


def load(cls, path, size=None):
    """Read a Calibration, of class `cls`, as `save` or a program with OpenCV's names wrote it; see Calibration.load."""
    import cv2

    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise CalibrationError(f"there is no file {path}: calibrate the camera first, and save") from None
    except (OSError, UnicodeDecodeError) as error:
        raise CalibrationError(f"{path} cannot be read: {error}") from None
    if _too_deep(text):
        raise CalibrationError(f"{path} is no calibration: it holds {_DEEPEST} lists within lists")
    try:
        file = cv2.FileStorage(text, cv2.FileStorage_READ | cv2.FileStorage_MEMORY)
        values = _basics(file)
    except (cv2.error, SystemError):
        values = None
    if values is None:
        raise CalibrationError(
            f"{path} is no calibration: it needs image_width, image_height, camera_matrix and distortion_coefficients"
        )
    try:
        calibration = cls(**values, **_details(file))
        calibration.pinhole  # noqa: B018 - refuses numbers that are no camera
    except (ValueError, KeyError, AttributeError, cv2.error) as error:
        raise CalibrationError(f"{path} is a damaged calibration: {error}") from None
    if size is not None:
        check_picture_size(calibration, picture_size(size))
    return calibration


def _too_deep(text):
    """Whether brackets, XML elements or the dashes of YAML are nested so deeply that OpenCV would crash the process."""
    depth = 0
    for opening in re.finditer(rf"[\[{{]|<\w|(?:-\s+){{{_DEEPEST}}}|([\]}}]|</|/>)", text):
        depth += -1 if opening[1] else _DEEPEST if opening[0][0] == "-" else 1
        if depth >= _DEEPEST:
            return True
    return False


def _basics(file):
    """K, distortion, rms and size, or None if the file lacks them."""
    if file.getNode("fisheye_model").real():
        raise CalibrationError(
            "a calibration with a fisheye lens (fisheye_model): this package knows pinholes with k1, k2, p1, p2, k3 "
            "only. Calibrate the camera here, with the board where the lens bends less"
        )
    K, d = (file.getNode(name).mat() for name in ("camera_matrix", "distortion_coefficients"))
    width, height = file.getNode("image_width").real(), file.getNode("image_height").real()
    if K is None or d is None or K.shape != (3, 3) or not width or not height:
        return None
    d = np.asarray(d, dtype=float).ravel()
    if len(d) > 5 and d[5:].any():
        raise CalibrationError(f"{len(d)} distortion coefficients: this package knows k1, k2, p1, p2, k3")
    rms = file.getNode("avg_reprojection_error")
    return {
        "K": np.asarray(K, dtype=float),
        "distortion": np.concatenate([d[:5], np.zeros(max(0, 5 - len(d)))]),
        "rms": float("nan") if rms.empty() else rms.real(),
        "size": (int(width), int(height)),
    }


def _details(file):
    """What only files of this package hold; what is missing is left to the defaults."""
    node = file.getNode("details")
    if not node.isSeq():
        unknown = "the file holds no standard errors: how sure the camera is, is not known, and what is computed from "
        return {"stderr": dict.fromkeys(NAMES, float("nan")), "warnings": (f"{unknown}it leaves that out",)}
    found = json.loads("".join(node.at(i).string() for i in range(node.size())))
    board = found["board"] | {"pattern": tuple(found["board"]["pattern"])}
    return found | {
        "covariance": np.array(found["covariance"], dtype=float),
        "sag": None if found["sag"] is None else np.array(found["sag"]),
        "model": tuple(found["model"]),
        "warnings": tuple(found["warnings"]),
        "board": Charuco(**board) if "marker" in board else Checkerboard(**board),
        "views": tuple(View(**{name: _array(value) for name, value in one.items()}) for one in found["views"]),
        "rejected": tuple(Rejected(**one | {"reason": Reason(one["reason"])}) for one in found["rejected"]),
    }


def _array(value):
    return np.array(value) if isinstance(value, list) else value
