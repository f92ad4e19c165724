"""Corners of a checkerboard in a picture, to a few hundredths of a pixel, or the reason why there are none to use."""

import itertools
from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.calibration.board import check_pattern
from ir50p_lab.vision.calibration.grid import (
    grow,
    in_order,
    is_checkerboard,
    is_whole,
    next_to_margin,
    roughness,
    spacing,
)
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason
from ir50p_lab.vision.calibration.saddles import parts_by_saddles

_SEARCHED = 1280  # px; corners are searched in a picture reduced to this, and refined in the picture itself
_WINDOW = 0.36  # half the refinement window, in squares: larger is more precise until the next edges come in
_WINDOW_PX = (2, 20)
_SOFT = 0.55  # rise of an edge from dark to light, in squares, at which neighbouring edges run together
_UNKNOWN = 100  # what OpenCV says for the rise where squares are too small for it to follow an edge
SOFT_SLOPE = 0.45  # the same limit for `slope_rise`: waves of that length, all that blur leaves, have 0.5
_UNEVEN = 0.03  # scatter about a smooth grid, in squares, from which on a slower finder is asked, too
_UNEVEN_SMALL, _SMALL = 0.01, 22  # the same for squares smaller than so many px, which leave little for a window
_BLUR, _BLUR_PX = 0.05, 1.0  # in squares, at most so many px: noise and compression go, corners stay where they are
_ROUGH = 0.08  # the same, that no board shows


@dataclass(frozen=True, eq=False)
class BoardCorners:
    """Corners found in one picture.

    xy: (n, 2) pixels; index: (n,) places in `board.points`.
    """

    xy: np.ndarray
    index: np.ndarray


def find_checkerboard(grey, pattern, other=None):
    """All inner corners of a checkerboard: by OpenCV's finders or its own saddles, refined.

    `findChessboardCorners` is quick; where it sees nothing a grid is grown from the saddles of the picture, then
    `findChessboardCornersSB` is asked, slow and good at blur; also for uneven corners and small squares, where the
    smoother grid counts. Corners are refined by `cornerSubPix` with a window from the size of the squares. A board
    that goes on beyond the pattern is another board, although a finder is content with a part of it.

    Args: grey: (h, w) uint8; pattern: (columns, rows); other: (columns, rows) of a board that other pictures showed
    in its place, looked for first. Returns: BoardCorners, all, in the order of `Checkerboard`.
    Raises NotUsable with the Reason, CalibrationError for a pattern that cannot be.
    """
    pattern = check_pattern(pattern)
    small, factor = reduced(grey, _SEARCHED)
    if other is not None:
        _refuse_other(grey, small, factor, other, pattern)
    best = _examined(grey, _classic(small, pattern), factor, pattern)
    if best is None:
        best = _found_slowly(grey, small, factor, pattern)
    else:
        noise, side = roughness(best), np.median(spacing(best))
        if noise > (_UNEVEN_SMALL if side < _SMALL else _UNEVEN) * side:
            smoother = _by_sb(grey, small, factor, pattern)
            if smoother is not None and roughness(smoother) < noise:
                best = smoother
    refuse_soft(grey, best)
    columns, rows = pattern
    return BoardCorners(in_order(best, grey, pattern).reshape(-1, 2).astype(float), np.arange(columns * rows))


def _found_slowly(grey, small, factor, pattern):
    """The grid where `findChessboardCorners` finds none. Raises NotUsable with the Reason."""
    try:
        return _piece_together(grey, small, factor, pattern)
    except NotUsable as why:
        grid = None if why.whole else _examined(grey, _sb(small, pattern), factor, pattern)
        if grid is None:
            raise
        return grid


def _by_sb(grey, small, factor, pattern):
    """Corners by SB of a board that is known to be there: its own in a picture at its size; or None."""
    grid = _sb(small, pattern)
    if grid is not None and factor > 1:
        grid = refine(grey, enlarged(grid, factor))
    return grid if grid is not None and is_checkerboard(grid, grey) else None


def _refuse_other(grey, small, factor, other, pattern):
    """Raise NotUsable if the picture shows all of that other board, and no more."""
    grid = _classic(small, other)
    if grid is None:
        return
    grid = refine(grey, enlarged(grid, factor))
    if is_checkerboard(grid, grey) and grow(grid, grey)[0].shape == grid.shape:
        raise wrong_board(grid, pattern, whole=_is_other(grid, grey, pattern))


def reduced(grey, longest):
    """(picture at most `longest` px wide and high, factor by which it is smaller)."""
    import cv2

    factor = max(grey.shape) / longest
    if factor <= 1:
        return grey, 1.0
    h, w = grey.shape
    return cv2.resize(grey, (round(w / factor), round(h / factor)), interpolation=cv2.INTER_AREA), factor


def enlarged(xy, factor):
    """Pixels of a reduced picture in the full one: edges of pixels scale, not their centres."""
    return (xy + 0.5) * factor - 0.5


def _classic(grey, pattern):
    """Grid (rows, columns, 2) by `findChessboardCorners`, or None."""
    import cv2

    flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
    found, corners = cv2.findChessboardCorners(grey, pattern, None, flags)
    return corners.reshape(pattern[1], pattern[0], 2) if found else None


def _sb(grey, pattern):
    """The same by `findChessboardCornersSB`; without ACCURACY: slower, and no better than what refines them here."""
    import cv2

    found, corners = cv2.findChessboardCornersSB(
        grey, pattern, flags=cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE
    )
    return corners.reshape(pattern[1], pattern[0], 2) if found else None


def _examined(grey, found, factor, pattern):
    """Refined corners of a grid; None if it is no checkerboard. Raises NotUsable if the board goes on beyond it."""
    if found is None:
        return None
    grid = refine(grey, enlarged(found, factor))
    if roughness(grid) > _ROUGH * np.median(spacing(grid)) or not is_checkerboard(grid, grey):
        return None
    larger, _ = grow(grid, grey)
    if larger.shape != grid.shape:
        raise wrong_board(larger, pattern, whole=True)
    return grid


def wrong_board(grid, pattern, edge="", whole=False):
    """NotUsable for a board that has other corners than the pattern says; whole: it is seen to end all round."""
    seen = _named_like(grid, pattern)
    return NotUsable(
        Reason.WRONG_BOARD,
        f"it seems to have {edge}{seen[0]}x{seen[1]} inner corners, not {pattern[0]}x{pattern[1]}: "
        f"give pattern=({seen[0]}, {seen[1]}) if this is the board",
        seen=seen,
        whole=whole,
    )


def _named_like(grid, pattern):
    """(columns, rows) of a grid, the longer side where the pattern has it."""
    short, long = sorted(grid.shape[:2])
    return (long, short) if pattern[0] >= pattern[1] else (short, long)


def refine(grey, grid):
    """Corners (rows, columns, 2) to sub-pixel: `cornerSubPix` with a window for each corner from its squares.

    Raises NotUsable if one lies outside the picture.
    """
    import cv2

    h, w = grey.shape
    if not ((grid >= 0) & (grid <= (w - 1, h - 1))).all():
        raise NotUsable(Reason.CROPPED, "corners beyond the edge of the picture: move the board into view")
    part, side = np.where(next_to_margin(grid, grey), _WINDOW / 2, _WINDOW), spacing(grid)
    half = np.clip(np.round(part * side), *_WINDOW_PX).astype(int).ravel()
    smooth = cv2.GaussianBlur(grey, (0, 0), float(np.clip(_BLUR * np.median(side), 0.2, _BLUR_PX)))
    xy = grid.reshape(-1, 1, 2).astype(np.float32)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 30, 1e-3)
    for size in np.unique(half):
        which = half == size
        xy[which] = cv2.cornerSubPix(smooth, xy[which].copy(), (int(size), int(size)), (-1, -1), stop)
    return xy.reshape(grid.shape).astype(float)


def edge_rise(grey, grid):
    """Mean width of an edge from 10 % to 90 % of its step, px: of the softer of the two directions."""
    import cv2

    rows, columns = grid.shape[:2]
    xy = grid.reshape(-1, 1, 2).astype(np.float32)
    rises = [
        cv2.estimateChessboardSharpness(grey, (columns, rows), xy, vertical=vertical)[0][0]
        for vertical in (False, True)
    ]
    return float(max(rises))


def slope_rise(grey, xy, side):
    """Rough width of the edges at corners, px: step of grey levels over the steepest slope, median of the corners."""
    import cv2

    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0) / 8, cv2.Sobel(grey, cv2.CV_32F, 0, 1) / 8
    slope, reach, widths = np.hypot(gx, gy), max(2, round(0.4 * side)), []
    for x, y in np.round(xy).astype(int):
        window = np.s_[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
        widths.append(float(np.ptp(grey[window])) / max(float(slope[window].max()), 1e-6))
    return 0.8 * float(np.median(widths))  # from 10 to 90 % of the step


def refuse_soft(grey, grid):
    """Raise NotUsable if the edges run into each other."""
    nearest = float(np.median(spacing(grid)))
    rise, limit = edge_rise(grey, grid), _SOFT * nearest
    if rise >= _UNKNOWN:
        rise, limit = slope_rise(grey, grid.reshape(-1, 2), nearest), SOFT_SLOPE * nearest
    if rise > limit:
        raise NotUsable(
            Reason.BLURRED,
            f"edges are {rise:.1f} px wide, squares only {nearest:.0f} px: focus, hold board and camera still, or come "
            "nearer",
        )


def _piece_together(grey, small, factor, pattern):
    """The grid from a part that was found and grown, if it becomes the whole board; else NotUsable says why not."""
    grid = part_of_a_checkerboard(small)
    if grid is None:
        raise NotUsable(Reason.NO_BOARD, "nothing like a checkerboard: more light, less glare, the whole board in view")
    grid = refine(grey, enlarged(grid, factor))
    refuse_soft(grey, grid)
    grid, outside = grow(grid, grey)
    if sorted(grid.shape[:2]) == sorted(pattern):
        return refine(grey, grid if grid.shape[:2] == (pattern[1], pattern[0]) else np.rot90(grid))
    if not _part_of_it(grid.shape[:2], outside, pattern):
        raise wrong_board(grid, pattern, "at least " if outside else "", _is_other(grid, grey, pattern))
    columns, rows = _named_like(grid, pattern)
    raise NotUsable(
        Reason.CROPPED,
        f"{columns}x{rows} of {pattern[0]}x{pattern[1]} corners, then the picture ends: "
        "move the board into view, or use a ChArUco board",
        seen=(columns, rows),
    )


def part_of_a_checkerboard(grey):
    """A grid found anywhere in a picture, at its size or reduced, by its saddles or by SB; or None."""
    import cv2

    for find, scales in ((_grown_from_saddles, (1, 2, 4)), (_largest_by_sb, (2, 4))):
        for less in scales:
            h, w = grey.shape
            if min(h, w) >= 60 * less:
                small = cv2.resize(grey, (w // less, h // less), interpolation=cv2.INTER_AREA)
                grid = find(small)
                if grid is not None:
                    return enlarged(grid, less)
    return None


def _grown_from_saddles(grey):
    """The grid around the first part by its saddles that becomes 4x3 or more and is smooth, or None."""
    for part in itertools.islice(parts_by_saddles(grey), 20):
        grid, _ = grow(refine(grey, part), grey)
        smooth = roughness(grid) < _ROUGH / 2 * np.median(spacing(grid))
        if smooth and grid.shape[0] * grid.shape[1] >= 12 and is_checkerboard(grid, grey):
            return grid
    return None


def _is_other(grid, grey, pattern):
    """Whether a grid is surely no part of the pattern: larger one way, or its board is seen to end all round."""
    larger = any(n > m for n, m in zip(sorted(grid.shape[:2]), sorted(pattern), strict=True))
    return larger or is_whole(grid, grey)


def _part_of_it(shape, outside, pattern):
    """Whether a grid (rows, columns) can be part of the pattern: whole each way, or cut off by the picture."""
    cut = bool(outside & {"top", "bottom"}), bool(outside & {"left", "right"})
    return any(
        all(n == m or (n < m and is_cut) for n, m, is_cut in zip(shape, turned, cut, strict=True))
        for turned in (pattern, pattern[::-1])
    )


def _largest_by_sb(grey):
    """The largest grid (rows, columns, 2) around 3x3 corners that `findChessboardCornersSB` finds, or None."""
    import cv2

    flags = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_LARGER
    found, corners, meta = cv2.findChessboardCornersSBWithMeta(grey, (3, 3), flags)
    if not found:
        return None
    grid = corners.reshape(*meta.shape, 2).astype(float)
    return grid if is_checkerboard(grid, grey) else None
