"""What notebook 17 tries: a calibration from corners that are known with noise, several balls in one picture."""

import numpy as np

from ir50p_lab.course.camera.board_poses import board_poses
from ir50p_lab.course.images import edges_of, with_neighbours
from ir50p_lab.vision import Checkerboard, calibrate_corners


def calibrated_with_noise(lens, count, noise):
    """Return the Calibration from `count` pictures with corners off by `noise` px (standard deviation) in x and y."""
    rng, points = np.random.default_rng(4), Checkerboard().points
    seen = [lens.project(T, points) for T in board_poses(lens, count, seed=5)]
    corners = [one + rng.normal(0, noise, one.shape) for one in seen]
    return calibrate_corners(points, corners, lens.size, lens=("k1", "k2", "p1", "p2"))


def find_circles(mask, circle_votes, radii, count):
    """Return the `count` best circles (x, y, radius), px, in a mask (h, w), by the votes of `circle_votes` as in 16."""
    rows, columns = np.indices(mask.shape)
    found = []
    for _ in range(count):
        edges = edges_of(mask)
        _, x, y, radius = max(_best(edges, circle_votes, radius, mask.shape) for radius in radii)
        found.append((x, y, radius))
        mask = mask & (np.hypot(columns - x, rows - y) > 1.5 * radius)
    return found


def _best(edges, circle_votes, radius, shape):
    """The share of a full circle's votes that the best middle gets, and that circle."""
    votes = with_neighbours(circle_votes(*edges, radius, shape))
    y, x = np.unravel_index(np.argmax(votes), shape)
    return votes.max() / (2 * np.pi * radius), x, y, radius
