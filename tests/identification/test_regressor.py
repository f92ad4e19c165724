"""Phi theta against the inverse dynamics (proved against the symbolic ones in tests/modelling) and an engine."""

import dataclasses

import mujoco
import numpy as np
import pytest
from arms import mujoco_model, random_arm, random_states

from ir50p_lab.errors import InputError
from ir50p_lab.identification import regressor
from ir50p_lab.identification.parameters import ACTS_ON
from ir50p_lab.modelling import IR50P, Arm, inverse_dynamics


def torque(Phi, theta):
    return np.einsum("nij,ij->ni", Phi, theta)


@pytest.mark.parametrize("seed", range(5))
def test_is_the_inverse_dynamics_of_random_arms(seed):
    rng = np.random.default_rng(seed)
    arm, state = random_arm(rng, coulomb=True), random_states(rng, 200)
    expected = inverse_dynamics(arm, *state)
    np.testing.assert_allclose(torque(regressor(*state, g=arm.g), arm.theta), expected, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_is_the_inverse_dynamics_of_any_theta_with_its_own_row_per_joint(seed):
    rng = np.random.default_rng(seed)
    theta, state, g = rng.normal(0, 3, (3, 20)), random_states(rng, 200), rng.uniform(0, 30)
    expected = inverse_dynamics(theta, *state, g=g)
    np.testing.assert_allclose(torque(regressor(*state, g=g), theta), expected, rtol=1e-10, atol=1e-9)
    for row in range(3):  # and not one coefficient more than it says
        unused = np.delete(np.arange(20), ACTS_ON[row])
        assert not regressor(*state, g=g)[:, row, unused].any()
    assert (regressor(*state)[:, row, list(ACTS_ON[row])] != 0).any(axis=0).all()


def test_is_the_inverse_dynamics_of_mujoco():
    rng = np.random.default_rng(5)
    arm = random_arm(rng)
    model = mujoco_model(arm)
    data = mujoco.MjData(model)
    for q, qd, qdd in zip(*random_states(rng, 50), strict=True):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, qd, qdd
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(
            np.sum(regressor(q, qd, qdd, g=arm.g) * arm.theta, axis=1), data.qfrc_inverse, rtol=1e-9, atol=1e-9
        )


def test_one_state_is_a_row_of_many():
    q, qd, qdd = random_states(np.random.default_rng(3), 5)
    Phi = regressor(q, qd, qdd)
    assert Phi.shape == (5, 3, 20)
    np.testing.assert_array_equal(regressor(q[2], qd[2], qdd[2]), Phi[2])


def test_at_rest_coulomb_friction_is_left_out():
    Phi = regressor(np.zeros(3), np.zeros(3), np.zeros(3))
    assert not Phi[:, 11:16:2].any()


def test_sign_may_be_smooth():
    q, qd, qdd = random_states(np.random.default_rng(4), 200)
    coulomb = [(0, 11), (1, 13), (2, 15)]
    smooth, plain = regressor(q, qd, qdd, sign=0.05), regressor(q, qd, qdd)
    for row, column in coulomb:
        np.testing.assert_allclose(smooth[:, row, column], np.tanh(qd[:, row] / 0.05))
        smooth[:, row, column] = plain[:, row, column]
    np.testing.assert_array_equal(smooth, plain)  # nothing else changes


def test_bad_input_is_refused():
    good = np.ones((4, 3))
    bad = good.copy()
    bad[2, 1] = np.nan
    with pytest.raises(InputError, match=r"qd holds nan at index \(2, 1\)"):
        regressor(good, bad, good)
    with pytest.raises(InputError, match=r"qdd \(3, 3\): give all"):
        regressor(good, good, good[:3])
    with pytest.raises(InputError, match=r"q has shape \(4, 2\)"):
        regressor(good[:, :2], good, good)
    with pytest.raises(InputError, match="base z axis"):
        regressor(good, good, good, g=-1.0)
    with pytest.raises(InputError, match=r"sign = .*> 0"):
        regressor(good, good, good, sign=-1.0)
    assert regressor(good, good, good).shape == (4, 3, 20)


@pytest.mark.parametrize("sign", [0.0, np.inf, np.nan, "tanh", True, [0.1] * 3])
def test_bad_sign(sign):
    with pytest.raises(InputError, match="sign"):
        regressor(np.ones(3), np.ones(3), np.ones(3), sign=sign)


def test_other_gravity():
    moon = dataclasses.replace(IR50P.without_friction(), g=1.62)
    state = random_states(np.random.default_rng(6), 20)
    assert isinstance(moon, Arm)
    np.testing.assert_allclose(
        torque(regressor(*state, g=1.62), moon.theta), inverse_dynamics(moon, *state), atol=1e-10
    )
