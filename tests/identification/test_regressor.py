"""Phi theta against the inverse dynamics, the symbolic derivation and an engine that shares no line with either."""

import dataclasses

import mujoco
import numpy as np
import pytest
import sympy
from arms import mujoco_model, random_arm, random_states

from ir50p_lab.errors import InputError
from ir50p_lab.identification import regressor
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, NAMES
from ir50p_lab.modelling import IR50P, THESIS_C, Arm, inverse_dynamics
from ir50p_lab.modelling.symbolic import derive, same_function


def torque(Phi, theta):
    return np.einsum("nij,ij->ni", Phi, theta)


@pytest.mark.parametrize("seed", range(20))
def test_is_the_inverse_dynamics_of_random_arms(seed):
    rng = np.random.default_rng(seed)
    arm, state = random_arm(rng, coulomb=True), random_states(rng, 200)
    expected = inverse_dynamics(arm, *state)
    np.testing.assert_allclose(torque(regressor(*state, g=arm.g), arm.theta), expected, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("seed", range(20))
def test_is_the_inverse_dynamics_of_any_theta_with_its_own_row_per_joint(seed):
    rng = np.random.default_rng(seed)
    theta, state, g = rng.normal(0, 3, (3, 20)), random_states(rng, 200), rng.uniform(0, 30)
    expected = inverse_dynamics(theta, *state, g=g)
    np.testing.assert_allclose(torque(regressor(*state, g=g), theta), expected, rtol=1e-10, atol=1e-9)
    for row in range(3):  # and not one coefficient more than it says
        unused = np.delete(np.arange(20), ACTS_ON[row])
        assert not regressor(*state, g=g)[:, row, unused].any()
    assert (regressor(*state)[:, row, list(ACTS_ON[row])] != 0).any(axis=0).all()


def test_columns_are_those_of_the_symbolic_derivation_exactly():
    # the regressor evaluated on symbols: its Python source against derive(), proved, not tried
    model = derive(links="in-line")
    s = model.symbols
    l2, m2, m3, lc2, lc3 = (s[x] for x in ("l2", "m2", "m3", "lc2", "lc3"))
    theta = [
        s["j1"] + s["Izz1"] + s["Ixx2"] + s["Ixx3"],
        m2 * lc2**2 + m3 * l2**2 + s["Iyy2"] - s["Ixx2"],
        m2 * lc2 + m3 * l2,
        m3 * lc3,
        m3 * lc3**2 + s["Iyy3"] - s["Ixx3"],
        m3 * lc3 * l2,
        0,
        0,
        s["Izz2"] - s["Iyy2"] + s["Ixx2"] + s["j2"],
        s["Izz3"] - s["Iyy3"] + s["Ixx3"],
        *[0] * 9,
        s["j3"],
    ]
    (_, q2, q3), (a, b, c), (A, B, C) = model.q, model.qd, model.qdd
    c2, c3, c23, s2, s3, s23 = (f(x) for f in (sympy.cos, sympy.sin) for x in (q2, q3, q2 + q3))
    g = s["g"]
    rows = [[0] * 20 for _ in range(3)]
    rows[0][0] = A
    rows[0][1], rows[1][1] = c2**2 * A - 2 * s2 * c2 * a * b, B + s2 * c2 * a**2
    rows[1][2] = g * c2
    rows[1][3] = rows[2][3] = g * c23
    rows[0][4] = c23**2 * A - 2 * s23 * c23 * a * (b + c)
    rows[1][4] = rows[2][4] = B + C + s23 * c23 * a**2
    rows[0][5] = 2 * c2 * c23 * A - 2 * (s23 * c2 + c23 * s2) * a * b - 2 * s23 * c2 * a * c
    rows[1][5] = 2 * c3 * B + c3 * C + (s23 * c2 + c23 * s2) * a**2 - s3 * c**2 - 2 * s3 * b * c
    rows[2][5] = c3 * B + s23 * c2 * a**2 + s3 * b**2
    rows[1][8] = B
    rows[1][9] = rows[2][9] = B + C
    rows[2][19] = C
    for row, tau in zip(rows, model.tau, strict=True):
        assert same_function(sum(x * y for x, y in zip(row, theta, strict=True)), tau)
    # the same formulas in numbers are what regressor() returns
    f = sympy.lambdify([list(model.q), list(model.qd), list(model.qdd), g], sympy.Matrix(rows), "numpy")
    rng = np.random.default_rng(1)
    inertial = [0, 1, 2, 3, 4, 5, 8, 9, 19]
    for state in zip(*random_states(rng, 50), strict=True):
        expected = np.array(f(*state, 9.81), dtype=float)[:, inertial]
        np.testing.assert_allclose(regressor(*state)[:, inertial], expected, rtol=1e-11, atol=1e-11)


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


def test_thesis_parameters_7_and_8_too():
    rng = np.random.default_rng(2)
    state = random_states(rng, 100)
    np.testing.assert_allclose(torque(regressor(*state), THESIS_C), inverse_dynamics(THESIS_C, *state), atol=1e-10)


def test_one_state_is_a_row_of_many():
    q, qd, qdd = random_states(np.random.default_rng(3), 5)
    Phi = regressor(q, qd, qdd)
    assert Phi.shape == (5, 3, 20)
    np.testing.assert_array_equal(regressor(q[2], qd[2], qdd[2]), Phi[2])


def test_at_rest_coulomb_friction_is_left_out():
    Phi = regressor(np.zeros(3), np.zeros(3), np.zeros(3))
    assert not Phi[:, 11:16:2].any()


def test_sign_may_be_smooth_or_given():
    q, qd, qdd = random_states(np.random.default_rng(4), 200)
    coulomb = [(0, 11), (1, 13), (2, 15)]
    smooth, given = regressor(q, qd, qdd, sign=0.05), regressor(q, qd, qdd, sign=-np.sign(qd))
    plain = regressor(q, qd, qdd)
    for row, column in coulomb:
        np.testing.assert_allclose(smooth[:, row, column], np.tanh(qd[:, row] / 0.05))
        np.testing.assert_array_equal(given[:, row, column], -plain[:, row, column])
    for other in (smooth, given):  # nothing else changes
        other = other.copy()
        for row, column in coulomb:
            other[:, row, column] = plain[:, row, column]
        np.testing.assert_array_equal(other, plain)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_bad_input_is_refused_at_every_scale(scale):
    good = np.full((4, 3), scale)
    bad = good.copy()
    bad[2, 1] = np.nan
    with pytest.raises(InputError, match=r"qd holds nan at index \(2, 1\)"):
        regressor(good, bad, good)
    with pytest.raises(InputError, match=r"qdd \(3, 3\): give all"):
        regressor(good, good, good[:3])
    with pytest.raises(InputError, match=r"q has shape \(4, 2\)"):
        regressor(good[:, :2], good, good)
    with pytest.raises(InputError, match="base z axis"):
        regressor(good, good, good, g=-scale)
    with pytest.raises(InputError, match=r"sign = .*> 0"):
        regressor(good, good, good, sign=-scale)
    with pytest.raises(InputError, match="numbers from -1 to 1"):
        regressor(good, good, good, sign=good + 1.0)
    assert regressor(good, good, good).shape == (4, 3, 20)


@pytest.mark.parametrize("sign", [0.0, np.inf, np.nan, "tanh", True])
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


def test_names_of_columns():
    assert len(NAMES) == 20 == len(set(NAMES))
    assert len(COLUMNS["thesis"]) == 20
    assert [NAMES[k] for k in set(range(20)) - set(COLUMNS["rigid"])] == ["theta7", "theta8"]
