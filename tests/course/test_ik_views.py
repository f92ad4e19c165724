"""What the moving pictures of notebook 02 show is what the kinematics says."""

import numpy as np
import pytest

from ir50p_lab.course.figures import new_figure
from ir50p_lab.course.ik_views import BranchesView, ColumnsView, EllipseView, StepsView, WayOutView, workspace_figure
from ir50p_lab.modelling import IR50P, THESIS_RODS, forward_kinematics, inverse_kinematics

Q = np.array([0.4, 0.9, -1.3])


@pytest.mark.parametrize("arm", [IR50P, THESIS_RODS], ids=lambda arm: arm.name)
def test_arrows_point_where_the_tip_goes(arm):
    columns = ColumnsView(new_figure(projection="3d").axes[0], arm, scale=0.5)
    Jv = columns.update(Q)
    tip = forward_kinematics(arm, Q)
    for k, arrow in enumerate(columns.arrows):
        start, end = np.column_stack(arrow.get_data_3d())[:2]
        np.testing.assert_allclose(start, tip, atol=1e-12)
        moved = forward_kinematics(arm, Q + 1e-6 * np.eye(3)[k]) - tip
        np.testing.assert_allclose(end - start, 0.5 * moved / 1e-6, atol=1e-5)
        np.testing.assert_allclose(Jv[:, k], moved / 1e-6, atol=1e-5)


def test_the_ellipse_holds_the_velocities_of_unit_joint_rates():
    figure = new_figure()
    ellipse = EllipseView(figure.axes[0], IR50P, scale=1.0)
    fast, slow = ellipse.update(*Q[1:])
    curve = ellipse._curve.get_xy()
    pose = np.array([0.0, *Q[1:]])
    tip = forward_kinematics(IR50P, pose)[[0, 2]]
    turn = np.linspace(0, 2 * np.pi, 50)
    rates = np.column_stack([0 * turn, np.cos(turn), np.sin(turn)])
    moved = (forward_kinematics(IR50P, pose + 1e-6 * rates)[:, [0, 2]] - tip) / 1e-6
    speeds = np.linalg.norm(moved, axis=1)
    assert speeds.max() == pytest.approx(fast, rel=5e-3) and speeds.min() == pytest.approx(slow, rel=5e-2)
    drawn = np.linalg.norm(curve - tip, axis=1)
    assert drawn.max() == pytest.approx(fast, rel=5e-3) and drawn.min() == pytest.approx(slow, rel=5e-2)
    for v in moved:  # every velocity lies on the curve, up to its corners
        assert np.linalg.norm(curve - tip - v, axis=1).min() < 0.03
    for axis, length in zip(ellipse._axes, (fast, slow), strict=True):
        ends = np.column_stack(axis.get_data())
        assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(2 * length)


def test_the_ellipse_of_a_stretched_arm_is_a_line():
    ellipse = EllipseView(new_figure().axes[0], IR50P)
    assert ellipse.update(0.4, 0.0)[1] < 1e-12


@pytest.mark.parametrize("branch", ["front/up", "front/down", "back/up", "back/down"])
def test_the_chosen_branch_is_drawn_and_the_other_elbow_behind_it(branch):
    view, p = BranchesView(IR50P), np.array([0.30, 0.20, 0.40])
    said = view.update(p, branch)
    solutions = inverse_kinematics(IR50P, p)
    np.testing.assert_allclose(view.view.q, solutions[branch])
    np.testing.assert_allclose(view.view.points[3], p, atol=1e-12)
    np.testing.assert_allclose(view.ghost.points[3], p, atol=1e-12)
    assert np.linalg.norm(view.ghost.points[2] - view.view.points[2]) > 0.01
    assert f"{np.degrees(solutions[branch][2]):.1f}" in said
    assert ("within" in said) == bool(solutions.within_limits[solutions.branches.index(branch)])
    full = [shape._line.get_alpha() == 1.0 for shape in view.shapes]
    assert sum(full) == 1
    elbow = view.view.points[2]
    drawn = view.shapes[full.index(True)].points[1]
    np.testing.assert_allclose(drawn, [elbow[:2] @ p[:2] / np.hypot(*p[:2]), elbow[2]], atol=1e-12)
    for shape in view.shapes:
        np.testing.assert_allclose(shape.points[2], [np.hypot(*p[:2]), p[2]], atol=1e-12)


def test_a_target_out_of_reach_hides_the_arm_and_says_how_far():
    view = BranchesView(IR50P)
    assert view.update(np.array([0.672, 0.0, 0.285]), "front/up") == "out of reach by 0.100 m"
    assert not any(fill.get_visible() for _, fill in view.view._links)
    assert not view.shapes[0]._line.get_visible() and view.view._target.get_visible()
    view.update(np.array([0.4, 0.0, 0.285]), "front/up")
    assert all(fill.get_visible() for _, fill in view.view._links)
    assert all(axis.get_visible() for axis in view.view._frames[3].axes)


def test_a_target_given_by_heading_distance_and_height():
    view = BranchesView(IR50P)
    assert view.aim("front/up", 90, 0.3, 0.4) == view.update(np.array([0.0, 0.3, 0.4]), "front/up")
    np.testing.assert_allclose(view.view.points[3], [0, 0.3, 0.4], atol=1e-12)


def test_way_out_shows_arm_and_rates_of_one_place():
    q = np.array([[0, 0.5, -1.0], [0, 0.3, -0.6], [0, 0.1, -0.2]])
    reach = forward_kinematics(IR50P, q)[:, 0]
    rates = np.array([[0, 1.0, -2.0], [0, 2.0, -4.0], [0, 4.0, -8.0]])
    view = WayOutView(IR50P, reach, q, rates)
    for share, k in ((0, 0), (50, 1), (100, 2)):
        said = view.update(share)
        assert f"{1000 * (IR50P.reach - reach[k]):.2f} mm" in said and f"at {-rates[k, 2]:.2f} rad/s" in said
        np.testing.assert_allclose(view.side.points[2, 0], reach[k])
        np.testing.assert_allclose(view.dots.get_data(), [[reach[k]] * 2, np.abs(rates[k, 1:])])
    drawn = [line.get_ydata() for line in view.figure.axes[1].lines[:2]]
    np.testing.assert_allclose(drawn, np.abs(rates[:, 1:]).T)


def test_workspace_shows_every_tip():
    q = np.array([[0.4, 0.9, -1.3], [0.4, 0.2, 0.3]])
    tips = forward_kinematics(IR50P, q)
    outwards = np.hypot(*tips[:, :2].T)
    ax = workspace_figure(IR50P, q[0], outwards, tips[:, 2]).axes[0]
    (dots,) = [line for line in ax.lines if line.get_marker() == "."]
    np.testing.assert_allclose(np.column_stack(dots.get_data()), np.column_stack([outwards, tips[:, 2]]))
    arm = next(line for line in ax.lines if line.get_marker() == "o" and len(line.get_xdata()) == 3)
    np.testing.assert_allclose(np.column_stack(arm.get_data())[2], [outwards[0], tips[0, 2]])  # ends in its dot


def test_steps_stay_on_the_axis():
    view = StepsView(3)
    view.update([1.0, 1e-3, 0.0], [1.0, 0.1, 0.01])
    plain, damped = (curve.get_ydata() for curve in view.curves)
    assert plain.tolist() == [1.0, 1e-3, 1e-16] and damped.tolist() == [1.0, 0.1, 0.01]
