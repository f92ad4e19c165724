"""Figures of notebook 18: they say what is simulated, and show the numbers they are given."""

import numpy as np
import pytest
from matplotlib.text import Text

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course.reaching import views
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import Seen, TablePlane
from ir50p_lab.vision.board_pose import inverse_transform
from ir50p_lab.vision.reaching.reach_result import FollowLog
from ir50p_lab.vision.rendering import bench_camera

CAMERA, T_CAM_BASE = bench_camera()
T_BASE_CAM = inverse_transform(T_CAM_BASE)
PLANE = TablePlane(CAMERA, T_CAM_BASE)
BALL = np.array([0.40, 0.05, 0.03])


def text_of(figure):
    figure.canvas.draw()
    return " ".join(text.get_text() for text in figure.findobj(Text))


def test_frames_name_their_parts():
    board = np.diag([1.0, -1, -1, 1])
    text = text_of(views.frames_figure(IR50P, rest_pose(IR50P), T_BASE_CAM, BALL, board, True))
    assert all(name in text for name in ("{0}", "{c}", "{ob}", "board", "rendered picture, simulated arm"))
    text = text_of(views.frames_figure(IR50P, rest_pose(IR50P), T_BASE_CAM, BALL, board, False))
    assert "photograph, real arm" in text


def test_what_is_seen_is_written_beside_it():
    ball = type("Ball", (), {"x": 300.0, "y": 200.0, "radius": 25.0})
    image = np.zeros((480, 640, 3), np.uint8)
    seen = Seen(BALL, ball, image, True)
    text = text_of(views.seen_figure(seen, IR50P, rest_pose(IR50P), T_BASE_CAM, (310.0, 150.0)))
    assert "Ball at (300.0, 200.0) px" in text and "(400, 50, 30) mm" in text
    assert "Ball at" not in text_of(
        views.seen_figure(Seen(None, None, image, True, "none"), IR50P, rest_pose(IR50P), T_BASE_CAM)
    )


def test_the_height_moves_the_reading():
    xy = CAMERA.project(T_CAM_BASE, BALL)
    figure, update = views.height_figure(PLANE, BALL, xy)
    assert "(400.0, 50.0) mm" in update(30.0) and "+0.0 mm off" in text_of(figure)
    update(0.0)
    (off,) = (float(word) for word in text_of(figure).split() if word.startswith("+"))
    assert off == pytest.approx(1e3 * np.linalg.norm(PLANE.to_table(xy, 0.0) - BALL[:2]), abs=0.1)


def test_following_shows_how_far_the_tip_is_ahead():
    t = np.linspace(0, 4, 401)
    ball, velocity = np.column_stack([0.4 + 0 * t, 0.02 * t]), np.tile([0.0, 0.02], (len(t), 1))
    velocity[::50] = 0.0  # where it stands there is no ahead
    tips = [np.column_stack([ball + np.array([0.003, ahead]), 0.1 + 0 * t]) for ahead in (0.005, -0.001)]
    logs = [FollowLog(t, tip, ball, velocity, lead) for tip, lead in zip(tips, (0.25, 0.0), strict=True)]
    figure = views.follow_figure(logs, True)
    text = text_of(figure)
    assert "lead 0.25 s" in text and "lead 0 s" in text and "lead × speed" in text
    thick = [line.get_ydata() for line in figure.axes[1].lines if line.get_linewidth() == 2]
    assert np.allclose(thick[0], 5.0) and np.allclose(thick[1], -1.0)
