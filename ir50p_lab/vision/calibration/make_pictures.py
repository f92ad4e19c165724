"""Make the rendered pictures of data/calibration: `python -m ir50p_lab.vision.calibration.make_pictures [folder]`."""

import sys
from pathlib import Path

import numpy as np

from ir50p_lab.vision.calibration.rendered import board_poses, board_scene
from ir50p_lab.vision.image import save_image
from ir50p_lab.vision.rendering import Ball, Board, Lens, Sensor, bench_camera, bench_scene, pose, render_scene

FOLDER = Path(__file__).parents[3] / "data" / "calibration"
TABLE_4_8 = ((0.4, -0.1), (0.3, 0.3), (0.5, 0.0), (0.4, 0.2))  # real places of the ball in the thesis, m
BOARD_AT = (0.32, 0.08)  # first corner of the board on the table, m in the base frame
_SENSOR = Sensor(jpeg=None)  # the file is the JPEG


def main(folder=FOLDER, only=None):
    """Write the pictures of `recipes`; only: names of some of them."""
    for name, (scene, seed) in recipes().items():
        if only is None or name in only:
            path = Path(folder) / f"{name}.jpg"
            path.parent.mkdir(parents=True, exist_ok=True)
            save_image(path, render_scene(scene, seed=seed)[0], rendered=True, quality=92)


def recipes():
    """name -> (Scene, seed): a good set with six useless pictures among them, a bent board, the table."""
    camera, _ = bench_camera()
    good, bent = board_poses(camera, 14, seed=1), Board(bend=0.3)
    found = {f"flat/board_{k + 1:02}": (_held(camera, T), 1000 + k) for k, T in enumerate(good)}
    found |= {f"flat/{name}": recipe for name, recipe in _useless(camera, good).items()}
    for k, T in enumerate(board_poses(camera, 10, 2, bent)):
        found[f"bent/board_{k + 1:02}"] = _held(camera, T, bent), 2000 + k
    lying = Board(T_world_board=pose((*BOARD_AT, 0.0)) @ np.diag([1.0, -1.0, -1.0, 1.0]))
    balls = [Ball(position=(x, y, 0.03)) for x, y in TABLE_4_8]
    found["table/board"] = bench_scene(lying, sensor=_SENSOR), 31
    found["table/balls"] = bench_scene(*balls, sensor=_SENSOR), 32
    return found


def _held(camera, T, board=None, lens=None):
    return board_scene(camera, T, board, lens, _SENSOR)


def _useless(camera, poses):
    """Pictures that a calibration must leave out: name -> (Scene, seed)."""
    aside = poses[4].copy()
    aside[0, 3] += 0.45 * aside[2, 3]
    return {
        "cropped": (_held(camera, aside), 40),
        "blurred": (_held(camera, poses[5], lens=Lens(motion=(26, 12))), 40),
        "duplicate": (_held(camera, poses[2]), 41),
        "wrong_board": (_held(camera, poses[6], Board(pattern=(8, 5))), 40),
        "other_size": (_held(camera.scaled((320, 240)), poses[7]), 40),
        "no_board": (bench_scene(sensor=_SENSOR), 42),
    }


if __name__ == "__main__":
    main(*sys.argv[1:2])
