"""Make the rendered pictures of data/calibration and data/scenes: `python -m tests.support.make_pictures [folder]`."""

import json
import sys
from pathlib import Path

import numpy as np

from ir50p_lab.vision.calibration.rendered import board_poses
from ir50p_lab.vision.image import save_image
from ir50p_lab.vision.rendering import SceneBall, Sensor, bench_camera, bench_scene, pose, render_scene
from tests.support.desk import BentBoard, ShakenLens
from tests.support.drawn_board import Board, board_scene
from tests.support.random_scene import random_scene
from tests.support.scene_truth import scene_truth

FOLDER = Path(__file__).parents[2] / "data"
TABLE_4_8 = ((0.4, -0.1), (0.3, 0.3), (0.5, 0.0), (0.4, 0.2))  # real places of the ball in the thesis, m
BOARD_AT = (0.32, 0.08)  # first corner of the board on the table, m in the base frame
_SENSOR = Sensor(jpeg=None)  # the file is the JPEG
SCENES = range(70_000, 70_008)  # on which the classifier was not trained


def main(folder=FOLDER, only=None):
    """Write the pictures of `recipes`, and the truth of the random scenes; only: names of some of them."""
    truths = {}
    for name, (scene, seed) in recipes().items():
        if only is None or name in only:
            path = Path(folder) / f"{name}.jpg"
            path.parent.mkdir(parents=True, exist_ok=True)
            image, truth = render_scene(scene, seed=seed)
            save_image(path, image, rendered=True, quality=92)
            if name.startswith("scenes/"):
                ball = scene_truth(truth.scene).red_balls[0]
                truths[path.name] = {"x": round(ball.x, 3), "y": round(ball.y, 3), "radius": round(ball.radius, 3)}
    if truths:
        (Path(folder) / "scenes" / "truth.json").write_text(json.dumps(truths, indent=1) + "\n", "utf-8")


def recipes():
    """name -> (Scene, seed): a good set with six useless pictures among them, a bent board, one with markers, the table; random scenes."""
    camera, _ = bench_camera()
    good, bent = board_poses(camera, 14, seed=1), BentBoard(bend=0.3)
    found = {f"calibration/flat/board_{k + 1:02}": (_held(camera, T), 1000 + k) for k, T in enumerate(good)}
    found |= {f"calibration/flat/{name}": recipe for name, recipe in _useless(camera, good).items()}
    for k, T in enumerate(board_poses(camera, 10, 2, bent)):
        found[f"calibration/bent/board_{k + 1:02}"] = _held(camera, T, bent), 2000 + k
    marked = Board(kind="charuco")
    for k, T in enumerate(board_poses(camera, 7, 4, marked)):
        found[f"calibration/charuco/board_{k + 1:02}"] = _held(camera, T, marked), 4000 + k
    lying = Board(T_world_board=pose((*BOARD_AT, 0.0)) @ np.diag([1.0, -1.0, -1.0, 1.0]))
    balls = [SceneBall(position=(x, y, 0.03)) for x, y in TABLE_4_8]
    found["calibration/table/board"] = bench_scene(lying, sensor=_SENSOR), 31
    found["calibration/table/balls"] = bench_scene(*balls, sensor=_SENSOR), 32
    found |= {f"scenes/{seed}": (random_scene(seed, "ball"), seed) for seed in SCENES}
    return found


def _held(camera, T, board=None, lens=None):
    return board_scene(camera, T, board, lens, _SENSOR)


def _useless(camera, poses):
    """Pictures that a calibration must leave out: name -> (Scene, seed)."""
    aside = poses[4].copy()
    aside[0, 3] += 0.45 * aside[2, 3]
    return {
        "cropped": (_held(camera, aside), 40),
        "blurred": (_held(camera, poses[5], lens=ShakenLens(motion=(26, 12))), 40),
        "duplicate": (_held(camera, poses[2]), 41),
        "wrong_board": (_held(camera, poses[6], Board(pattern=(8, 5))), 40),
        "other_size": (_held(camera.scaled((320, 240)), poses[7]), 40),
        "no_board": (bench_scene(sensor=_SENSOR), 42),
    }


if __name__ == "__main__":
    main(*sys.argv[1:2])
