"""Where a flat board is, seen from the camera: pose from its corners, with how well it is known."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError, VisionError
from ir50p_lab.inputs import first_not_finite, number, numbers, whole
from ir50p_lab.vision.pinhole import undistort_xy

_WORST_RMS = 5.0  # px; a board of another size, or corners in another order, miss by far more


@dataclass(frozen=True, eq=False)
class BoardPose:
    """Pose of a board, and its uncertainty.

    ============= ======================================================================= =====================
    T_cam_board   takes coordinates of the board to those of the camera                   (4, 4)
    covariance    of (rvec, tvec), from the scatter of the corners                        (6, 6) rad, m
    by_camera     d(rvec, tvec) / d(fx, fy, cx, cy, k1, k2, p1, p2, k3): how the pose     (6, 9)
                  follows an error of the camera's own numbers
    rms           of the distances between corners and model                              px
    residuals     seen minus model                                                        (n, 2) px
    other_rms     rms of the other pose that IPPE offers for a flat board, inf if none    px
    ============= ======================================================================= =====================

    A flat board seen from far has two poses that explain it almost alike; `other_rms` close to `rms` says so.
    """

    T_cam_board: np.ndarray
    covariance: np.ndarray = field(repr=False)
    by_camera: np.ndarray = field(repr=False)
    rms: float
    residuals: np.ndarray = field(repr=False)
    other_rms: float

    @property
    def stderr(self):
        """Standard errors of (rvec, tvec), (6,) rad and m; the camera's own numbers taken as exact."""
        return np.sqrt(np.diag(self.covariance))


def board_points(pattern=(9, 6), square=0.025, T_table_board=None):
    """Inner corners of a checkerboard, row by row as the finders give them, (n, 3) m in table coordinates.

    Board coordinates: the first corner, x along a row, y along the rows, z away from the viewer, so into the table.

    Args: pattern: corners along a row, and rows; square: m; T_table_board: (4, 4) where the board lies. Default: print
    upwards, its first corner at the origin, rows along x, further rows towards -y: diag(1, -1, -1, 1). The identity
    gives the corners in board coordinates, for `board_pose` of a board in the hand.
    Raises InputError for a pattern or a square that no board has.
    """
    try:
        columns, rows = pattern
    except (TypeError, ValueError):
        raise InputError(f"pattern = {pattern!r:.60}: give (columns, rows) of inner corners, such as (9, 6)") from None
    columns = whole("pattern, columns of inner corners", columns, 2, 100)
    rows = whole("pattern, rows of inner corners", rows, 2, 100)
    square = number("square", square, "> 0", unit="m", hint="the side of a square, such as 0.025")
    grid = np.zeros((rows * columns, 3))
    grid[:, :2] = square * np.mgrid[:columns, :rows].T.reshape(-1, 2)
    lies = np.diag([1.0, -1.0, -1.0, 1.0]) if T_table_board is None else T_table_board
    return moved(checked_transform("T_table_board", lies), grid)


def board_pose(camera, corners, points):
    """Pose of a flat board: IPPE for the start, then least squares of the reprojection error (Levenberg-Marquardt).

    Args:
        camera: Pinhole or Calibration (anything with K (3, 3) and distortion, OpenCV's order).
        corners: (n, 2) px, as the finder gives them; points: (n, 3) m, the same corners in board or table
        coordinates, all in one plane. n >= 4.

    Returns: BoardPose. Raises CalibrationError if the corners fit no such board (rms above 5 px), InputError on
    wrong shapes, numbers that are not finite, fewer than 4 corners, or corners on one line.
    """
    import cv2

    corners, points = pixels("corners", corners), _points(points)
    if len(corners) != len(points) or len(corners) < 4:
        raise InputError(f"{len(corners)} corners for {len(points)} points: give the same number, at least 4")
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[1] < 1e-6 * spread[0] or spread[2] > 1e-6 * spread[0]:
        raise InputError("the points must lie in one plane, but not on one line: use the whole board")
    K, distortion = camera_numbers(camera)
    found, rvecs, tvecs, _ = cv2.solvePnPGeneric(points, corners, K, distortion, flags=cv2.SOLVEPNP_IPPE)
    candidates = [
        cv2.solvePnPRefineLM(points, corners, K, distortion, rvec.copy(), tvec.copy())
        for rvec, tvec in zip(rvecs, tvecs, strict=True)
    ]
    if not found or not np.isfinite(candidates).all():
        raise CalibrationError("no pose explains these corners: are they all there, and in the order of the points?")
    tried = []
    for rvec, tvec in candidates:
        seen, jacobian = cv2.projectPoints(points, rvec, tvec, K, distortion)
        off = corners - seen.reshape(-1, 2)
        tried.append((float(np.sqrt((off**2).sum(axis=1).mean())), rvec, tvec, off, jacobian))
    tried.sort(key=lambda one: one[0])
    rms, rvec, tvec, off, jacobian = tried[0]
    if rms > _WORST_RMS:
        raise CalibrationError(
            f"the corners miss the board by {rms:.3g} px rms: is it a board of this pattern and square size, seen by "
            "this camera at this picture size, and are the corners in the order of the points?"
        )
    pose, own = jacobian[:, :6], jacobian[:, 6:15]
    Q, R = np.linalg.qr(pose)
    half = np.linalg.solve(R, np.eye(6))
    variance = (off**2).sum() / max(1, off.size - 6)
    return BoardPose(
        T_cam_board=transform(rvec, tvec),
        covariance=variance * half @ half.T,
        by_camera=-np.linalg.solve(R, Q.T @ own),
        rms=rms,
        residuals=off,
        other_rms=tried[1][0] if len(tried) > 1 else np.inf,
    )


def camera_numbers(camera):
    """K (3, 3) and distortion (5,) of a Pinhole or Calibration, checked; missing coefficients are zero."""
    K = np.asarray(getattr(camera, "K", None), dtype=float)
    if K.shape != (3, 3) or not np.isfinite(K).all() or K[0, 0] <= 0 or K[1, 1] <= 0:
        raise InputError(
            f"camera = {camera!r:.60}: give a Pinhole or a Calibration (with K, (3, 3) px, and distortion)"
        )
    distortion = getattr(camera, "distortion", None)
    distortion = np.zeros(0) if distortion is None else np.ravel(distortion).astype(float)
    if distortion.size > 5 or not np.isfinite(distortion).all():
        raise InputError(f"distortion = {distortion.tolist()}: give k1, k2, p1, p2, k3, or the first of them")
    return K, np.concatenate([distortion, np.zeros(5 - distortion.size)])


def undistorted(K, distortion, xy):
    """Pixels (n, 2) to coordinates on the plane one unit in front of the camera, distortion removed, (n, 2)."""
    y = (xy[:, 1] - K[1, 2]) / K[1, 1]
    x = (xy[:, 0] - K[0, 2] - K[0, 1] * y) / K[0, 0]
    found = np.column_stack(undistort_xy(distortion, x, y))
    if np.isnan(found).any():
        lost = xy[np.isnan(found).any(axis=1)][0]
        raise VisionError(
            f"no ray leads to pixel {np.round(lost, 1).tolist()} through a lens with the distortion "
            f"{distortion.tolist()}: it lies too far outside the picture, or the calibration is of another camera"
        )
    return found


def transform(rvec, tvec):
    """Homogeneous transform (4, 4) of OpenCV's rotation vector (3,) rad and translation (3,) m."""
    import cv2

    T = np.eye(4)
    T[:3, :3], T[:3, 3] = cv2.Rodrigues(np.asarray(rvec, dtype=float))[0], np.ravel(tvec)
    return T


def rvec_tvec(T):
    """Rotation vector (3,) rad and translation (3,) m of a transform (4, 4)."""
    import cv2

    return cv2.Rodrigues(T[:3, :3])[0][:, 0], T[:3, 3].copy()


def inverse_transform(T):
    """The transform back: (R^T, -R^T t)."""
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return back


def moved(T, points):
    """Points (n, 3) or (3,) under the transform T (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]


def checked_transform(name, T):
    """`T` as a (4, 4) float array; InputError unless it is a rotation and a translation."""
    T = numbers(name, T, unit="m and a rotation")
    rigid = T.shape == (4, 4) and np.isfinite(T).all() and np.array_equal(T[3], [0, 0, 0, 1])
    if not rigid or np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() > 1e-6 or np.linalg.det(T[:3, :3]) < 0:
        raise InputError(f"{name} is no rigid transform: give (4, 4) with a rotation, a translation in m and 0 0 0 1")
    return T


def pixels(name, xy):
    """`xy` as (n, 2) float array of finite pixels; (2,) counts as one."""
    try:
        array = np.ascontiguousarray(xy, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must hold pixel coordinates; got {xy!r}") from None
    if array.ndim == 3 and array.shape[1:] == (1, 2):  # as OpenCV hands them out
        array = array[:, 0]
    array = array[None] if array.ndim == 1 else array
    if array.ndim != 2 or array.shape[1] != 2:
        raise InputError(f"{name} has shape {np.shape(xy)}; give (n, 2) or (2,) pixel coordinates x, y")
    if not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}: every pixel must be finite")
    return array


def _points(points):
    array = np.ascontiguousarray(points, dtype=float)
    if array.ndim != 2 or array.shape[1] != 3 or not np.isfinite(array).all():
        raise InputError(f"points has shape {array.shape}; give (n, 3) finite numbers, m")
    return array


def check_picture_size(camera, image):
    """Raise CalibrationError if a picture is of another size than the camera was calibrated for.

    image: colour (h, w, 3) or grey (h, w); camera: Calibration or Pinhole; one without `size` takes every picture.
    """
    size, here = getattr(camera, "size", None), (image.shape[1], image.shape[0])
    if size is not None and tuple(size) != here:
        raise CalibrationError(
            f"the camera sends {here[0]}x{here[1]}, its calibration is of {size[0]}x{size[1]}: set the camera to that "
            "size, or calibrate it at this one"
        )
