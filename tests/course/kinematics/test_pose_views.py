"""The moving pictures of notebook 01 draw what the matrices say."""

import numpy as np
import pytest

from ir50p_lab.course.draw.style import subplots
from ir50p_lab.course.kinematics.pose_views import Brick, GimbalView, space, two_bricks
from ir50p_lab.modelling.pose import rot_x, rot_y, rot_z, rotation_from_angles


def space_axes():
    _, ax = subplots(4, 4, projection="3d")
    space(ax)
    return ax


def test_brick_turns_as_its_matrix():
    edges = (0.8, 0.4, 0.2)
    brick = Brick(space_axes(), edges=edges)
    assert brick.corners.shape == (6, 4, 3)
    np.testing.assert_allclose(np.ptp(brick.corners.reshape(-1, 3), axis=0), edges)
    still = brick.corners.copy()
    for face in still:  # each lies flat, on its side of the middle
        assert sorted(np.ptp(face, axis=0))[0] == 0 and (np.abs(face) == np.array(edges) / 2).all()
    R = rot_z(np.pi / 2) @ rot_x(0.3)
    brick.update(R)
    np.testing.assert_allclose(
        brick.corners.reshape(-1, 3), [R @ corner for corner in still.reshape(-1, 3)], atol=1e-15
    )


def test_two_orders_end_apart():
    space_of = two_bricks(np.pi / 2).axes
    assert len(space_of) == 4 and all(ax.get_xlim() == (-1, 1) for ax in space_of)
    turns = rot_x(np.pi / 2) @ rot_y(np.pi / 2), rot_y(np.pi / 2) @ rot_x(np.pi / 2)
    for ax, R in zip(space_of[1:3], turns, strict=True):
        ends = [np.column_stack(line.get_data_3d())[1] for line in ax.lines[3:6]]  # of the frame, after x, y, z
        np.testing.assert_allclose(np.array(ends).T, 0.55 * R, atol=1e-12)


def drawn(line):
    points = np.column_stack(line.get_data_3d())
    return points[np.isfinite(points).all(axis=1)]


@pytest.mark.parametrize("sequence", ["XYZ", "ZXZ"])
def test_rings_hold_two_pivots_and_the_brick_has_the_rotation(sequence):
    view = GimbalView()
    angles = np.radians([60, 50, 35])
    view.update(sequence, angles)
    first, second, third = (drawn(pivot)[-1] for pivot in view._pivots)
    outer, inner = (drawn(ring) for ring in view._rings)
    for ring, pivots in ((outer, (first, second)), (inner, (second, third))):
        normal = np.cross(ring[0], ring[18])
        np.testing.assert_allclose(np.array(pivots) @ normal, 0, atol=1e-12)
    faces = Brick(space_axes(), edges=(0.62, 0.38, 0.14))
    faces.update(rotation_from_angles(sequence, angles))
    np.testing.assert_allclose(view._brick.corners, faces.corners)


def test_at_the_lock_first_and_third_pivot_are_in_line_and_the_axis_is_lost():
    view = GimbalView()
    view.update("XYZ", np.radians([60, 90, 35]))
    first, _, third = (drawn(pivot)[-1] for pivot in view._pivots)
    np.testing.assert_allclose(np.cross(first, third), 0, atol=1e-12)
    assert view.gain == np.inf
    assert view._lost_label.get_text() == "lost"
    assert view._dot.get_ydata()[0] < np.inf
    view.update("XYZ", np.radians([60, 80, 35]))
    assert view._lost_label.get_text() == "hard" and len(drawn(view._lost)) == 2
    view.update("XYZ", np.radians([60, 10, 35]))
    assert view._lost_label.get_text() == "" and len(drawn(view._lost)) == 0
