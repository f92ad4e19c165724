"""Where a flat board is, as seen from the camera: its pose from its corners."""

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision.arguments import point_list, rigid
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.pinhole import as_pinhole

_WORST_RMS = 5.0  # px: if corners miss the board by more, it has another size, or they are in another order


def board_points(pattern=(9, 6), square=0.025, T_table_board=None):
    """Return the inner corners of a checkerboard, row by row as the finders give them, (n, 3) m in table coordinates.

    Board coordinates: the first corner is the origin, x goes along a row, y across the rows, z away from the viewer and
    so into the table.

    Args: pattern: number of corners in a row, and of rows; square: m; T_table_board: (4, 4), where the board lies.
    Default: print upwards, its first corner at the origin, rows along x, further rows towards -y: diag(1, -1, -1, 1).
    The identity gives the corners in board coordinates, for `board_pose` of a board in the hand.
    Raises CalibrationError for a pattern, InputError for a square that no board has.
    """
    grid = Checkerboard(pattern, square).points
    lies = np.diag([1.0, -1.0, -1.0, 1.0]) if T_table_board is None else T_table_board
    return transform_points(rigid("T_table_board", lies), grid)


def board_pose(camera, corners, points):
    """Return (T_cam_board (4, 4), rms px) of a flat board.

    IPPE gives the start, least squares of the reprojection error the rest.

    camera: Pinhole or Calibration; corners: (n, 2) px; points: (n, 3) m, the same corners, all in one plane.
    Raises CalibrationError if the corners fit no such board (rms above 5 px), InputError on wrong shapes.
    """
    import cv2

    camera = as_pinhole(camera)
    corners, points = point_list("corners", corners, 2), point_list("points", points, 3, "m")
    if len(corners) != len(points) or len(corners) < 4:
        raise InputError(f"{len(corners)} corners for {len(points)} points: give the same number, at least 4")
    known = points, corners, camera.K, camera.distortion
    _, rvecs, tvecs, _ = cv2.solvePnPGeneric(*known, flags=cv2.SOLVEPNP_IPPE)
    poses = [cv2.solvePnPRefineLM(*known, *guess) for guess in zip(rvecs, tvecs, strict=True)]
    errors = [corners - cv2.projectPoints(points, *pose, *known[2:])[0][:, 0] for pose in poses]
    best = min(range(len(poses)), key=lambda k: (errors[k] ** 2).sum())
    rms, pose = np.sqrt((errors[best] ** 2).sum(axis=1).mean()), poses[best]
    if not rms <= _WORST_RMS:
        raise CalibrationError(
            f"the corners miss the board by {rms:.3g} px rms: is it a board of this pattern and square size, seen by "
            "this camera at this picture size, and are the corners in the order of the points?"
        )
    return transform(*pose), float(rms)


def transform(rvec, tvec):
    """Return the homogeneous transform (4, 4) of OpenCV's rotation vector (3,) rad and translation (3,) m."""
    import cv2

    T = np.eye(4)
    T[:3, :3], T[:3, 3] = cv2.Rodrigues(np.asarray(rvec, dtype=float))[0], np.ravel(tvec)
    return T


def inverse_transform(T):
    """Return the inverse of a rigid transform (4, 4): (R^T, -R^T t)."""
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return back


def transform_points(T, points):
    """Return points (n, 3) or (3,) under the transform T (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]
