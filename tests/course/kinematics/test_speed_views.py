"""What the moving pictures of notebook 03 show is what the kinematics says."""

import numpy as np
import pytest

from ir50p_lab.course.draw.style import new_figure
from ir50p_lab.course.kinematics.speed_views import ColumnsView
from ir50p_lab.modelling import IR50P, THESIS_RODS, forward_kinematics

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
