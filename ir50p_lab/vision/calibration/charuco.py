"""Corners of a ChArUco board: the markers say which corner is which, so that part of the board is enough."""

import numpy as np

from ir50p_lab.vision.calibration.corners import _SOFT, Corners
from ir50p_lab.vision.calibration.grid import apply, homography
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason

_FEWEST = 8  # corners that a view needs; six of them are spent on the pose


def find_charuco(grey, board):
    """Inner corners of a ChArUco board that can be seen, refined.

    Args: grey: (h, w) uint8; board: Charuco. Returns: Corners with their places in `board.points`.
    Raises NotUsable: no markers, markers of another board, too few corners, blurred.
    """
    import cv2

    opencv_board = board.opencv()
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.CharucoDetector(opencv_board, cv2.aruco.CharucoParameters(), parameters)
    corners, index, _, ids = detector.detectBoard(grey)
    count = 0 if index is None else len(index)
    if ids is None or len(ids) == 0:
        raise NotUsable(Reason.NO_BOARD, f"no marker of {board.dictionary} in it")
    if count < _FEWEST:
        known = np.isin(ids.ravel(), opencv_board.getIds()).mean()
        if known < 0.5 or (len(ids) > 6 and count == 0):
            raise NotUsable(Reason.WRONG_BOARD, f"{len(ids)} markers, but not where the {board} has them")
        raise NotUsable(Reason.CROPPED, f"{count} corners of the board seen, {_FEWEST} needed: show more of it")
    index, xy = index.ravel(), corners.reshape(-1, 2).astype(float)
    points = board.points[index, :2]
    side = _spacing(points, xy, board.square)
    gap = (board.square - board.marker) / 2 / board.square  # the markers' own corners must stay out of the window
    half = int(np.clip(min(0.3, gap) * side - 1, 2, 20))
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-4)
    start = np.ascontiguousarray(xy.reshape(-1, 1, 2), dtype=np.float32)
    xy = cv2.cornerSubPix(grey, start, (half, half), (-1, -1), stop)[:, 0].astype(float)
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[1] < 1.2 * board.square:
        raise NotUsable(Reason.CROPPED, f"the {count} corners seen lie on a line: show more of the board")
    rise = _rise(grey, xy, side)
    if rise > _SOFT * side:
        raise NotUsable(Reason.BLURRED, f"edges are {rise:.0f} px wide, squares {side:.0f} px: focus, hold still")
    H = homography(points, xy)
    off = np.linalg.norm(apply(H, points) - xy, axis=1)
    if np.median(off) > 0.15 * side:
        raise NotUsable(Reason.WRONG_BOARD, f"its corners are not where the {board} has them")
    return Corners(xy, index, np.nan, rise, "ChArUco")


def _spacing(points, xy, square):
    """Median side of a square, px, from the scale of the map from board to picture."""
    H = homography(points, xy)
    if H is None:
        raise NotUsable(Reason.CROPPED, "the corners seen lie on a line: show more of the board")
    sides = [np.linalg.norm(apply(H, points + step) - apply(H, points), axis=1) for step in np.eye(2) * square]
    return float(np.median(np.minimum(*sides)))


def _rise(grey, xy, side):
    """Rough width of the edges at corners, px: step of grey levels over the steepest slope, median of the corners."""
    import cv2

    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0) / 8, cv2.Sobel(grey, cv2.CV_32F, 0, 1) / 8
    slope, reach, widths = np.hypot(gx, gy), max(2, round(0.4 * side)), []
    for x, y in np.round(xy).astype(int):
        window = np.s_[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
        widths.append(float(np.ptp(grey[window])) / max(float(slope[window].max()), 1e-6))
    return 0.8 * float(np.median(widths))  # from 10 to 90 % of the step
