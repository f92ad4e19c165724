"""Corners of a checkerboard as a grid: its order, its spacing, how well it lies, and whether the board goes on."""

import numpy as np


def homography(points, xy):
    """Map (3, 3) of the plane points (n, 2) to pixels (n, 2), by least squares; None where there is none."""
    import cv2

    H, _ = cv2.findHomography(np.asarray(points, dtype=float), np.asarray(xy, dtype=float), 0)
    return H


def apply(H, points):
    """Pixels (n, 2) of plane points (n, 2)."""
    p = np.column_stack([points, np.ones(len(points))]) @ H.T
    return p[:, :2] / p[:, 2:]


def spacing(grid):
    """Distance (rows, columns) of each corner of a grid (rows, columns, 2) to its nearest neighbour, pixels."""
    along = np.pad(np.linalg.norm(np.diff(grid, axis=1), axis=2), ((0, 0), (1, 1)), constant_values=np.inf)
    down = np.pad(np.linalg.norm(np.diff(grid, axis=0), axis=2), ((1, 1), (0, 0)), constant_values=np.inf)
    return np.min([along[:, :-1], along[:, 1:], down[:-1], down[1:]], axis=0)


def roughness(grid):
    """How far the corners of a grid (rows, columns, 2) are from a smooth surface, pixels rms.

    Smooth: a homography and, on top, polynomials of the third degree, which takes up lens distortion and a bent
    board. What is left is the noise of the corners, without knowing the camera.
    """
    rows, columns = grid.shape[:2]
    y, x = np.mgrid[0:rows, 0:columns]
    plane = np.column_stack([x.ravel(), y.ravel()]).astype(float)
    xy = grid.reshape(-1, 2)
    H = homography(plane, xy)
    if H is None:
        return np.inf
    u, v = (plane[:, 0] / (columns - 1) * 2 - 1, plane[:, 1] / (rows - 1) * 2 - 1)
    terms = np.column_stack([u**i * v**j for i in range(min(4, columns)) for j in range(min(4, rows)) if i + j <= 3])
    left = xy - apply(H, plane)
    left -= terms @ np.linalg.lstsq(terms, left, rcond=None)[0]
    return float(np.sqrt((left**2).sum() / max(len(xy) - terms.shape[1], 1)))


def in_order(grid, grey, pattern):
    """The grid with its first corner where `Checkerboard` says: not mirrored, and dark outside the first corner.

    grid: (rows, columns, 2); grey: (h, w). Returns a grid of the same shape.
    """
    right, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if right[0] * down[1] - right[1] * down[0] < 0:
        grid = grid[:, ::-1]
    turned = grid[::-1, ::-1]
    if sum(pattern) % 2:  # half a turn swaps dark and light: the colours tell
        return turned if contrast(grid, grey) < 0 else grid
    return turned if turned[0, 0].sum() < grid[0, 0].sum() else grid


def contrast(grid, grey):
    """Mean grey level of light minus dark squares if the square inside the first corner is dark; else negative."""
    middle = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    levels = sample(grey, middle.reshape(-1, 2))
    j, i = np.mgrid[0 : middle.shape[0], 0 : middle.shape[1]]
    even = ((i + j) % 2 == 0).ravel() & np.isfinite(levels)
    odd = ((i + j) % 2 == 1).ravel() & np.isfinite(levels)
    return float(levels[odd].mean() - levels[even].mean()) if even.any() and odd.any() else 0.0


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
    swing = abs(contrast(grid, grey))
    sides = {"right": 0, "bottom": 1, "left": 2, "top": 3}
    outside = set()
    for side, quarter_turns in sides.items():
        turned = _turn(grid, quarter_turns)
        while max(turned.shape[:2]) < 60:
            following = _next_column(turned)
            out, along = following - turned[:, -1], np.gradient(turned[:, -1], axis=0)
            found = _crossings(following, 0.3 * out, 0.3 * along, grey, swing)
            if np.mean(np.isnan(found)) >= 0.2:
                outside.add(side)
                break
            if np.nanmean(np.abs(found)) < 0.7:
                break
            turned = np.concatenate([turned, _settled(following, turned[:, -1], grey)[:, None]], axis=1)
        grid = _turn(turned, -quarter_turns)
    return grid, outside


def _turn(grid, quarter_turns):
    return np.rot90(grid, quarter_turns, axes=(0, 1))


def _next_column(grid):
    """Continue the last three columns of a grid by one (rows, 2): perspective from the cross-ratio, row by row."""
    if grid.shape[1] < 3:
        return 2 * grid[:, -1] - grid[:, -2]
    a, b, c = grid[:, -3], grid[:, -2], grid[:, -1]
    ab = np.maximum(np.linalg.norm(b - a, axis=1, keepdims=True), 1e-6)
    bc = np.maximum(np.linalg.norm(c - b, axis=1, keepdims=True), 1e-6)
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
    if inside.any():
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
    dark, light = np.nanpercentile(levels, (5, 95)) if np.isfinite(levels).any() else (0, 0)
    if swing < max(8, 0.4 * (light - dark)):
        return False
    near, *far = _in_squares(grid, grey, swing)
    known = np.isfinite(near)
    if known.mean() < 0.7 or (near[known] != 0).mean() < 0.85:
        return False
    inner = np.zeros(grid.shape[:2], dtype=bool)
    inner[1:-1, 1:-1] = True  # the outermost squares of a board may be cut narrow
    inner = inner.ravel() & known
    return bool(inner.any() and np.mean([each[inner] == near[inner] for each in far]) > 0.8)


def next_to_margin(grid, grey):
    """Corners (rows, columns), bool, beside squares that are cut narrow: something else begins within 0.7 squares."""
    near, *far = _in_squares(grid, grey, abs(contrast(grid, grey)))
    return ((near != 0) & ((far[0] != near) | (far[1] != near))).reshape(grid.shape[:2])


def _steps(grid):
    """Corners (n, 2) of a grid, and the way to the next one along its rows and down its columns."""
    return (a.reshape(-1, 2) for a in (grid, np.gradient(grid, axis=1), np.gradient(grid, axis=0)))


def _in_squares(grid, grey, swing):
    """`_crossings` (3, n) of the corners of a grid: near the corner, and far out along the rows and the columns."""
    places, out, along = _steps(grid)
    out = np.concatenate([0.3 * out, 0.7 * out, 0.3 * out])
    along = np.concatenate([0.3 * along, 0.3 * along, 0.7 * along])
    return _crossings(np.tile(places, (3, 1)), out, along, grey, swing).reshape(3, -1)


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
