"""Make the rendered pictures of data/calibration: `python -m ir50p_lab.vision.calibration.make_pictures [folder]`."""

import sys
from pathlib import Path

import numpy as np

from ir50p_lab.vision.calibration.rendered import board_pictures, board_poses, board_scene
from ir50p_lab.vision.image import save_image
from ir50p_lab.vision.rendering import Ball, Board, Lens, Sensor, bench_camera, bench_scene, pose, render_scene

FOLDER = Path(__file__).parents[3] / "data" / "calibration"
TABLE_4_8 = ((0.4, -0.1), (0.3, 0.3), (0.5, 0.0), (0.4, 0.2))  # real places of the ball in the thesis, m
BOARD_AT = (0.32, 0.08)  # first corner of the board on the table, m in the base frame
_SENSOR = Sensor(jpeg=None)  # the file is the JPEG


def main(folder=FOLDER):
    """Write all the pictures: a good set with six useless ones among them, a bent board, the table."""
    camera, _ = bench_camera()
    folder = Path(folder)
    for part in ("flat", "bent", "table"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    for k, image in enumerate(board_pictures(camera, 14, seed=1, sensor=_SENSOR)[0]):
        write(folder / "flat" / f"board_{k + 1:02}.jpg", image)
    for name, image in useless(camera).items():
        write(folder / "flat" / f"{name}.jpg", image)
    for k, image in enumerate(board_pictures(camera, 10, seed=2, board=Board(bend=0.3), sensor=_SENSOR)[0]):
        write(folder / "bent" / f"board_{k + 1:02}.jpg", image)
    lying = Board(T_world_board=pose((*BOARD_AT, 0.0)) @ np.diag([1.0, -1.0, -1.0, 1.0]))
    write(folder / "table" / "board.jpg", render_scene(bench_scene(lying, sensor=_SENSOR), seed=31)[0])
    balls = [Ball(position=(x, y, 0.03)) for x, y in TABLE_4_8]
    write(folder / "table" / "balls.jpg", render_scene(bench_scene(*balls, sensor=_SENSOR), seed=32)[0])


def useless(camera):
    """Pictures that a calibration must leave out: name -> picture."""
    poses = board_poses(camera, 14, seed=1)

    def shot(T, board=None, lens=None, pinhole=camera, seed=40):
        return render_scene(board_scene(pinhole, T, board, lens, _SENSOR), seed=seed)[0]

    aside = poses[4].copy()
    aside[0, 3] += 0.45 * aside[2, 3]
    return {
        "cropped": shot(aside),
        "blurred": shot(poses[5], lens=Lens(motion=(26, 12))),
        "duplicate": shot(poses[2], seed=41),
        "wrong_board": shot(poses[6], Board(pattern=(8, 5))),
        "other_size": shot(poses[7], pinhole=camera.scaled((320, 240))),
        "no_board": render_scene(bench_scene(sensor=_SENSOR), seed=42)[0],
    }


def write(path, image):
    """A JPEG that says it is rendered."""
    save_image(path, image, rendered=True, quality=92)


if __name__ == "__main__":
    main(*sys.argv[1:2])
