"""Phi theta against the inverse dynamics (proved against the symbolic ones in tests/modelling) and an engine."""

import numpy as np
import pytest
from arms import random_states
from refusals import refused

from ir50p_lab.identification import regressor
from ir50p_lab.identification.parameters import ACTS_ON
from ir50p_lab.modelling import inverse_dynamics


def torque(Phi, theta):
    return np.einsum("nij,ij->ni", Phi, theta)


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
    refused(r"qd holds nan at index \(2, 1\)", regressor, good, bad, good)
    refused(r"qdd \(3, 3\): give all", regressor, good, good, good[:3])
    refused(r"q has shape \(4, 2\)", regressor, good[:, :2], good, good)
    refused("base z axis", regressor, good, good, good, g=-1.0)
    refused(r"sign = .*> 0", regressor, good, good, good, sign=-1.0)
    assert regressor(good, good, good).shape == (4, 3, 20)


@pytest.mark.parametrize("sign", [0.0, np.inf, np.nan, "tanh", True, [0.1] * 3])
def test_bad_sign(sign):
    refused("sign", regressor, np.ones(3), np.ones(3), np.ones(3), sign=sign)
