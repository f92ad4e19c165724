"""A calibration as a file: JSON, with a copy of K and distortion under the names that OpenCV's own programs read."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision.arguments import check_picture_size, picture_size, rigid
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.calibration.reject_reasons import Reason, Rejected

_LONGEST = 2000  # characters: longer texts are split, for OpenCV reads no more than 4096 bytes of one


def save(calibration, path):
    """Write a Calibration. Returns the Path. Raises CalibrationError if that fails."""
    path, details = Path(path), asdict(calibration)
    text = json.dumps(details, default=np.ndarray.tolist)
    content = {
        "image_width": calibration.size[0],
        "image_height": calibration.size[1],
        "camera_matrix": _for_opencv(calibration.K),
        "distortion_coefficients": _for_opencv(calibration.distortion[:, None]),
        "details": [text[start : start + _LONGEST] for start in range(0, len(text), _LONGEST)],
    }
    try:
        path.write_text(json.dumps(content, indent=1), encoding="utf-8")
    except OSError as error:
        raise CalibrationError(f"{path} cannot be written: {error.strerror}") from None
    return path


def _for_opencv(matrix):
    rows, columns = matrix.shape
    return {"type_id": "opencv-matrix", "rows": rows, "cols": columns, "dt": "d", "data": matrix.ravel().tolist()}


def load(calibration_class, view_class, path, size=None):
    """Read what `save` wrote; see `Calibration.load`."""
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise CalibrationError(f"{path} cannot be read ({error}): calibrate the camera, and save") from None
    try:
        found = json.loads("".join(json.loads(text)["details"]))
        board = found["board"]
        changed = {
            "board": board and Checkerboard(**board | {"pattern": tuple(board["pattern"])}),
            "views": tuple(view_class(**{name: _array(one[name]) for name in one}) for one in found["views"]),
            "rejected": tuple(Rejected(**one | {"reason": Reason(one["reason"])}) for one in found["rejected"]),
        }
        tuples = {name: tuple(found[name]) for name in ("model", "warnings", "size")}
        stands = found.get("T_base_cam")  # files of before have none
        arrays = {name: _array(found[name]) for name in ("K", "distortion", "covariance")}
        arrays["T_base_cam"] = stands and rigid("T_base_cam", stands)
        calibration = calibration_class(**found | changed | tuples | arrays)
        calibration.pinhole  # noqa: B018 - refuses numbers that are no camera
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise CalibrationError(
            f"{path} is no calibration that this version saved, or damaged ({type(error).__name__}): calibrate again; "
            "a camera known from elsewhere is a Pinhole(K, distortion, size)"
        ) from None
    if size is not None:
        check_picture_size(calibration, picture_size(size))
    return calibration


def _array(value):
    return np.array(value) if isinstance(value, list) else value
