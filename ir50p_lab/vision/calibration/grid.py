"""Corners of a checkerboard as a grid: its order, its spacing, how well it lies, and whether the board goes on."""

from functools import lru_cache

import numpy as np


def homography(points, xy):
    """Map (3, 3) of the plane points (n, 2) to pixels (n, 2), by least squares; None where there is none."""
    import cv2

    H, _ = cv2.findHomography(np.asarray(points, dtype=float), np.asarray(xy, dtype=float), 0)
    return H


def apply(H, points):
    """Pixels (n, 2) of plane points (n, 2)."""
    p = points @ H[:, :2].T + H[:, 2]
    return p[:, :2] / p[:, 2:]


def spacing(grid):
    """Distance (rows, columns) of each corner of a grid (rows, columns, 2) to its nearest neighbour, pixels."""
    nearest = np.full(grid.shape[:2], np.inf)
    for across in (nearest, nearest.T):  # the second time, rows are columns
        along = np.hypot(*np.diff(grid, axis=1).transpose(2, 0, 1))
        across[:, :-1] = np.minimum(across[:, :-1], along)
        across[:, 1:] = np.minimum(across[:, 1:], along)
        grid = grid.swapaxes(0, 1)
    return nearest


def side(grid):
    """Side of a square, pixels: the median spacing."""
    return float(np.median(spacing(grid)))


def roughness(grid):
    """How far the corners of a grid (rows, columns, 2) are from a smooth surface, rms, in squares.

    Smooth: a homography and, on top, polynomials of the third degree, which takes up lens distortion and a bent
    board. What is left is the noise of the corners, without knowing the camera.
    """
    (plane, smooth), xy = _smooth(*grid.shape[:2]), grid.reshape(-1, 2)
    H = homography(plane, xy)
    if H is None:
        return np.inf
    left = xy - apply(H, plane)
    left -= smooth @ (smooth.T @ left)
    return float(np.sqrt((left**2).sum() / max(len(xy) - smooth.shape[1], 1))) / side(grid)


@lru_cache
def _smooth(rows, columns):
    """Places (n, 2) in a grid of so many corners, and an orthonormal base (n, k) of the polynomials over them."""
    plane = np.argwhere(np.ones((rows, columns)))[:, ::-1].astype(float)
    u, v = (plane / (columns - 1, rows - 1) * 2 - 1).T
    terms = [u**i * v**j for i in range(min(4, columns)) for j in range(min(4, rows)) if i + j <= 3]
    return plane, np.linalg.qr(np.column_stack(terms))[0]


def in_order(grid, grey, pattern):
    """The grid with its first corner where `Checkerboard` says: not mirrored, and dark outside the first corner.

    grid: (rows, columns, 2); grey: (h, w). Returns a grid of the same shape.
    """
    right, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if right[0] * down[1] - right[1] * down[0] < 0:
        grid = grid[:, ::-1]
    if pattern[0] == pattern[1] and contrast(grid, grey) < 0:  # a quarter turn swaps dark and light
        grid = np.rot90(grid)
    turned = grid[::-1, ::-1]
    if sum(pattern) % 2:  # half a turn swaps dark and light: the colours tell
        return turned if contrast(grid, grey) < 0 else grid
    return turned if turned[0, 0].sum() < grid[0, 0].sum() else grid


def contrast(grid, grey):
    """Mean grey level of light minus dark squares if the square inside the first corner is dark; else negative."""
    middle = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    levels = sample(grey, middle.reshape(-1, 2)).reshape(middle.shape[:2])
    even, known = np.indices(levels.shape).sum(axis=0) % 2 == 0, np.isfinite(levels)
    light, dark = levels[known & ~even], levels[known & even]
    return float(light.mean() - dark.mean()) if light.size and dark.size else 0.0


def sample(grey, xy):
    """Grey levels (n,) at pixels (n, 2), bilinear; NaN outside."""
    import cv2

    xy = np.asarray(xy, dtype=np.float32)
    levels = cv2.remap(grey, xy[:, :1], xy[:, 1:], cv2.INTER_LINEAR).astype(float)[:, 0]
    h, w = grey.shape
    inside = (xy[:, 0] >= 0) & (xy[:, 0] <= w - 1) & (xy[:, 1] >= 0) & (xy[:, 1] <= h - 1)
    return np.where(inside, levels, np.nan)


def grow(grid, grey):
    """Follow the checks beyond a grid: (grid as large as the board, sides where it ran out of the picture).

    A row is added on a side when at most of its places, continued from the three outermost rows, four squares meet
    with dark and light crosswise. On the edge of a board they do not: outside it all is margin.

    grid: (rows, columns, 2). Returns (grid, set of "left", "right", "top", "bottom").
    """
    swing, outside = abs(contrast(grid, grey)), set()
    for side in ("right", "bottom", "left", "top"):
        while max(grid.shape[:2]) < 60:
            following = _next_column(grid)
            out, along = following - grid[:, -1], np.gradient(grid[:, -1], axis=0)
            found = _crossings(following, 0.3 * out, 0.3 * along, grey, swing)
            known = found[np.isfinite(found)]
            if len(known) <= 0.8 * len(found):
                outside.add(side)
                break
            if np.abs(known).mean() < 0.7:
                break
            grid = np.concatenate([grid, _settled(following, grid[:, -1], grey)[:, None]], axis=1)
        grid = np.rot90(grid)  # the next side is on the right
    return grid, outside


def _next_column(grid):
    """Continue the last three columns of a grid by one (rows, 2): perspective from the cross-ratio, row by row."""
    a, b, c = grid[:, -3], grid[:, -2], grid[:, -1]
    ab, bc = (np.maximum(np.hypot(*side.T), 1e-6)[:, None] for side in (b - a, c - b))
    # equally spaced points have the cross-ratio 4/3: (ac * bd) / (bc * ad)
    cd = bc * (ab + bc) / np.maximum(3 * ab - bc, 0.2 * bc)
    return c + (c - b) / bc * cd


def _settled(column, before, grey):
    """A column of corners (rows, 2) drawn to where squares meet, as far as that is near and in the picture."""
    import cv2

    step = float(np.median(np.linalg.norm(column - before, axis=1)))
    h, w = grey.shape
    inside = ((column >= 0) & (column <= (w - 1, h - 1))).all(axis=1)
    half, settled = int(np.clip(0.25 * step, 2, 20)), column.copy()
    xy = column[inside][:, None].astype(np.float32)
    settled[inside] = cv2.cornerSubPix(grey, xy, (half, half), (-1, -1), (3, 20, 1e-2))[:, 0]
    near = np.linalg.norm(settled - column, axis=1) < 0.15 * step
    return np.where(near[:, None], settled, column)


def is_checkerboard(grid, grey):
    """Whether at nearly all corners of a grid (rows, columns, 2) four squares meet, dark and light crosswise.

    Near the corner, and far out in the same squares: a grid that skips every other column passes only the first.
    """
    swing = abs(contrast(grid, grey))
    places, out, along = _steps(grid)
    levels = sample(grey, places + 0.3 * (out + along))
    levels = np.sort(levels[np.isfinite(levels)])
    first, last = len(levels) // 20, -1 - len(levels) // 20  # without the twentieth at either end
    if not levels.size or swing < max(8, 0.4 * (levels[last] - levels[first])):
        return False
    near, *far = _in_squares(grid, grey, swing)
    known = np.isfinite(near)
    if known.mean() < 0.7 or (near[known] != 0).mean() < 0.85:
        return False
    known[[0, -1]] = known[:, [0, -1]] = False  # the outermost squares of a board may be cut narrow
    return bool(known.any() and np.mean([each[known] == near[known] for each in far]) > 0.8)


def next_to_margin(grid, grey):
    """Corners (rows, columns), bool, beside squares that are cut narrow: something else begins within 0.7 squares."""
    near, *far = _in_squares(grid, grey, abs(contrast(grid, grey)))
    return (near != 0) & ((far[0] != near) | (far[1] != near))


def _steps(grid):
    """Corners (n, 2) of a grid, and the step to the next one along its rows and down its columns."""
    return (a.reshape(-1, 2) for a in (grid, np.gradient(grid, axis=1), np.gradient(grid, axis=0)))


def _in_squares(grid, grey, swing):
    """`_crossings` (3, rows, columns) at the corners of a grid: near them, and far out along the rows and columns."""
    places, out, along = _steps(grid)
    out = np.concatenate([0.3 * out, 0.7 * out, 0.3 * out])
    along = np.concatenate([0.3 * along, 0.3 * along, 0.7 * along])
    return _crossings(np.tile(places, (3, 1)), out, along, grey, swing).reshape(3, *grid.shape[:2])


def _crossings(places, out, along, grey, swing):
    """For each place (n, 2) whether four squares meet there, (n,): 1 or -1 (by which are dark), 0, or NaN if outside.

    out, along: (n, 2) px, where to look in each direction; swing: between light and dark squares, grey levels.
    """
    around = [places + i * out + j * along for i, j in ((1, 1), (-1, -1), (1, -1), (-1, 1))]
    a, d, b, c = sample(grey, np.concatenate(around)).reshape(4, -1)
    signed = (a + d - b - c) / 2
    cross = np.abs(signed)
    uneven = np.maximum(np.abs(a - d), np.abs(b - c))
    found = ((cross > 0.4 * swing) & (uneven < 0.6 * cross)) * np.sign(signed)
    found[~np.isfinite(a + b + c + d)] = np.nan
    return found
