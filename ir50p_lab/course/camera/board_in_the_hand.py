"""Appendix A2: a board that the hand holds up to a camera on its stand."""

from typing import NamedTuple

import numpy as np

from ir50p_lab.modelling import IR50P, frames
from ir50p_lab.vision import board_points, board_pose
from ir50p_lab.vision.board_pose import inverse_transform, transform
from ir50p_lab.vision.rendering import bench_camera

T_HAND_BOARD = transform((0.3, 1.2, 0.2), (0.02, -0.06, -0.05))


class Session(NamedTuple):
    """Poses (n, 3) rad, the board as the camera saw it in them (n, 4, 4), and the camera's true place (4, 4)."""

    poses: np.ndarray
    T_cam_board: np.ndarray
    T_base_cam: np.ndarray


def board_in_the_hand(poses=15, *, noise=0.1, seed=0):
    """Return a Session of `poses` poses of the IR50P with the whole board in the picture, corners with `noise` px."""
    rng, (camera, T_cam_base) = np.random.default_rng(seed), bench_camera()
    points, found, seen = board_points(T_table_board=np.eye(4)), [], []
    while len(found) < poses:
        q = rng.uniform([-0.7, 0.1, -1.9], [0.7, 1.1, -0.4])
        T = frames(IR50P, q)[3] @ T_HAND_BOARD
        corners = camera.project(T_cam_base, points @ T[:3, :3].T + T[:3, 3]) + rng.normal(0, noise, (len(points), 2))
        if (corners > 0).all() and (corners < camera.size).all():
            found.append(q)
            seen.append(board_pose(camera, corners, points)[0])
    return Session(np.array(found), np.array(seen), inverse_transform(T_cam_base))
