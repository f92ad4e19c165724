"""Rendered pictures of a board held before a camera, for trying a calibration where the truth is known."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.pinhole import as_pinhole
from ir50p_lab.vision.rendering import Board, Lens, Scene, Sensor, Sky, Sun, bench_camera, render_scene

_WINDOW = (0.36, 0.92)  # part of the picture's width that the board fills
_TILTS_DEG = (8, 42)


def board_poses(pinhole, count, seed=0, board=None):
    """T_cam_board (count, 4, 4): a board all over the picture, tilted in all directions, fully in view.

    pinhole: Pinhole or Calibration; seed: of the generator; board: rendering.Board.
    Raises InputError if no such poses are found.
    """
    import cv2

    pinhole = as_pinhole(pinhole)
    board, rng, poses = board or Board(), np.random.default_rng(seed), []
    columns, rows = board.pattern
    s = board.square
    outline = s * np.array([[-1.0, -1], [columns, -1], [columns, rows], [-1, rows]])
    middle = np.array([(columns - 1) / 2, (rows - 1) / 2, 0.0]) * s
    w, h = pinhole.size
    for _ in range(400 * count):
        tilt, about, spin = np.deg2rad(rng.uniform(*_TILTS_DEG)), rng.uniform(0, 2 * np.pi), rng.normal(0, 0.25)
        R = cv2.Rodrigues(tilt * np.array([np.cos(about), np.sin(about), 0]))[0] @ cv2.Rodrigues((0, 0, spin))[0]
        width = rng.uniform(*_WINDOW) * w
        aim = pinhole.to_normalised(np.array([rng.uniform(0.12, 0.88) * w, rng.uniform(0.12, 0.88) * h]))
        T = np.eye(4)
        Z = pinhole.fx * columns * s / width
        T[:3, :3], T[:3, 3] = R, np.array([*aim, 1.0]) * Z - R @ middle
        corners = np.column_stack([outline, np.zeros(4)]) @ R.T + T[:3, 3]
        if corners[:, 2].min() < 0.3 * Z:
            continue
        xy = pinhole.project(T, np.column_stack([outline, np.zeros(4)]))
        if (xy > 2).all() and (xy < np.array([w, h]) - 3).all():
            poses.append(T)
        if len(poses) == count:
            return np.array(poses)
    raise InputError(
        f"{len(poses)} of {count} poses found in which the whole board is in view: a smaller board, or fewer"
    )


def board_scene(pinhole, T_cam_board, board=None, lens=None, sensor=None):
    """Scene of a board before the camera, no table: lit from behind the camera. Returns: rendering.Scene."""
    from dataclasses import replace

    _, T_cam_world = bench_camera()
    T_world_cam = np.linalg.solve(T_cam_world, np.eye(4))
    towards = T_world_cam[:3, :3] @ np.array([-0.3, -0.5, -1.0])  # up left behind the camera
    return Scene(
        pinhole=pinhole,
        T_cam_world=T_cam_world,
        objects=(replace(board or Board(), T_world_board=T_world_cam @ T_cam_board),),
        table=None,
        lights=(Sky(strength=0.4), Sun(towards=tuple(towards), strength=0.5)),
        lens=lens or Lens(),
        sensor=sensor or Sensor(),
    )


def board_pictures(pinhole, count, seed=0, *, board=None, lens=None, sensor=None):
    """`count` rendered pictures (h, w, 3) of a board in different poses, and their SceneTruth: (list, list).

    Args: pinhole: Pinhole of the camera to be found; seed: of poses and noise; board: rendering.Board (bent, ChArUco);
    lens, sensor: rendering.Lens and Sensor (blur, noise, JPEG).
    """
    pairs = [
        render_scene(board_scene(pinhole, T, board, lens, sensor), seed=1000 * seed + k)
        for k, T in enumerate(board_poses(pinhole, count, seed, board))
    ]
    return [image for image, _ in pairs], [truth for _, truth in pairs]
