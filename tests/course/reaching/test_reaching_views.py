"""What notebook 18 is given: figures that show their numbers, copies of the arm, clicks that lay a ball."""

import numpy as np
import pytest
from matplotlib.text import Text

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course import LiveArm
from ir50p_lab.course import reaching as views
from ir50p_lab.course.reaching import arms
from ir50p_lab.errors import NotMeasuredError, VisionError
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import RenderedBench

BALL = np.array([0.42, -0.15, 0.03])


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))


def text_of(figure):
    figure.canvas.draw()
    return " ".join(text.get_text() for text in figure.findobj(Text))


def test_tips_are_drawn_as_the_lens_sees_them_and_along_its_line():
    goal, lens = np.array([0.4, 0.0, 0.1]), np.array([1.4, 0.0, 0.1])  # it looks along -x
    tips = goal + 0.001 * np.array([[[5, 2, 3], [5, 0, 0]]])
    figure = views.looks_figure(tips, goal, lens)
    seen, along = figure.axes
    assert np.allclose(seen.lines[1].get_xydata(), [[2, 3]])  # right of the camera is +y of the base
    assert np.allclose(along.lines[2].get_xydata(), [[-5, 0]])
    assert "simulated" in text_of(figure)


def test_a_copy_is_reached_for_by_what_it_is_given():
    def where(bench, watch):
        return bench.plant.tip_true - watch.balls_true[0]

    there = views.on_copies(where, IR50P, range(2), BALL)
    assert there.shape == (2, 3) and np.allclose(there[0], there[1])  # both at rest

    def place(bench, watch):
        return bench.calibration.stderr_slope is not None, watch.scene.T_cam_world[0, 3]

    plain, turned = (
        views.on_copies(place, IR50P, [3], BALL, calibrated=known, knocked=knocked)[0]
        for known, knocked in ((False, (0, 0, 0)), (True, (0, 1, 0)))
    )
    assert not plain[0] and turned[0]
    assert abs(plain[1] - turned[1]) == pytest.approx(np.sin(np.radians(1)), abs=0.02)  # 1 m or so away


def test_a_calibrated_copy_shows_its_angles_within_two_counts():
    plant = SimulatedBench(IR50P, seed=4, record_to=False).plant
    line = arms._calibration(plant)
    plant.place(q := np.array([0.3, 0.5, -0.9]))
    counts = np.mean([plant.counts() for _ in range(50)], axis=0)
    assert np.abs(line.counts(q) - counts).max() < 2


def test_a_click_lays_the_ball_and_the_hand_follows_what_the_eye_says():
    bench = SimulatedBench(IR50P, q0=rest_pose(IR50P), record_to=False)
    watch, hand = RenderedBench(bench, BALL), LiveArm(IR50P, rest_pose(IR50P))
    answers = [np.array([0.1, 0.2, -0.3]), None]
    view = views.follow_clicks(hand, watch, views.camera_for(bench), lambda picture, q: answers.pop(0))
    view._clicked(0.5, 0.5)
    assert np.allclose(hand.q, [0.1, 0.2, -0.3]) and watch.balls_true[0, 2] == pytest.approx(0.03)
    assert np.abs(watch.balls_true[0] - BALL).max() > 0.02
    view._clicked(0.9, 0.9)
    assert np.allclose(hand.q, rest_pose(IR50P)) and "None" in view.status.value


def test_a_camera_of_before_is_refused_with_the_remedy(monkeypatch):
    known = type("Camera", (), {"T_base_cam": None})
    monkeypatch.setattr(arms, "load_result", lambda *_, **__: known)
    with pytest.raises(NotMeasuredError, match="notebook 17"):
        views.camera_for(None)


def test_no_circle_is_no_pixel_and_none_is_no_way():
    with pytest.raises(VisionError, match="no ball is seen"):
        views.path(rest_pose(IR50P), None)
    with pytest.raises(VisionError, match="no circle"):
        views.seen_circle(np.zeros((60, 80), dtype=bool), [8, 9])
