"""Corners of a checkerboard in a picture, to a few hundredths of a pixel, or the reason why there are none to use."""

import itertools
from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.calibration.board import check_pattern
from ir50p_lab.vision.calibration.grid import grow, in_order, is_checkerboard, next_to_margin, roughness, side, spacing
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason
from ir50p_lab.vision.calibration.saddles import parts_by_saddles

_SEARCHED = 1280  # px; corners are searched in a picture reduced to this, and refined in the picture itself
_SMOOTH = 0.8  # px, of the copy for the quick finder: in a dark picture it would follow every speck of noise
_WINDOW = 0.36  # half the refinement window, in squares: larger is more precise until the next edges come in
_WINDOW_PX = (2, 20)
_SOFT = 0.55  # rise of an edge from dark to light, in squares, at which neighbouring edges run together
_UNKNOWN = 100  # what OpenCV says for the rise where squares are too small for it to follow an edge
SOFT_SLOPE = 0.45  # the same limit for `slope_rise`: waves of that length, all that blur leaves, have 0.5
_UNEVEN = 0.03  # scatter about a smooth grid, in squares, from which on a slower finder is asked, too
_UNEVEN_SMALL, _SMALL = 0.0115, 22  # the same for squares smaller than so many px, which leave little for a window
_RIM, _TINY, _RIM_TINY = 0.8, 14, 3  # squares around the corners in which the slower finder searches; below 14 px
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

    `findChessboardCorners`, on a smoothed copy, is quick; where it sees nothing a grid is grown from the saddles of the
    picture, then `findChessboardCornersSB` is asked, slow and good at blur; also for uneven corners and small squares,
    where the smoother grid counts. Corners are refined by `cornerSubPix` with a window from the size of the squares. A
    board that goes on beyond the pattern is another board, although a finder is content with a part of it.

    Args: grey: (h, w) uint8; pattern: (columns, rows); other: (columns, rows) of a board that other pictures showed
    in its place, looked for first. Returns: BoardCorners, all, in the order of `Checkerboard`.
    Raises NotUsable with the Reason, CalibrationError for a pattern that cannot be.
    """
    import cv2

    pattern, factor = check_pattern(pattern), max(1.0, max(grey.shape) / _SEARCHED)
    small = cv2.resize(grey, None, fx=1 / factor, fy=1 / factor, interpolation=cv2.INTER_AREA)
    smooth = cv2.GaussianBlur(small, (0, 0), _SMOOTH)
    for wanted in filter(None, (other, pattern)):
        best = _examined(grey, cv2.findChessboardCorners(smooth, wanted), factor, wanted)
        if best is not None:
            _check_whole(grow(best, grey)[0], set(), pattern)
    if best is None:
        try:
            best = _grown(grey, small, factor, pattern)
        except NotUsable as why:
            if why.reason == Reason.CROPPED or why.seen:
                raise
            by_sb = cv2.findChessboardCornersSB(small, pattern, flags=cv2.CALIB_CB_NORMALIZE_IMAGE)
            best = _examined(grey, by_sb, factor, pattern)  # EXHAUSTIVE or ACCURACY take longer and find no more
            if best is None:
                raise
            _check_whole(grow(best, grey)[0], set(), pattern)
    elif roughness(best) > (_UNEVEN_SMALL if side(best) < _SMALL else _UNEVEN):
        best = _smoother(grey, small, factor, pattern, best)
    refuse_soft(grey, best)
    return BoardCorners(in_order(best, grey, pattern).reshape(-1, 2).astype(float), np.arange(best.size // 2))


def enlarged(xy, factor):
    """Pixels of a reduced picture in the full one: edges of pixels scale, not their centres."""
    return (xy + 0.5) * factor - 0.5


def _smoother(grey, small, factor, pattern, grid):
    """The corners of SB itself around a grid that was found, if they lie more smoothly, else the grid.

    It is asked without the surroundings, three times as quick; where squares are tiny it needs some of them.
    """
    import cv2

    inside, square = (grid + 0.5) / factor - 0.5, side(grid) / factor
    rim = square * (_RIM if square > _TINY else _RIM_TINY)
    start = np.maximum(inside.min(axis=(0, 1)) - rim, 0).astype(int)
    right, bottom = np.ceil(inside.max(axis=(0, 1)) + rim).astype(int) + 1
    window = np.ascontiguousarray(small[start[1] : bottom, start[0] : right])
    found, corners = cv2.findChessboardCornersSB(window, pattern, flags=0)
    other = _examined(grey, (found, corners + np.float32(start) if found else None), factor, pattern, factor > 1)
    return other if other is not None and roughness(other) < roughness(grid) else grid


def _examined(grey, result, factor, pattern, refined=True):
    """Corners of what a finder of OpenCV gave; None if it is no checkerboard."""
    found, corners = result
    if not found:
        return None
    grid = enlarged(corners.reshape(pattern[1], pattern[0], 2), factor)
    grid = refine(grey, grid) if refined else grid
    return grid if roughness(grid) <= _ROUGH and is_checkerboard(grid, grey) else None


def refine(grey, grid):
    """Corners (rows, columns, 2) to sub-pixel: `cornerSubPix` with a window for each corner from its squares.

    Raises NotUsable if one lies outside the picture.
    """
    import cv2

    h, w = grey.shape
    if not ((grid >= 0) & (grid <= (w - 1, h - 1))).all():
        raise NotUsable(Reason.CROPPED, "corners beyond the edge of the picture: move the board into view")
    part = np.where(next_to_margin(grid, grey), _WINDOW / 2, _WINDOW)
    half = np.clip(np.round(part * spacing(grid)), *_WINDOW_PX).astype(int).ravel()
    smooth = cv2.GaussianBlur(grey, (0, 0), float(np.clip(_BLUR * side(grid), 0.2, _BLUR_PX)))
    xy = grid.reshape(-1, 1, 2).astype(np.float32)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 30, 1e-3)
    for size in np.unique(half):
        which = half == size
        xy[which] = cv2.cornerSubPix(smooth, xy[which].copy(), (int(size), int(size)), (-1, -1), stop)
    return xy.reshape(grid.shape).astype(float)


def slope_rise(grey, xy, square):
    """Rough width of the edges at corners, px: step of grey levels over the steepest slope, median of the corners."""
    import cv2

    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0) / 8, cv2.Sobel(grey, cv2.CV_32F, 0, 1) / 8
    slope, reach, widths = np.hypot(gx, gy), max(2, round(0.4 * square)), []
    for x, y in np.round(xy).astype(int):
        window = np.s_[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
        widths.append(float(np.ptp(grey[window])) / max(float(slope[window].max()), 1e-6))
    return 0.8 * float(np.median(widths))  # from 10 to 90 % of the step


def refuse_soft(grey, grid):
    """Raise NotUsable if the edges, from 10 % to 90 % of their step, run into each other in either direction."""
    import cv2

    nearest, how = side(grid), (grid.shape[1::-1], grid.reshape(-1, 1, 2).astype(np.float32))
    rises = [cv2.estimateChessboardSharpness(grey, *how, vertical=vertical)[0][0] for vertical in (False, True)]
    rise, limit = max(rises), _SOFT * nearest
    if rise >= _UNKNOWN:
        rise, limit = slope_rise(grey, grid.reshape(-1, 2), nearest), SOFT_SLOPE * nearest
    if rise > limit:
        raise NotUsable(
            Reason.BLURRED,
            f"edges are {rise:.1f} px wide, squares only {nearest:.0f} px: focus, hold board and camera still, or come "
            "nearer",
        )


def _grown(grey, small, factor, pattern):
    """The grid from a part of it that was found and grown, if it becomes the whole board; else NotUsable says why."""
    grid = part_of_a_checkerboard(small)
    if grid is None:
        raise NotUsable(Reason.NO_BOARD, "nothing like a checkerboard: more light, less glare, the whole board in view")
    grid = refine(grey, enlarged(grid, factor))
    refuse_soft(grey, grid)
    grid, outside = grow(grid, grey)
    _check_whole(grid, outside, pattern)
    return refine(grey, grid if grid.shape[:2] == (pattern[1], pattern[0]) else np.rot90(grid))


def _check_whole(grid, outside, pattern):
    """Raise NotUsable if a grid is not all of the pattern: of another board, or cropped."""
    if sorted(grid.shape[:2]) == sorted(pattern):
        return
    short, long = sorted(grid.shape[:2])
    seen = (long, short) if pattern[0] >= pattern[1] else (short, long)  # the longer side where the pattern has it
    shown = f"{seen[0]}x{seen[1]}"
    if not _part_of_it(grid.shape[:2], outside, pattern):
        raise NotUsable(
            Reason.WRONG_BOARD,
            f"it seems to have {'at least ' * bool(outside)}{shown} inner corners, not {pattern[0]}x{pattern[1]}: "
            f"give pattern=({seen[0]}, {seen[1]}) if this is the board",
            seen=seen,
        )
    cause = "then the picture ends"
    if not outside:
        cause = f"is the rest covered, or in glare (or this the whole board: give pattern=({seen[0]}, {seen[1]}))?"
    raise NotUsable(
        Reason.CROPPED,
        f"{shown} of {pattern[0]}x{pattern[1]} corners, {cause}: move the board into view, or use a ChArUco board",
        seen=seen,
    )


def part_of_a_checkerboard(grey):
    """The grid around the first part by its saddles that becomes 4x3 or more and is smooth, at any scale; or None.

    A blurred board has no saddles: SB finds it in a reduced picture.
    """
    import cv2

    scales = [less for less in (1, 2, 4) if min(grey.shape) >= 60 * less]
    reduced = {less: cv2.resize(grey, None, fx=1 / less, fy=1 / less, interpolation=cv2.INTER_AREA) for less in scales}
    for less, small in reduced.items():
        for part in itertools.islice(parts_by_saddles(small), 20):
            grid, _ = grow(refine(small, part), small)
            if grid.size >= 2 * 12 and roughness(grid) < _ROUGH / 2 and is_checkerboard(grid, small):
                return enlarged(grid, less)
    largest = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_LARGER
    for less in scales[1:]:
        found, corners, meta = cv2.findChessboardCornersSBWithMeta(reduced[less], (3, 3), largest)
        grid = corners.reshape(*meta.shape, 2).astype(float) if found else np.zeros((3, 3, 2))
        if is_checkerboard(grid, reduced[less]):
            return enlarged(grid, less)
    return None


def _part_of_it(shape, outside, pattern):
    """Whether a grid (rows, columns) can be part of the pattern: cut off by the picture, or covered one way."""
    cut = bool(outside & {"top", "bottom"}), bool(outside & {"left", "right"})
    return any(
        all(n <= m for n, m in zip(shape, turned, strict=True))
        and sum(n < m and not is_cut for n, m, is_cut in zip(shape, turned, cut, strict=True)) <= (not outside)
        for turned in (pattern, pattern[::-1])
    )
