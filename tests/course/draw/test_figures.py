"""Figures: the style is local, figures show themselves, and what is drawn is where the kinematics says."""

import html
import io

import matplotlib
import numpy as np
import pytest
from PIL import Image

from ir50p_lab.bench import Recording
from ir50p_lab.course.draw.arm3d import ArmView, SideView
from ir50p_lab.course.draw.style import figure_style, new_figure, origin, subplots
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, Arm, forward_kinematics, frames

OTHER = Arm(l=(0.12, 0.35, 0.25), m=(2, 1, 0.5), lc=(0.06, 0.1, 0.1), Ixx=(0.01,) * 3, Iyy=(0.01,) * 3, Izz=(0.01,) * 3)
ARMS = [IR50P, OTHER]
POSES = [(0.4, 0.9, -1.3), (-2.0, 2.2, 0.7)]


def test_a_new_figure_leaves_matplotlib_as_it_was():
    before = dict(matplotlib.rcParams)
    figure = new_figure(rows=2, cols=2)
    figure._repr_png_()
    assert dict(matplotlib.rcParams) == before
    figure_style()["axes.grid"] = "spoilt"
    assert figure_style()["axes.grid"] is True


def test_a_recording_says_where_it_is_from():
    t, q = [0, 1], np.zeros((2, 3))
    assert origin(Recording.from_arrays(t, q)) == "origin unknown"
    assert origin(Recording.from_arrays(t, q, header={"simulated": "true"})) == "simulated arm"
    assert origin(Recording.from_arrays(t, q, header={"simulated": "false"})) == "the real arm"


def test_a_figure_shows_itself_sharp_and_at_its_own_size():
    figure = new_figure(3, 2)
    data, size = figure._repr_png_()
    assert Image.open(io.BytesIO(data)).size == (600, 400)
    assert (size["width"], size["height"]) == (300, 200)


def test_a_figure_says_what_it_shows():
    figure, ax = subplots(3, 2)
    ax.plot([0, 1], [0, 1], label="joint <2>")
    ax.set(title="It rises at $t$", xlabel="time [s]", ylabel="angle [rad]")
    ax.legend()
    words = "It rises at t. angle [rad] against time [s]. joint <2>"
    data, about = figure._repr_mimebundle_()
    assert about["image/png"]["alt"] == words
    assert f'alt="{html.escape(words)}"' in data["text/html"] and data["image/png"] in data["text/html"]


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
@pytest.mark.parametrize("q", POSES)
def test_the_arm_is_drawn_where_forward_kinematics_says(arm, q):
    view = ArmView(new_figure(projection="3d").axes[0], arm, frames=True)
    view.update(q)
    l1, l2, l3 = arm.l
    ends = [np.column_stack(fill.get_data_3d()) for _, fill in view._links]
    foot, shoulder, elbow, tip = ends[0][0], *(end[1] for end in ends)
    np.testing.assert_allclose(foot, 0, atol=1e-12)
    np.testing.assert_allclose(shoulder, [0, 0, l1], atol=1e-12)
    np.testing.assert_allclose(tip, forward_kinematics(arm, q), atol=1e-12)
    assert np.linalg.norm(elbow - shoulder) == pytest.approx(l2)
    assert np.linalg.norm(tip - elbow) == pytest.approx(l3)
    np.testing.assert_allclose([foot, shoulder, elbow, tip], view.points, atol=1e-12)
    shadow = np.column_stack(view._shadow.get_data_3d())
    np.testing.assert_allclose(shadow[-1], [*tip[:2], 0], atol=1e-12)


def test_frames_of_the_view_are_those_of_the_arm():
    view = ArmView(new_figure(projection="3d").axes[0], IR50P, frames=True)
    q = (0.4, 0.9, -1.3)
    view.update(q)
    for shown, T in zip(view._frames.values(), frames(IR50P, q), strict=True):
        for k, axis in enumerate(shown.axes):
            origin, end = np.column_stack(axis.get_data_3d())[:2]
            np.testing.assert_allclose(origin, T[:3, 3], atol=1e-12)
            np.testing.assert_allclose((end - origin) / np.linalg.norm(end - origin), T[:3, k], atol=1e-12)


def test_nearer_parts_cover_farther_ones():
    ax = new_figure(projection="3d").axes[0]
    view = ArmView(ax, IR50P)
    ax.view_init(elev=10, azim=0)  # the eye is on the x axis
    view.update((0, 0.3, -0.3))
    upper, fore = (view._links[k][1].get_zorder() for k in (1, 2))
    assert fore > upper
    view.update((np.pi, 0.3, -0.3))
    upper, fore = (view._links[k][1].get_zorder() for k in (1, 2))
    assert fore < upper
    for outline, fill in view._links:
        assert outline.get_zorder() < fill.get_zorder()


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
@pytest.mark.parametrize("q", POSES)
def test_the_side_view_is_the_arm_seen_from_the_side(arm, q):
    side = SideView(new_figure().axes[0], arm)
    side.update(q)
    tip = forward_kinematics(arm, q)
    c2, s2 = np.cos(q[1]), np.sin(q[1])
    np.testing.assert_array_equal(side.points, np.column_stack(side._line.get_data()))
    np.testing.assert_allclose(side.points[0], (0, arm.l[0]), atol=1e-12)
    np.testing.assert_allclose(side.points[1], (arm.l[1] * c2, arm.l[0] + arm.l[1] * s2), atol=1e-12)
    assert side.points[2, 1] == pytest.approx(tip[2])
    assert abs(side.points[2, 0]) == pytest.approx(np.hypot(*tip[:2]), abs=1e-12)


@pytest.mark.parametrize("q", [(0, 0), (0, np.nan, 0)])
def test_a_view_shows_one_finite_pose(q):
    view = ArmView(new_figure(projection="3d").axes[0], IR50P)
    with pytest.raises(InputError):
        view.update(q)
