"""A part of a checkerboard from its saddles: where a finder of whole boards sees nothing, as at the picture's edge."""

import numpy as np

from ir50p_lab.vision.calibration.grid import apply, homography, is_checkerboard, spacing

_MOST = 600  # saddles looked at, the steepest ones
_TRIED = 150  # of them, as the middle of a part
_NEAR = 60  # saddles around the middle, among which the others are
_SMALLEST = 7  # px, side of a square; below, saddles of noise make squares, too


def parts_by_saddles(grey):
    """3x3 corners (3, 3, 2) of checkerboards in a picture, to a pixel, the steepest first: a generator.

    Where four squares meet the grey levels form a saddle, high along one diagonal and low along the other. From a
    corner to the next the two change places: next to it lie four of the other kind, and four of its own diagonally.
    """
    xy, high = _saddles(grey)
    for k in range(min(_TRIED, len(xy))):
        grid = _around(k, xy, high)
        if grid is not None and _is_flat(grid) and is_checkerboard(grid, grey):
            yield grid


def _is_flat(grid):
    """Whether 3x3 corners lie as a plane's do, to a pixel and some, and the squares are no mere noise."""
    plane, xy, side = np.argwhere(np.ones((3, 3)))[:, ::-1].astype(float), grid.reshape(9, 2), spacing(grid).min()
    H = homography(plane, xy)
    return H is not None and side >= _SMALLEST and np.abs(apply(H, plane) - xy).max() < 1 + 0.08 * side


def _saddles(grey):
    """Saddles (n, 2) px, steepest first, and the direction (n,) rad in which each is high, modulo pi."""
    import cv2

    smooth = cv2.GaussianBlur(grey, (0, 0), 1.5).astype(np.float32)
    xx, yy, xy = (cv2.Sobel(smooth, cv2.CV_32F, *order, ksize=5) for order in ((2, 0), (0, 2), (1, 1)))
    steep = xy**2 - xx * yy  # minus the determinant of the second derivatives
    peaks = (steep == cv2.dilate(steep, np.ones((7, 7), np.uint8))) & (steep > 0.02 * steep.max())
    y, x = np.nonzero(peaks)
    first = np.argsort(-steep[y, x])[:_MOST]
    y, x = y[first], x[first]
    high = np.arctan2(2 * xy[y, x], xx[y, x] - yy[y, x]) / 2 + np.pi / 2
    return np.column_stack([x, y]).astype(float), high


def _around(k, xy, high):
    """The 3x3 saddles around saddle k, alternately high one way and the other, as a grid (3, 3, 2); or None."""
    away = xy - xy[k]
    nearest = np.argsort(np.hypot(*away.T))[:_NEAR]
    away, other = away[nearest], np.cos(2 * (high[nearest] - high[k])) < 0
    near = away[1:25][other[1:25]]
    if not len(near):
        return None
    u, lengths = near[0], np.hypot(*near.T)
    across = near[np.abs(near @ u) < 0.85 * lengths[0] * lengths]
    if not len(across):
        return None
    v = across[0]
    steps = np.array([[j * v + i * u for i in (-1, 0, 1)] for j in (-1, 0, 1)]).reshape(9, 2)
    off = np.hypot(*(away - steps[:, None]).transpose(2, 0, 1))
    off[(np.arange(9) % 2 == 0)[:, None] == other] = np.inf  # corners and middle: of its own kind
    found = off.argmin(axis=1)
    if off.min(axis=1).max() > 0.35 * min(np.hypot(*u), np.hypot(*v)) or len(set(found)) < 9:
        return None
    return xy[nearest[found]].reshape(3, 3, 2)
