"""The circle Hough transform (3.3), shown: each edge point votes for all centres that it could belong to."""

import numpy as np

from ir50p_lab.inputs import number
from ir50p_lab.vision.checks import point_list


def circle_votes(points, shape, radius, *, width=1.0):
    """Votes (h, w) for centres of circles of one radius: every point draws a circle around itself (Figure 3.7).

    Args: points (n, 2): x, y of edge pixels; shape: (h, w); radius > 0 and width of the drawn line, pixels.
    """
    points = point_list("points", points, 2)
    reach = int(np.ceil(number("radius", radius, "> 0", unit="px") + width))
    dy, dx = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    on = np.abs(np.hypot(dx, dy) - radius) < width / 2
    votes = np.zeros(shape[:2], int)
    for x, y in np.rint(points).astype(int):
        a, b = x + dx[on], y + dy[on]
        inside = (a >= 0) & (a < shape[1]) & (b >= 0) & (b < shape[0])
        votes[b[inside], a[inside]] += 1
    return votes


def circle_hough(points, shape, radii, *, width=1.0):
    """The accumulator (n_radii, h, w), as shares of a full circle: `circle_votes` over 2 pi r width.

    radii: (n_radii,) px, each > 0; points, shape, width as of `circle_votes`. Memory: n_radii pictures.
    """
    return np.stack([circle_votes(points, shape, r, width=width) / (2 * np.pi * r * width) for r in radii])


def strongest(accumulator, radii):
    """The circle with most votes: x, y, radius, px, and the share of its outline that has edge points.

    accumulator: (n_radii, h, w) of `circle_hough`, for the same radii (n_radii,) px.
    """
    k, y, x = np.unravel_index(np.argmax(accumulator), accumulator.shape)
    return int(x), int(y), float(radii[k]), float(accumulator[k, y, x])
