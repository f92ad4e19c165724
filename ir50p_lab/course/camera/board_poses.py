"""Poses of a board held in front of a camera, to try a calibration where the truth is known."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.board_pose import transform_points
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.pinhole import as_pinhole

_WINDOW = (0.36, 0.92)  # part of the picture's width that the board fills
_TILTS_DEG = (8, 42)


def board_poses(pinhole, count, seed=0, board=None):
    """Return T_cam_board (count, 4, 4): a board all over the picture, tilted in all directions, fully in view.

    pinhole: Pinhole or Calibration; seed: of the generator; board: Checkerboard.
    Raises InputError if no such poses are found.
    """
    import cv2

    pinhole = as_pinhole(pinhole)
    board, rng, poses = board or Checkerboard(), np.random.default_rng(seed), []
    (columns, rows), s, (w, h) = board.pattern, board.square, pinhole.size
    outline = s * np.array([[-1.0, -1, 0], [columns, -1, 0], [columns, rows, 0], [-1, rows, 0]])
    for _ in range(400 * count):
        tilt, about, spin = np.deg2rad(rng.uniform(*_TILTS_DEG)), rng.uniform(0, 2 * np.pi), rng.normal(0, 0.25)
        R = cv2.Rodrigues(tilt * np.array([np.cos(about), np.sin(about), 0]))[0] @ cv2.Rodrigues((0, 0, spin))[0]
        Z = pinhole.fx * columns * s / (rng.uniform(*_WINDOW) * w)
        aim = pinhole.to_normalised(np.array([rng.uniform(0.12, 0.88) * w, rng.uniform(0.12, 0.88) * h]))
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = R, np.array([*aim, 1.0]) * Z - R @ outline.mean(axis=0)
        if transform_points(T, outline)[:, 2].min() > 0.3 * Z:
            xy = pinhole.project(T, outline)
            if (xy > 2).all() and (xy < np.array([w, h]) - 3).all():
                poses.append(T)
        if len(poses) == count:
            return np.array(poses)
    raise InputError(f"{len(poses)} of {count} poses found with the whole board in view: a smaller board, or fewer")
