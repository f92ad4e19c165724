"""Pictures of a flat board, painted ray by ray: a second route beside the package's own renderer, and corner sets."""

from functools import lru_cache

import cv2
import numpy as np

K = np.array([[700.0, 0, 325], [0, 702, 236], [0, 0, 1]])
LENS = np.array([-0.25, 0.08, 0.001, -0.0005, 0.0])
SIZE = (640, 480)


def look(distance=0.6, tilt=0.0, about=0.0, spin=0.0, at=(0.0, 0.0), centre=(0.1, 0.0625)):
    """T_cam_board: tilted by `tilt` about the axis at angle `about` in the picture, turned by `spin`."""
    axis = np.array([np.cos(about), np.sin(about), 0.0]) * tilt
    R = cv2.Rodrigues(axis)[0] @ cv2.Rodrigues(np.array([0, 0, spin]))[0]
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = np.array([at[0] * distance, at[1] * distance, distance]) - R @ np.array([*centre, 0.0])
    return T


@lru_cache(2)
def rays(size, over, lens):
    """Normalised coordinates (h over, w over, 2) of over x over rays in each pixel."""
    w, h = size
    x, y = np.meshgrid((np.arange(w * over) + 0.5) / over - 0.5, (np.arange(h * over) + 0.5) / over - 0.5)
    distorted = np.stack([x.ravel(), y.ravel()], 1)
    undistorted = cv2.undistortPointsIter(distorted, K, np.array(lens), None, None, (3, 15, 1e-8))
    return np.float32(undistorted).reshape(h * over, w * over, 2)


def paint(
    T,
    pattern=(9, 6),
    square=0.025,
    *,
    size=SIZE,
    blur=0.7,
    noise=2.0,
    seed=0,
    over=2,
    levels=(40, 210),
    lens=LENS,
    rim=1.0,
):
    """Picture (h, w, 3): every pixel the mean of over x over rays, undistorted and cut with the board's plane."""
    to_squares = np.diag([1, 1, square]) @ np.linalg.inv(T[:3, [0, 1, 3]])
    u, v = cv2.split(cv2.perspectiveTransform(rays(size, over, tuple(lens)), to_squares))
    columns, rows = pattern
    dark = (np.floor(u).astype(np.int32) + np.floor(v).astype(np.int32)) & 1 == 0
    board = (u > -rim) & (u < columns - 1 + rim) & (v > -rim) & (v < rows - 1 + rim)
    paper = (u > -1.6) & (u < columns + 0.6) & (v > -1.6) & (v < rows + 0.6)
    light = np.where(paper, np.where(board & dark, *np.float32(levels)), np.float32(120))
    light = cv2.resize(cv2.GaussianBlur(light, (0, 0), blur * over), size, interpolation=cv2.INTER_AREA)
    light = light + np.random.default_rng(seed).normal(0, noise, light.shape)
    return np.dstack([np.clip(np.round(light), 0, 255).astype(np.uint8)] * 3)


def project(T, points, lens=LENS):
    """Pixels (n, 2) by OpenCV, not by the package."""
    return cv2.projectPoints(points, cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], K, lens)[0][:, 0]


def corner_sets(points, count, noise=0.1, seed=0, lens=LENS):
    """`count` views of board points (n, 3), fully in the picture, with noise: a list of (n, 2)."""
    rng, views = np.random.default_rng(seed), []
    while len(views) < count:
        tilt, about, spin = rng.uniform(0.1, 0.75), rng.uniform(0, 2 * np.pi), rng.uniform(-0.5, 0.5)
        xy = project(look(rng.uniform(0.3, 0.8), tilt, about, spin, rng.uniform(-0.25, 0.25, 2)), points, lens)
        if (xy > 5).all() and (xy < np.array(SIZE) - 6).all():
            views.append(xy + rng.normal(0, noise, xy.shape))
    return views
