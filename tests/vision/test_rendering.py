"""Rendered pictures against their truth, by routes that share no code with the renderer."""

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import InputError
from ir50p_lab.vision.rendering import Ball, Board, Table, bench_scene, pose, random_scene, render_scene, scene_truth

PLAIN = Table(texture="plain", contrast=0.0)
ON_TABLE = np.diag([1.0, -1.0, -1.0, 1.0])


def test_same_seed_same_bytes():
    scene = bench_scene()
    first, other = render_scene(scene, seed=3)[0], render_scene(scene, seed=4)[0]
    assert first.shape == (480, 640, 3) and first.dtype == np.uint8
    assert (first == render_scene(scene, seed=3)[0]).all() and (first != other).any()


def test_corners_agree_with_opencv():
    board = Board(T_world_board=pose((0.28, 0.08, 0.0)) @ ON_TABLE)
    image, truth = render_scene(bench_scene(board, table=PLAIN).clean())
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    found, corners = cv2.findChessboardCorners(grey, (9, 6))
    assert found
    corners = cv2.cornerSubPix(grey, corners, (4, 4), (-1, -1), (cv2.TERM_CRITERIA_EPS, 100, 1e-4))[:, 0]
    if np.linalg.norm(corners[0] - truth.boards[0].corners[0]) > 20:  # the finder may start at the other end
        corners = corners[::-1]
    assert np.abs(corners - truth.boards[0].corners).max() < 0.15
    assert truth.boards[0].inside.all()


def test_refuses_what_is_no_scene():
    with pytest.raises(InputError, match="bench_scene"):
        render_scene(Ball())


@pytest.mark.parametrize("kind", ["ball", "no_ball", "several", "hidden"])
def test_scenes_keep_what_their_kind_promises(kind):
    for seed in range(12):
        truth = scene_truth(random_scene(seed, kind))
        red = truth.red_balls
        if kind == "no_ball":
            assert not red and (truth.scene.objects or truth.scene.patches)
            continue
        low, high = (0.2, 0.6) if kind == "hidden" else (0.6, 1.01)
        assert red and all(low <= ball.visible < high and 8 <= ball.radius <= 80 for ball in red)
