"""The moving pictures of notebook 01 draw what the matrices say."""

import numpy as np
import pytest

from ir50p_lab.course.pose_views import Brick, GimbalView, space
from ir50p_lab.modelling.pose import homogeneous, rot_x, rot_z, rotation_from_angles


def test_space_has_equal_axes_and_three_names():
    bare = space(2).axes[1]
    assert bare.get_xlim() == bare.get_ylim() == bare.get_zlim() == (-1, 1)
    assert [text.get_text() for text in bare.texts] == ["x", "y", "z"]
    flat = space(2, flat_last=True).axes
    assert [ax.name for ax in flat] == ["3d", "rectilinear"]


def test_brick_follows_its_transform():
    edges = (0.8, 0.4, 0.2)
    brick = Brick(space().axes[0], edges=edges)
    assert brick.corners.shape == (6, 4, 3)
    np.testing.assert_allclose(np.ptp(brick.corners.reshape(-1, 3), axis=0), edges)
    still = brick.corners.copy()
    T = homogeneous(rot_z(np.pi / 2) @ rot_x(0.3), (0.1, 0.2, 0.3))
    brick.update(T)
    homogeneous_corners = np.concatenate([still, np.ones((6, 4, 1))], axis=-1)
    np.testing.assert_allclose(brick.corners, (homogeneous_corners @ T.T)[..., :3], atol=1e-15)


def gimbal():
    return GimbalView(*space(2, flat_last=True).axes)


def drawn(line):
    points = np.column_stack(line.get_data_3d())
    return points[np.isfinite(points).all(axis=1)]


@pytest.mark.parametrize("sequence", ["XYZ", "ZXZ"])
def test_rings_hold_two_pivots_and_the_brick_has_the_rotation(sequence):
    view = gimbal()
    angles = np.radians([60, 50, 35])
    view.update(sequence, angles)
    first, second, third = (drawn(pivot)[-1] for pivot in view._pivots)
    outer, inner = (drawn(ring) for ring in view._rings)
    for ring, pivots in ((outer, (first, second)), (inner, (second, third))):
        normal = np.cross(ring[0], ring[18])
        np.testing.assert_allclose(np.array(pivots) @ normal, 0, atol=1e-12)
    faces = Brick(space().axes[0], edges=(0.62, 0.38, 0.14))
    faces.update(homogeneous(rotation_from_angles(sequence, angles)))
    np.testing.assert_allclose(view._brick.corners, faces.corners)


def test_at_the_lock_first_and_third_pivot_are_in_line_and_the_axis_is_lost():
    view = gimbal()
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


def test_the_price_belongs_to_the_sequence():
    view = gimbal()
    view.update("XYZ", np.zeros(3))
    middle_deg, gain = view._curve.get_data()
    assert gain[middle_deg == 90] > 1e3 and gain[middle_deg == 0] == pytest.approx(1)
    view.update("ZYZ", np.radians([10, 40, 20]))
    middle_deg, gain = view._curve.get_data()
    assert gain[middle_deg == 0] > 1e3 and gain[middle_deg == 90] == pytest.approx(1)
    assert view._title.get_text() == "ZYZ is singular at 0 and 180 deg"
    assert view._dot.get_ydata()[0] == pytest.approx(gain[middle_deg == 40][0])
