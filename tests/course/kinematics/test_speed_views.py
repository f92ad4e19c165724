"""What the moving pictures of notebook 03 show is what the kinematics says."""

import numpy as np
import pytest

from ir50p_lab.course.draw.style import new_figure
from ir50p_lab.course.kinematics.speed_views import ColumnsView, pace
from ir50p_lab.modelling import IR50P, THESIS_RODS, forward_kinematics, jacobian

Q = np.array([0.4, 0.9, -1.3])


@pytest.mark.parametrize("arm", [IR50P, THESIS_RODS], ids=lambda arm: arm.name)
def test_arrows_point_where_the_tip_goes(arm):
    columns = ColumnsView(new_figure(projection="3d").axes[0], arm)
    Jv = columns.update(Q)
    tip = forward_kinematics(arm, Q)
    for k, arrow in enumerate(columns.arrows):
        start, end = np.column_stack(arrow.get_data_3d())[:2]
        np.testing.assert_allclose(start, tip, atol=1e-12)
        moved = forward_kinematics(arm, Q + 1e-6 * np.eye(3)[k]) - tip
        np.testing.assert_allclose(end - start, 0.5 * moved / 1e-6, atol=1e-5)
        np.testing.assert_allclose(Jv[:, k], moved / 1e-6, atol=1e-5)


@pytest.mark.parametrize("arm", [IR50P, THESIS_RODS], ids=lambda arm: arm.name)
def test_at_its_pace_the_fastest_joint_is_at_its_limit(arm):
    direction = np.array([0.6, 0.0, 0.8])
    rates = np.linalg.solve(jacobian(arm, Q)[:3], pace(Q, direction, arm.l, 1.3) * direction)
    assert np.abs(rates).max() == pytest.approx(1.3)
    assert pace(np.zeros(3), direction, arm.l, 1.3) == 0  # stretched: nothing goes outwards
    assert pace(np.zeros(3), [0, 1, 0], arm.l, 1.3) == pytest.approx(1.3 * arm.reach)  # the waist alone
