"""The rings of A2 hold the pivots that the angles say."""

import numpy as np
import pytest

from ir50p_lab.course.kinematics.gimbal_view import GimbalView
from ir50p_lab.modelling.pose import rotation_from_angles


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
    turned = view._brick.corners.copy()
    view._brick.update(rotation_from_angles(sequence, angles))
    np.testing.assert_allclose(turned, view._brick.corners)


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
