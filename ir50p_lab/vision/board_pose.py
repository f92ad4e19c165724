"""Where a flat board is, seen from the camera: pose from its corners, with how well it is known."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.checks import point_list, rigid
from ir50p_lab.vision.pinhole import as_pinhole

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
    ============= ======================================================================= =====================
    """

    T_cam_board: np.ndarray
    covariance: np.ndarray = field(repr=False)
    by_camera: np.ndarray = field(repr=False)
    rms: float


def board_points(pattern=(9, 6), square=0.025, T_table_board=None):
    """Inner corners of a checkerboard, row by row as the finders give them, (n, 3) m in table coordinates.

    Board coordinates: the first corner, x along a row, y along the rows, z away from the viewer, so into the table.

    Args: pattern: corners along a row, and rows; square: m; T_table_board: (4, 4) where the board lies. Default: print
    upwards, its first corner at the origin, rows along x, further rows towards -y: diag(1, -1, -1, 1). The identity
    gives the corners in board coordinates, for `board_pose` of a board in the hand.
    Raises CalibrationError for a pattern, InputError for a square that no board has.
    """
    grid = Checkerboard(pattern, square).points
    lies = np.diag([1.0, -1.0, -1.0, 1.0]) if T_table_board is None else T_table_board
    return moved(rigid("T_table_board", lies), grid)


def board_pose(camera, corners, points):
    """Pose of a flat board: IPPE for the start, then least squares of the reprojection error (Levenberg-Marquardt).

    Args:
        camera: Pinhole or Calibration.
        corners: (n, 2) px, as the finder gives them; points: (n, 3) m, the same corners in board or table
        coordinates, all in one plane. n >= 4.

    Returns: BoardPose. Raises CalibrationError if the corners fit no such board (rms above 5 px), InputError on
    wrong shapes, numbers that are not finite, fewer than 4 corners, or corners on one line.
    """
    import cv2

    camera = as_pinhole(camera)
    corners, points = point_list("corners", corners, 2), point_list("points", points, 3, "m")
    if len(corners) != len(points) or len(corners) < 4:
        raise InputError(f"{len(corners)} corners for {len(points)} points: give the same number, at least 4")
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[1] < 1e-6 * spread[0] or spread[2] > 1e-6 * spread[0]:
        raise InputError("the points must lie in one plane, but not on one line: use the whole board")
    K, distortion = camera.K, camera.distortion
    _, rvecs, tvecs, _ = cv2.solvePnPGeneric(points, corners, K, distortion, flags=cv2.SOLVEPNP_IPPE)
    tried = []
    for guess in zip(rvecs, tvecs, strict=True):
        rvec, tvec = cv2.solvePnPRefineLM(points, corners, K, distortion, *guess)
        seen, jacobian = cv2.projectPoints(points, rvec, tvec, K, distortion)
        off = corners - seen.reshape(-1, 2)
        tried.append((float(np.sqrt((off**2).sum(axis=1).mean())), rvec, tvec, off, jacobian))
    rms, rvec, tvec, off, jacobian = min(tried, key=lambda one: one[0])
    if not rms <= _WORST_RMS:
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
    )


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
