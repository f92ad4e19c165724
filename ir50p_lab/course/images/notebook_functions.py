"""The function of 16 that stays in its notebook, what it is tried on, and the helpers that the notebook shows."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.course.images.functions.circle_votes import circle_votes


def edges_of(mask):
    """Return the edge pixels of a mask: points (n, 2), (x, y) px, and unit vectors inwards (n, 2)."""
    smooth = mask.astype(float)
    for axis in (0, 1, 0, 1):  # a pixel and half of its two neighbours, down and across, twice
        smooth = (np.roll(smooth, 1, axis) + 2 * smooth + np.roll(smooth, -1, axis)) / 4
    down, right = np.gradient(smooth)
    slope = np.hypot(right, down)
    rows, columns = np.nonzero(slope > 0.2)
    inwards = np.column_stack([right[rows, columns], down[rows, columns]]) / slope[rows, columns, None]
    return np.column_stack([columns, rows]), inwards


def with_neighbours(votes):
    """Return (h, w): the votes of each pixel and of its eight neighbours together."""
    tall = votes + np.roll(votes, 1, 0) + np.roll(votes, -1, 0)
    return tall + np.roll(tall, 1, 1) + np.roll(tall, -1, 1)


def strongest(edges, radius, shape):
    """Return the best middle for one radius: its votes as a share of a full circle's, and its place (column, row)."""
    votes = with_neighbours(circle_votes(*edges, radius, shape))
    row, column = np.unravel_index(np.argmax(votes), votes.shape)
    return votes.max() / (2 * np.pi * radius), (int(column), int(row))


def best_circle(mask, radii):
    """Return the circle with the largest share of votes: share, place (column, row), radius."""
    edges = edges_of(mask)
    return max((*strongest(edges, radius, mask.shape), radius) for radius in radii)


# ------------------------------------------------------------------------------------------------------ tried on
def _masks():
    rows, columns = np.indices((70, 90))
    cases = []
    for x, y, r in ((30, 30, 12), (55, 40, 9), (44, 28, 15), (79, 30, 8)):  # the last beyond the height of the mask
        disc = np.hypot(columns - x, rows - y) < r
        bar = (np.abs(rows - 62) < 3) & (columns > 20)
        cases += [(disc, range(7, 19)), (disc | bar, [18, 14, 8, 9, 12, 15, 10])]
    small = np.hypot(columns - 15, rows - 15) < 7
    half = (np.hypot(columns - 55, rows - 40) < 24) & (rows < 40)  # more votes, and a smaller share
    cut_off = np.hypot(columns - 95, rows - 30) < 14  # its middle lies outside the mask
    return [*cases, (small | half, [24, 20, 7, 9]), (cut_off, [14])]


TASKS = notebook_tasks(
    __file__,
    best_circle=(
        best_circle,
        _masks,
        "share, place and radius of the circle with the largest share",
        {"results": ("share", "place", "radius")},
    ),
)
