"""The governor of notebook 05 settles where its torque curve says."""

import numpy as np
import pytest

from ir50p_lab.course.dynamics.governor_view import GovernorView
from ir50p_lab.modelling import IR50P, THESIS_RODS, inverse_dynamics

HANG = np.linspace([0, -np.pi / 2, 0], [0, 0, 0], 181)


@pytest.mark.parametrize("arm", [IR50P, THESIS_RODS], ids=lambda arm: arm.name)
def test_the_faster_it_spins_the_higher_it_settles(arm):
    bare, view, found = arm.without_friction(), GovernorView(arm, HANG), []
    for spin in (0.0, 5.0, 9.0, 15.0):
        torque = inverse_dynamics(bare, HANG, np.tile([spin, 0, 0], (181, 1)), np.zeros((181, 3)))[:, 1]
        rest = view.update(spin, torque)
        found.append(rest[1])
        np.testing.assert_allclose(view.curve.get_data(), [np.degrees(HANG[:, 1]), torque])
        assert f"{spin:.1f} rad/s" in view.figure.axes[1].get_title()
        assert f"{np.degrees(rest[1]):.0f} deg" in view.figure.axes[1].get_title()
        tip = view.side.points[2]
        np.testing.assert_allclose(
            tip, [arm.reach * np.cos(rest[1]), arm.l[0] + arm.reach * np.sin(rest[1])], atol=1e-9
        )
    assert found[0] == -np.pi / 2 and found == sorted(found) and found[-1] > found[1]
