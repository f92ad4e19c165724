"""Corners of a ChArUco board: the markers say which corner is which, so that part of the board is enough."""

import numpy as np

from ir50p_lab.vision.calibration.corners import SOFT_SLOPE, BoardCorners, slope_rise
from ir50p_lab.vision.calibration.grid import apply, homography
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason

_FEWEST = 8  # corners that a view needs; six of them are spent on the pose
_OTHER = "swap columns and rows, count inner corners (one less than squares each way), or try legacy=True"
_UNREAD = (
    "focus, hold still, come nearer, switch the mirroring of the camera off, or name the dictionary that was printed"
)


def find_charuco(grey, board):
    """Inner corners of a ChArUco board that can be seen, refined.

    Args: grey: (h, w) uint8; board: Charuco. Returns: Corners with their places in `board.points`.
    Raises NotUsable: no markers, markers of another board, too few corners, blurred.
    """
    import cv2

    corners, index, ids = _detect(grey, board)
    count = len(index)
    if len(ids) == 0:
        raise NotUsable(Reason.NO_BOARD, f"no marker of {board.dictionary} in it: {_UNREAD}")
    if count < _FEWEST:
        known = np.isin(ids, board.opencv().getIds()).mean()
        if known < 0.5 or (len(ids) > 6 and count == 0):
            raise NotUsable(Reason.WRONG_BOARD, f"{len(ids)} markers, but not where this board has them: {_OTHER}")
        raise NotUsable(
            Reason.CROPPED, f"{count} corners of the board seen, {_FEWEST} needed: show more of it, or focus"
        )
    points = board.points[index, :2]
    H = homography(points, corners)
    if H is None or np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[1] < 1.2 * board.square:
        raise NotUsable(Reason.CROPPED, f"the {count} corners seen lie on a line: show more of the board")
    steps = [apply(H, points + step) - apply(H, points) for step in np.eye(2) * board.square]
    side = float(np.median(np.linalg.norm(steps, axis=2).min(axis=0)))
    gap = (board.square - board.marker) / 2 / board.square  # the markers' own corners must stay out of the window
    half = int(np.clip(min(0.3, gap) * side - 1, 2, 20))
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-4)
    start = np.ascontiguousarray(corners.reshape(-1, 1, 2), dtype=np.float32)
    xy = cv2.cornerSubPix(grey, start, (half, half), (-1, -1), stop)[:, 0].astype(float)
    rise = slope_rise(grey, xy, side)
    if rise > SOFT_SLOPE * side:
        raise NotUsable(Reason.BLURRED, f"edges are {rise:.0f} px wide, squares {side:.0f} px: focus, hold still")
    H = homography(points, xy)
    if H is None or np.median(np.linalg.norm(apply(H, points) - xy, axis=1)) > 0.15 * side:
        raise NotUsable(Reason.WRONG_BOARD, f"its corners are not where this board has them: {_OTHER}")
    return BoardCorners(xy, index)


def _detect(grey, board):
    """Corners (n, 2) px, their numbers (n,), and the numbers (m,) of the markers seen."""
    import cv2

    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.CharucoDetector(board.opencv(), cv2.aruco.CharucoParameters(), parameters)
    corners, index, _, ids = detector.detectBoard(grey)
    xy = np.empty((0, 2)) if corners is None else corners.reshape(-1, 2).astype(float)
    return xy, *(np.empty(0, dtype=int) if one is None else one.ravel() for one in (index, ids))
