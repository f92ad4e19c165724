"""Corners of a checkerboard in a picture, by OpenCV's sector-based finder, or the reason why there are none to use."""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.vision.calibration.reasons import NotUsable, Reason

_SEARCHED = 1280  # px; corners are searched in a picture reduced to this, and refined in the picture itself


@dataclass(frozen=True, eq=False)
class BoardCorners:
    """Corners found in one picture: xy (n, 2) pixels; index (n,), places in `board.points`."""

    xy: np.ndarray
    index: np.ndarray


def find_checkerboard(grey, pattern):
    """All inner corners, in the order of `Checkerboard`: BoardCorners. Raises NotUsable with the Reason."""
    columns, rows = pattern
    factor = max(1.0, max(grey.shape) / _SEARCHED)
    small = cv2.resize(grey, None, fx=1 / factor, fy=1 / factor, interpolation=cv2.INTER_AREA)
    flags = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_LARGER
    ok, xy, meta = cv2.findChessboardCornersSBWithMeta(small, pattern, flags)
    shape = meta.shape if ok else (rows, columns)
    if not ok:
        ok, xy = cv2.findChessboardCorners(cv2.GaussianBlur(small, (0, 0), 0.8), pattern)
    if not ok:
        ok, xy, meta = cv2.findChessboardCornersSBWithMeta(small, (3, 3), flags)
        if not ok:
            raise NotUsable(Reason.NO_BOARD, "nothing like a checkerboard: more light, less glare, the whole board in view")
        shape = meta.shape
    grid = (xy.reshape(*shape, 2).astype(float) + 0.5) * factor - 0.5
    side = min(np.linalg.norm(np.diff(grid, axis=k), axis=2).min() for k in (0, 1))
    sharp = max(cv2.estimateChessboardSharpness(grey, grid.shape[1::-1], np.float32(grid.reshape(-1, 1, 2)), vertical=v)[0][0] for v in (False, True))
    if sharp < 100 and sharp > 0.55 * side:
        raise NotUsable(Reason.BLURRED, f"edges are {sharp:.1f} px wide, squares only {side:.0f} px: focus, hold still")
    if sorted(grid.shape[:2]) != sorted((rows, columns)):
        n, m = sorted(grid.shape[:2])
        seen = (m, n) if columns >= rows else (n, m)
        low, high = grid.min(axis=(0, 1)), np.array(grey.shape[::-1]) - grid.max(axis=(0, 1))
        if m <= max(pattern) and n <= min(pattern) and min(*low, *high) < 1.3 * side:
            raise NotUsable(Reason.CROPPED, f"{seen[0]}x{seen[1]} of {columns}x{rows} corners, then the picture ends", seen)
        raise NotUsable(Reason.WRONG_BOARD, f"it seems to have {seen[0]}x{seen[1]} inner corners, not {columns}x{rows}", seen)
    if grid.shape[:2] != (rows, columns):
        grid = np.rot90(grid)
    half = int(np.clip(0.36 * side, 2, 12))  # or the next corner comes into the window
    xy = np.ascontiguousarray(_in_order(grid, grey).reshape(-1, 1, 2), np.float32)
    xy = cv2.cornerSubPix(grey, xy, (half, half), (-1, -1), (3, 30, 1e-3))
    return BoardCorners(xy[:, 0].astype(float), np.arange(len(xy)))


def _in_order(grid, grey):
    """Not mirrored, and the square inside the first corner dark; where colours cannot tell, nearer to the top left."""
    right, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if right[0] * down[1] - right[1] * down[0] < 0:
        grid = grid[:, ::-1]
    middle = (grid[:-1, :-1] + grid[1:, 1:]) / 2
    levels = grey[middle[..., 1].round().astype(int), middle[..., 0].round().astype(int)].astype(float)
    even = np.indices(levels.shape).sum(axis=0) % 2 == 0
    dark_first = levels[even].mean() < levels[~even].mean()
    turned = grid[::-1, ::-1]
    if sum(grid.shape[:2]) % 2:
        return grid if dark_first else turned
    if grid.shape[0] == grid.shape[1] and not dark_first:
        grid = np.rot90(grid)
        turned = grid[::-1, ::-1]
    return turned if turned[0, 0].sum() < grid[0, 0].sum() else grid
