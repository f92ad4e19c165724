"""The course's pace is the one that 03 asks for."""

import numpy as np
import pytest

from ir50p_lab.course.kinematics.fallbacks import pace
from ir50p_lab.modelling import IR50P, THESIS_RODS, jacobian


@pytest.mark.parametrize("arm", [IR50P, THESIS_RODS], ids=lambda arm: arm.name)
def test_at_its_pace_the_fastest_joint_is_at_its_limit(arm):
    q, direction = np.array([0.4, 0.9, -1.3]), np.array([0.6, 0.0, 0.8])
    rates = np.linalg.solve(jacobian(arm, q)[:3], pace(q, direction, arm.l, 1.3) * direction)
    assert np.abs(rates).max() == pytest.approx(1.3)
    assert pace(np.zeros(3), direction, arm.l, 1.3) == 0  # stretched: nothing goes outwards
    assert pace(np.zeros(3), [0, 1, 0], arm.l, 1.3) == pytest.approx(1.3 * arm.reach)  # the waist alone
