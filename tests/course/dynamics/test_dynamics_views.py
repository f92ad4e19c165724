"""Moving pictures of notebook 04: inertia over the pose, and the governor that settles where its torque curve says."""

import numpy as np
import pytest
from ir50p_lab.course.dynamics.views import GovernorView, InertiaView

from ir50p_lab.modelling import IR50P, THESIS_RODS, gravity, inverse_dynamics, jacobian, mass_matrix

HANG = np.linspace([0, -np.pi / 2, 0], [0, 0, 0], 181)


def test_inertia_view_shows_the_pose():
    view = InertiaView(IR50P)
    q = np.array([0.4, 0.5, -1.0])
    view.update(q)
    M = mass_matrix(IR50P, q)
    side, waist, joints = view.figure.axes
    dot, loop = waist.lines[1], joints.lines[0]
    assert np.allclose(dot.get_xydata(), [[np.degrees(0.5), M[0, 0]]])
    assert np.allclose(np.interp(dot.get_xdata(), *waist.lines[0].get_data()), M[0, 0], rtol=1e-3)
    assert np.allclose(0.5 * np.einsum("ni,ij,nj->n", loop.get_xydata(), M[1:, 1:], loop.get_xydata()), 1.0)
    assert f"{M[1, 1]:.3f}" in side.get_title()
    for ax in view.figure.axes:  # nothing runs out of its axes
        assert ax.get_xlabel() and ax.get_ylabel()
    assert np.abs(loop.get_xydata()).max() < joints.get_xlim()[1] and M[0, 0] < waist.get_ylim()[1]


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


def test_the_makers_payload_adds_three_quarters_of_the_links():
    """What notebook 04 says below the payload's slider, of the stretched and level arm."""
    payload = jacobian(IR50P, np.zeros(3))[2, 1] * 0.5 * IR50P.g
    assert payload / gravity(IR50P, np.zeros(3))[1] == pytest.approx(0.75, abs=0.03)
