"""Corners of a checkerboard in a picture, to a few hundredths of a pixel, or the reason why none can be used."""

import cv2
import numpy as np

from ir50p_lab.vision.calibration.board import check_pattern
from ir50p_lab.vision.calibration.reject_reasons import NotUsable, Reason

_SEARCHED = 1280  # px; corners are searched in a picture reduced to this, and refined in the picture itself
_SMOOTH = 0.8  # px, blur of the copy for the second finder: in a dark picture it would follow every speck of noise
_SOFT = 0.55  # squares: if an edge rises from dark to light over more than this, neighbouring edges run together
_UNKNOWN = 100  # px: OpenCV gives this width or more if squares are too small for it to follow an edge
_WINDOW = 0.36  # half the window of the refinement over the smallest square: a larger one reaches the next edges
_WINDOW_PX = (2, 12)  # px, half that window at least and at most
_CROSSING = 0.3  # contrast of squares outside the last corners over that inside: if it is less, the board ends there
_NOTHING = (
    "nothing like a checkerboard: more light, less glare, the whole board in view, tilted less, and no markers in it"
)
_MARGIN = 1.3  # squares: if the picture ends nearer to the last corner, the next one would lie outside


def find_checkerboard(grey, pattern):
    """Return all inner corners of a checkerboard, (n, 2) px in the order of `Checkerboard.points`.

    `findChessboardCornersSB` looks for the board or a larger one. If it sees none, `findChessboardCorners` is tried,
    which is better in poor light. `cornerSubPix` refines the corners in a window that fits the size of the smallest
    square.

    Args: grey: (h, w) uint8; pattern: (columns, rows).
    Raises NotUsable with the Reason, CalibrationError for an impossible pattern.
    """
    pattern = check_pattern(pattern)
    cv2.setRNGSeed(0)  # the finders draw at random: a steep board at the border was seen in 19 of 20 calls
    try:
        grid = _search(grey, pattern)
        _refuse_soft(grid, grey)
        _check_whole(grid, grey, pattern)
        return _refine(_in_order(grid, grey, pattern), grey)
    except cv2.error as error:  # a picture of a few pixels, say, must not stop the others
        raise NotUsable(Reason.NO_BOARD, f"OpenCV finds no corners in it: {' '.join(str(error).split())}") from error


def _search(grey, pattern):
    """Rough corners (n, m, 2) px of the whole board, whatever its pattern, or of a part of it."""
    factor = max(1.0, max(grey.shape) / _SEARCHED)
    small = cv2.resize(grey, None, fx=1 / factor, fy=1 / factor, interpolation=cv2.INTER_AREA)
    found = _search_larger(small, pattern)
    if found is None:
        seen, xy = cv2.findChessboardCorners(cv2.GaussianBlur(small, (0, 0), _SMOOTH), pattern)
        found = xy.reshape(pattern[1], pattern[0], 2) if seen else None
    elif sorted(found.shape[:2]) != sorted(pattern):
        found = _without_rim(found, small)
    for part in _parts(*pattern):  # of a board that is cut off, or of another one
        if found is None:
            found = _without_rim(_search_larger(small, part), small)
    if found is None:
        raise NotUsable(Reason.NO_BOARD, _NOTHING)
    return (found.astype(float) + 0.5) * factor - 0.5  # edges of pixels scale, not their centres


def _parts(columns, rows):
    """Patterns to look for if the whole is not seen; smaller ones are too easily found in writing and noise."""
    return (columns, max(rows - 1, 3)), (4, 4), (max(2 * columns // 3, 3), rows), (4, 3)


def _search_larger(grey, pattern):
    """Corners (n, m, 2) px of the largest board with at least this pattern, or None."""
    found, flags = None, cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_LARGER
    while True:  # it may be a part of the board: repeat until it grows no more
        seen, xy, meta = cv2.findChessboardCornersSBWithMeta(grey, pattern, flags)
        if not seen:
            return found
        found = xy.reshape(*meta.shape, 2)
        if pattern == meta.shape[::-1]:
            return found
        pattern = meta.shape[::-1]


def _without_rim(grid, grey):
    """A grid without outer rows and columns where no four squares meet; None if less than 3x3 corners are left of it.

    The finder continues a board along the rim of its paper, and finds grids in writing, too.
    """
    if grid is None:
        return None
    for _ in range(4):
        while not _goes_on(grid, grey):
            if len(grid) == 3:
                return None
            grid = grid[:-1]
        grid = np.rot90(grid)
    return grid


def _goes_on(grid, grey):
    """Return True if the squares outside the last row of corners continue the pattern of dark and light."""
    middles, inwards = (grid[-1, :-1] + grid[-1, 1:]) / 2, (grid[-2, :-1] + grid[-2, 1:]) / 2
    step, turns = (middles - inwards) / 4, (-1) ** np.arange(len(middles))
    outside, inside = (turns @ _levels(grey, middles + sign * step) for sign in (1, -1))
    return -outside * np.sign(inside) > _CROSSING * abs(inside)


def _levels(grey, xy):
    """Grey levels at pixels (..., 2), those of the rim for places outside the picture."""
    x, y = np.clip(np.round(xy).astype(int), 0, np.array(grey.shape[::-1]) - 1).T
    return grey[y, x].T.astype(float)


def _spacing(grid):
    """Smallest distance of neighbouring corners, px."""
    return min(float(np.linalg.norm(np.diff(grid, axis=axis), axis=2).min()) for axis in (0, 1))


def _refuse_soft(grid, grey):
    """Raise NotUsable if the edges, from 10 % to 90 % of their step, run into each other in either direction."""
    side, board = _spacing(grid), (grid.shape[1::-1], np.float32(grid.reshape(-1, 1, 2)))
    rise = max(cv2.estimateChessboardSharpness(grey, *board, vertical=vertical)[0][0] for vertical in (False, True))
    if _SOFT * side < rise < _UNKNOWN:
        detail = f"edges are {rise:.1f} px wide, squares only {side:.0f} px: focus, hold still, or come nearer"
        raise NotUsable(Reason.BLURRED, detail)


def _check_whole(grid, grey, pattern):
    """Raise NotUsable if a grid is not all of the pattern: of another board, cut off by the picture, or covered."""
    short, long = sorted(grid.shape[:2])
    ways = [way for way in ((long, short), (short, long)) if way[0] <= pattern[0] and way[1] <= pattern[1]]
    seen = max(ways, key=lambda way: (way[0] == pattern[0]) + (way[1] == pattern[1]), default=(long, short))
    if seen == pattern:
        return
    shown = f"{seen[0]}x{seen[1]}"
    room = min(*grid.min(axis=(0, 1)), *(np.array(grey.shape[::-1]) - 1 - grid.max(axis=(0, 1))))
    cut = room < _MARGIN * _spacing(grid)
    if ways and (cut or seen[0] == pattern[0] or seen[1] == pattern[1]):
        cause = "then the picture ends" if cut else f"is the rest covered, or in glare, or is this all: pattern={seen}?"
        detail = f"{shown} of {pattern[0]}x{pattern[1]} corners, {cause}: move the board into view"
        raise NotUsable(Reason.CROPPED, detail, seen)
    if pattern[0] < pattern[1]:
        seen = seen[::-1]
    detail = f"it seems to have {shown} inner corners, not {pattern[0]}x{pattern[1]}: give pattern={seen} if it has"
    if ways:  # a small one, or a part of the board
        detail += "; if it is the same board, tilt it less and show all of it"
    raise NotUsable(Reason.WRONG_BOARD, detail, seen)


def _in_order(grid, grey, pattern):
    """The grid (rows, columns, 2) in the order of `Checkerboard`: not mirrored, and beginning at a dark square.

    A board that looks the same after half a turn begins nearer to the top left.
    """
    if grid.shape[:2] != pattern[::-1]:
        grid = np.rot90(grid)
    right, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if right[0] * down[1] - right[1] * down[0] < 0:
        grid = grid[:, ::-1]
    levels = _levels(grey, (grid[:-1, :-1] + grid[1:, 1:]) / 2)
    even = np.indices(levels.shape).sum(axis=0) % 2 == 0
    light_first = levels[even].mean() > levels[~even].mean()
    if sum(pattern) % 2:
        return grid[::-1, ::-1] if light_first else grid
    if pattern[0] == pattern[1] and light_first:
        grid = np.rot90(grid)
    return grid[::-1, ::-1] if grid[-1, -1].sum() < grid[0, 0].sum() else grid


def _refine(grid, grey):
    """Corners (n, 2) px, refined to parts of a pixel."""
    half = int(np.clip(_WINDOW * _spacing(grid), *_WINDOW_PX))
    xy = np.ascontiguousarray(grid.reshape(-1, 1, 2), np.float32)
    return cv2.cornerSubPix(grey, xy, (half, half), (-1, -1), (3, 30, 1e-3))[:, 0].astype(float)
