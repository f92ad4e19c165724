"""Pictures of a flat board, painted ray by ray: a second route beside the package's own renderer, and corner sets."""

from functools import lru_cache

import cv2
import numpy as np

from ir50p_lab.course.camera.board_poses import board_poses

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
def rays(size, over, intrinsic, lens):
    """Normalised coordinates (h over, w over, 2) of over x over rays in each pixel; intrinsic, lens: K and lens as tuples."""
    w, h = size
    x, y = np.meshgrid((np.arange(w * over) + 0.5) / over - 0.5, (np.arange(h * over) + 0.5) / over - 0.5)
    distorted, matrix = np.stack([x.ravel(), y.ravel()], 1), np.reshape(intrinsic, (3, 3))
    undistorted = cv2.undistortPointsIter(distorted, matrix, np.array(lens), None, None, (3, 15, 1e-8))
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
    intrinsic=K,
    lens=LENS,
    rim=1.0,
    bend=0.0,
    jpeg=None,
):
    """Picture (h, w, 3): every pixel the mean of over x over rays, undistorted and cut with the board.

    bend: 1/m, curvature along the rows, the middle towards the camera; jpeg: quality 0..100 of a compression.
    """
    columns, rows = pattern
    x, y = cv2.split(rays(size, over, tuple(np.ravel(intrinsic)), tuple(lens)))
    R, eye = np.float32(T[:3, :3]), np.float32(-T[:3, :3].T @ T[:3, 3])
    along = [x * R[0, k] + y * R[1, k] + R[2, k] for k in range(3)]
    z = np.float32(0)
    for _ in range(5 if bend else 1):
        depth = (z - eye[2]) / along[2]
        u, v = ((eye[k] + depth * along[k]) / square for k in (0, 1))
        z = np.float32(0.5 * bend) * (square * (u - (columns - 1) / 2)) ** 2
    dark = (np.floor(u).astype(np.int32) + np.floor(v).astype(np.int32)) & 1 == 0
    board = (u > -rim) & (u < columns - 1 + rim) & (v > -rim) & (v < rows - 1 + rim)
    paper = (u > -1.6) & (u < columns + 0.6) & (v > -1.6) & (v < rows + 0.6)
    light = np.where(paper, np.where(board & dark, *np.float32(levels)), np.float32(120))
    light = cv2.resize(cv2.GaussianBlur(light, (0, 0), blur * over), size, interpolation=cv2.INTER_AREA)
    light = light + np.random.default_rng(seed).normal(0, noise, light.shape)
    picture = np.dstack([np.clip(np.round(light), 0, 255).astype(np.uint8)] * 3)
    if jpeg is not None:
        picture = cv2.imdecode(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, jpeg])[1], cv2.IMREAD_COLOR)
    return picture


def painted_set(camera, count, seed=0, **how):
    """`count` pictures of a 9x6 board in poses of `board_poses`, as the Pinhole `camera` sees them; how: as for `paint`."""
    seen_by = {"size": camera.size, "intrinsic": camera.K, "lens": camera.distortion}
    poses = board_poses(camera, count, seed)
    return [paint(T, seed=1000 * seed + k, **(seen_by | how)) for k, T in enumerate(poses)]


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
