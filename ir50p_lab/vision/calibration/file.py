"""A calibration as a file: YAML that cv2.FileStorage reads, with the names that OpenCV's own sample uses."""

import re
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision.calibration.board import Charuco, Checkerboard
from ir50p_lab.vision.calibration.fit import NAMES
from ir50p_lab.vision.calibration.reasons import Reason, Rejected
from ir50p_lab.vision.calibration.result import Calibration, View

_DEEPEST = 1000  # lists within lists: a calibration has five


def _checked(path):
    """A Path. Raises InputError for what names no file."""
    if not isinstance(path, (str, Path)):
        raise InputError(f"path = {path!r:.60}: give the name of a file, such as 'camera.yml'")
    return Path(path)


def save(calibration, path):
    """Write a Calibration as YAML (or XML or JSON, by the ending). Returns the Path.

    Raises CalibrationError if the file cannot be written.
    """
    import cv2

    path = _checked(path)
    # written in memory: OpenCV does not open paths with letters beyond ASCII everywhere, and says nothing
    file = cv2.FileStorage(path.suffix.lower() or ".yml", cv2.FileStorage_WRITE | cv2.FileStorage_MEMORY)
    width, height = calibration.size
    file.writeComment(
        "camera calibration of the IR50P lab book; lengths in metres, angles in radians, pixel (0, 0) "
        "is the centre of the top left one"
    )
    for name, value in (
        ("image_width", width),
        ("image_height", height),
        ("camera_matrix", calibration.K),
        ("distortion_coefficients", calibration.distortion.reshape(-1, 1)),
        ("avg_reprojection_error", calibration.rms),
        ("corner_sigma", calibration.sigma),
        ("covariance_fx_fy_cx_cy_k1_k2_p1_p2_k3", calibration.covariance),
        ("board_width", calibration.board.pattern[0]),
        ("board_height", calibration.board.pattern[1]),
        ("square_size", calibration.board.square),
    ):
        file.write(name, value)
    if isinstance(calibration.board, Charuco):
        file.write("marker_size", calibration.board.marker)
        file.write("dictionary", calibration.board.dictionary)
        file.write("legacy", int(calibration.board.legacy))
    if calibration.sag is not None:
        file.write("board_sag", calibration.sag)
    for kind in ("stderr", "stderr_corners", "stderr_views"):
        numbers = getattr(calibration, kind)
        if numbers:
            file.write(kind, np.array([numbers[name] if numbers[name] == numbers[name] else -1.0 for name in NAMES]))
    _texts(file, "model", calibration.model)
    _texts(file, "warnings", calibration.warnings)
    file.startWriteStruct("views", cv2.FileNode_SEQ)
    for view in calibration.views:
        file.startWriteStruct("", cv2.FileNode_MAP)
        for name in ("name", "index", "finder", "rise", "T_cam_board", "points", "corners", "residuals"):
            value = getattr(view, name)
            file.write(name, -1.0 if isinstance(value, float) and value != value else value)
        file.endWriteStruct()
    file.endWriteStruct()
    file.startWriteStruct("rejected", cv2.FileNode_SEQ)
    for one in calibration.rejected:
        file.startWriteStruct("", cv2.FileNode_MAP)
        for name, value in (
            ("name", one.name),
            ("index", one.index),
            ("reason", one.reason.name),
            ("detail", one.detail),
        ):
            file.write(name, value)
        file.endWriteStruct()
    file.endWriteStruct()
    text = file.releaseAndGetString()
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CalibrationError(f"{path} cannot be written: {error.strerror}") from None
    return path


def load(path, size=None):
    """Read a Calibration from a file of `save`, or of a program that uses OpenCV's names; see Calibration.load."""
    import cv2

    path = _checked(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise CalibrationError(f"there is no file {path}: calibrate the camera first, and save") from None
    except (OSError, UnicodeDecodeError) as error:
        raise CalibrationError(f"{path} cannot be read: {error}") from None
    if not text.lstrip().startswith(("%YAML", "<?xml", "{")):  # as ROS writes camera_info; OpenCV wants a first line
        text = "%YAML:1.0\n---\n" + text
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
        calibration = Calibration(**values, **_details(file))
        calibration.pinhole  # noqa: B018 - refuses numbers that are no camera
    except (ValueError, KeyError, AttributeError, cv2.error) as error:
        raise CalibrationError(f"{path} is a damaged calibration: {error}") from None
    if size is not None:
        calibration.check_size(size)
    return calibration


def _too_deep(text):
    """Whether brackets, XML elements or the dashes of YAML are nested so deeply that OpenCV would crash the process."""
    depth = 0
    for opening in re.finditer(rf"[\[{{]|<\w|(?:-\s+){{{_DEEPEST}}}|([\]}}]|</|/>)", text):
        depth += -1 if opening[1] else _DEEPEST if opening[0][0] == "-" else 1
        if depth >= _DEEPEST:
            return True
    return False


def _texts(file, name, texts):
    import cv2

    file.startWriteStruct(name, cv2.FileNode_SEQ)
    for text in texts:
        file.write("", text)
    file.endWriteStruct()


def _basics(file):
    """K, distortion, rms and size, or None if the file lacks them."""
    lens = file.getNode("distortion_model").string()
    if file.getNode("fisheye_model").real() or lens in ("equidistant", "fisheye"):
        raise CalibrationError(
            "a calibration with a fisheye lens (fisheye_model, or distortion_model equidistant): this package knows "
            "pinholes with k1, k2, p1, p2, k3 only. Calibrate the camera here, with the board where the lens bends less"
        )
    K, d = (_matrix(file.getNode(name)) for name in ("camera_matrix", "distortion_coefficients"))
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


def _matrix(node):
    """A matrix as OpenCV writes it, or as ROS does: rows, cols and data, without saying that it is one."""
    data = node.getNode("data") if node.isMap() else None
    if data is None or not data.isSeq() or node.getNode("dt").isString():
        return node.mat()
    shape = [int(node.getNode(name).real()) for name in ("rows", "cols")]
    numbers = np.array([data.at(i).real() for i in range(data.size())])
    return numbers.reshape(shape) if numbers.size == np.prod(shape) else None


def _details(file):
    """What only files of this package hold; what is missing is left to the defaults."""
    found = {"stderr": dict.fromkeys(NAMES, float("nan"))}
    pattern = [int(file.getNode(name).real()) for name in ("board_width", "board_height")]
    square = file.getNode("square_size").real()
    if min(pattern) >= 2 and max(pattern) >= 3 and square > 0:
        marker = file.getNode("marker_size")
        if marker.empty():
            found["board"] = Checkerboard(tuple(pattern), square)
        else:
            legacy = bool(file.getNode("legacy").real())
            found["board"] = Charuco(tuple(pattern), square, marker.real(), file.getNode("dictionary").string(), legacy)
    for name in ("stderr", "stderr_corners", "stderr_views"):
        node = file.getNode(name)
        if not node.empty():
            numbers = node.mat().ravel()
            found[name] = {n: float(x) if x >= 0 else float("nan") for n, x in zip(NAMES, numbers, strict=True)}
    node = file.getNode("covariance_fx_fy_cx_cy_k1_k2_p1_p2_k3")
    known = not node.empty()
    if known:
        found["covariance"] = node.mat()
    if not (node := file.getNode("corner_sigma")).empty():
        found["sigma"] = node.real()
    if not (node := file.getNode("board_sag")).empty():
        found["sag"] = node.mat().ravel()
    for name in ("model", "warnings"):
        node = file.getNode(name)
        found[name] = tuple(node.at(i).string() for i in range(node.size())) if node.isSeq() else ()
    if not known:
        found["warnings"] += (
            "the file holds no standard errors: how sure the camera is, is not known, and what is computed from it "
            "leaves that out",
        )
    found["views"] = tuple(_view(node) for node in _items(file.getNode("views")))
    found["rejected"] = tuple(_rejected(node) for node in _items(file.getNode("rejected")))
    return found


def _items(node):
    return [node.at(i) for i in range(node.size())] if node.isSeq() else []


def _view(node):
    rise = node.getNode("rise").real()
    return View(
        name=node.getNode("name").string(),
        index=int(node.getNode("index").real()),
        finder=node.getNode("finder").string(),
        rise=rise if rise >= 0 else float("nan"),
        **{name: node.getNode(name).mat() for name in ("points", "corners", "residuals", "T_cam_board")},
    )


def _rejected(node):
    reason = Reason[node.getNode("reason").string()]
    return Rejected(
        node.getNode("name").string(), int(node.getNode("index").real()), reason, node.getNode("detail").string()
    )
