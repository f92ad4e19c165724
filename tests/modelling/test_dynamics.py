"""The equations of motion: against MuJoCo, against the corrected thesis' numbers, and by their own invariants."""

import warnings

import mujoco
import numpy as np
import pandas as pd
import pytest
from arms import mujoco_model, random_arm, random_states
from hypothesis import given
from hypothesis import strategies as st
from refusals import refused
from thesis_numbers import STATES, reference, same_quantities

from ir50p_lab.errors import InputError
from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    THESIS_C,
    THESIS_RODS,
    Arm,
    closed_form,
    coriolis_matrix,
    energy,
    forward_dynamics,
    gravity,
    inverse_dynamics,
    mass_matrix,
)

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize(("name", "model"), [("A", THESIS_A), ("B", THESIS_RODS), ("C", THESIS_C)])
def test_reproduces_the_corrected_thesis_models(name, model):
    for (q, qd), row in zip(STATES, reference(name), strict=True):
        M, h, g = mass_matrix(model, q), coriolis_matrix(model, q, qd) @ qd, gravity(model, q)
        np.testing.assert_allclose(same_quantities(M, h, g), row, atol=1e-12, rtol=0)
        assert (M == M.T).all() and (M[0, 2], g[0]) == (0, 0)


@pytest.mark.parametrize("seed", range(6))
def test_equals_mujoco_on_a_random_arm(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    model = mujoco_model(arm)
    data = mujoco.MjData(model)
    q, qd, qdd = random_states(rng, 1000)
    tau = inverse_dynamics(arm, q, qd, qdd)
    found = forward_dynamics(arm, q, qd, tau)
    M_ours, K_ours = mass_matrix(arm, q), energy(arm, q, qd).kinetic
    torques, accelerations = np.empty((2, 1000, 3))
    for k in range(1000):
        data.qpos[:], data.qvel[:], data.qacc[:] = q[k], qd[k], qdd[k]
        mujoco.mj_inverse(model, data)
        torques[k] = data.qfrc_inverse
        data.qfrc_applied[:] = tau[k]
        mujoco.mj_forward(model, data)
        accelerations[k] = data.qacc
        data.qfrc_applied[:] = 0
        if k < 50:
            M = np.zeros((3, 3))
            mujoco.mj_fullM(model, data, M)
            np.testing.assert_allclose(M_ours[k], M, rtol=1e-12, atol=1e-12)
            mujoco.mj_energyVel(model, data)
            np.testing.assert_allclose(K_ours[k], data.energy[1], rtol=1e-12)
    np.testing.assert_allclose(tau, torques, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found, accelerations, rtol=1e-9, atol=1e-9)


@given(seeds, st.booleans())
def test_forward_undoes_inverse_also_with_a_row_of_its_own_per_joint(seed, in_pwm):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng, coulomb=True)
    theta = arm.theta_pwm if in_pwm else arm.theta
    q, qd, qdd = random_states(rng, 30)
    tau = inverse_dynamics(theta, q, qd, qdd)
    np.testing.assert_allclose(forward_dynamics(theta, q, qd, tau), qdd, rtol=1e-8, atol=1e-8)
    M = mass_matrix(theta, q)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", M, qdd) + bias(theta, q, qd), tau, rtol=1e-9, atol=1e-9)


def test_a_theta_in_pwm_is_the_same_motion_seen_from_the_counts():
    rng = np.random.default_rng(7)
    q, qd, qdd = random_states(rng, 50)
    K, damping = IR50P.actuators.gain, IR50P.actuators.back_emf_damping
    in_newton_metres = inverse_dynamics(IR50P, q, qd, qdd) + damping * qd
    np.testing.assert_allclose(inverse_dynamics(IR50P.theta_pwm, q, qd, qdd), in_newton_metres / K, rtol=1e-12)
    assert not np.allclose(mass_matrix(IR50P.theta_pwm, q[0]), mass_matrix(IR50P.theta_pwm, q[0]).T)


def test_theta_with_products_of_inertia_solves_against_lapack():
    q, qd, tau = (x[:100] for x in random_states(np.random.default_rng(3), 100))
    expected = np.linalg.solve(mass_matrix(THESIS_C, q), (tau - bias(THESIS_C, q, qd))[:, :, None])[:, :, 0]
    np.testing.assert_allclose(forward_dynamics(THESIS_C, q, qd, tau), expected, rtol=1e-11, atol=1e-11)


def test_friction_in_theta_opposes_motion_and_is_silent_at_rest():
    still, moving = np.zeros(3), np.array([0.5, -0.5, 0.5])
    rigid = IR50P.without_friction()
    extra = bias(IR50P, still, moving) - bias(rigid, still, moving)
    f = IR50P.friction
    np.testing.assert_allclose(extra, np.sign(moving) * f.fc + f.Tf, rtol=1e-12)
    np.testing.assert_allclose(bias(IR50P, still, still) - bias(rigid, still, still), f.Tf, rtol=1e-12)


def test_a_theta_takes_the_gravity_it_is_given():
    moon = Arm(**{**vars_of(THESIS_RODS), "g": 1.62})
    q, qd, x = (a[:20] for a in random_states(np.random.default_rng(4), 20))
    for function, vectors in (
        (gravity, (q,)), (inverse_dynamics, (q, qd, x)), (forward_dynamics, (q, qd, x)),
    ):  # fmt: skip
        given = function(moon.theta, *vectors, g=1.62)
        np.testing.assert_allclose(given, function(moon, *vectors), rtol=1e-12, atol=1e-12)
        assert np.abs(given - function(moon.theta, *vectors)).max() > 1  # 9.81 unless told
        refused(r"carries its own gravity \(1\.62 m/s", function, moon, *vectors, g=1.62)
    np.testing.assert_allclose(energy(moon.theta, q, qd, g=1.62).total, energy(moon, q, qd).total, rtol=1e-12)
    refused("carries its own", energy, moon, q, qd, g=9.81)
    one = np.zeros(3)  # the short way for one state of an Arm
    refused("carries its own", forward_dynamics, moon, one, one, one, g=9.81)


def bias(arm, q, qd):
    """All torques but those of acceleration."""
    return inverse_dynamics(arm, q, qd, np.zeros(3))


def vars_of(arm):
    return {name: getattr(arm, name) for name in ("l", "m", "lc", "Ixx", "Iyy", "Izz")}


FUNCTIONS = {mass_matrix: 1, gravity: 1, coriolis_matrix: 2, inverse_dynamics: 3, forward_dynamics: 3}


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
@pytest.mark.parametrize("model", [IR50P, IR50P.theta, IR50P.theta_pwm.tolist()], ids=["arm", "theta", "rows"])
def test_one_state_or_many_as_arrays_lists_or_tuples_of_any_numbers(function, model):
    rng = np.random.default_rng(11)
    states = [rng.integers(-3, 4, (5, 3)).astype(float) for _ in range(FUNCTIONS[function])]
    many = function(model, *states)
    assert type(many) is np.ndarray and len(many) == 5
    assert (function(model, *[x.reshape(5, 1, 3) for x in states])[:, 0] == many).all()
    for k in range(5):
        one = [x[k] for x in states]
        locked = [x.copy() for x in one]
        for x in locked:
            x.setflags(write=False)
        spread = [np.repeat(x, 2)[::2] for x in one]
        integers = [x.astype(int) for x in one]
        singles = [x.astype(np.float32) for x in one]
        series = [pd.Series(x, index=["a", "b", "c"]) for x in one]
        for same in (one, locked, spread, integers, singles, series, map(list, one), map(tuple, integers)):
            found = function(model, *same)
            assert type(found) is np.ndarray and (found == many[k]).all()


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: mass_matrix(IR50P, [0, 0]), ["q", "(2,)", "(3,)"]),
        (lambda: gravity(IR50P, [0, np.nan, 0]), ["q", "nan", "index 1"]),
        (lambda: forward_dynamics(IR50P, np.array([np.inf, 0, 0]), np.zeros(3), np.zeros(3)), ["q", "inf"]),
        (lambda: forward_dynamics(IR50P, np.zeros(3), np.zeros(3), np.array([0, 0, np.inf])), ["tau", "inf"]),
        (lambda: inverse_dynamics(IR50P, np.zeros((4, 3)), np.zeros((5, 3)), np.zeros(3)), ["q (4, 3)", "qd (5, 3)"]),
        (
            lambda: inverse_dynamics(IR50P, np.full(3, 1e200), np.full(3, 1e200), np.zeros(3)),
            ["not finite", "too large"],
        ),
        (lambda: mass_matrix(np.zeros((3, 19)), np.zeros(3)), ["(3, 19)", "(3, 20)"]),
        (lambda: mass_matrix(3.0, np.zeros(3)), ["float", "(3, 20)"]),
        (lambda: mass_matrix(IR50P, ["a", "b", "c"]), ["q", "numbers"]),
        (lambda: gravity(THESIS_C, np.zeros(3), g=-9.81), ["g = -9.81", ">= 0"]),
        (lambda: energy(IR50P.theta_pwm, np.zeros(3), np.zeros(3)), ["equal rows"]),
        (lambda: forward_dynamics(np.zeros((3, 20)), np.zeros(3), np.zeros(3), np.ones(3)), ["singular"]),
    ],
)
def test_bad_input_gets_a_sentence(call, words):
    refused(words, call)


def test_our_sine_and_cosine_are_right_to_the_last_bits():
    x = np.concatenate([np.random.default_rng(0).uniform(-50, 50, 2000), np.arange(-40, 41) * np.pi / 4, [0.0, 1e6]])
    found = np.array([closed_form.sincos(value) for value in x])
    np.testing.assert_allclose(found, np.stack([np.sin(x), np.cos(x)], axis=1), rtol=0, atol=3e-16)


@pytest.mark.parametrize("seen", ["ignore", "warn", "raise"])
def test_a_run_that_diverges_ends_in_a_sentence_whatever_numpy_warns_of(seen):
    for filtered in ("ignore", "error"):
        warnings.simplefilter(filtered)
        for huge in (1e160, 1e300):
            with np.errstate(all=seen), pytest.raises(InputError, match="not finite"):
                forward_dynamics(IR50P, (0, 0.3, 1), (huge, huge, 0), (0, 0, 0))
            with np.errstate(all=seen), pytest.raises(InputError, match="not finite"):
                inverse_dynamics(IR50P, np.ones((4, 3)), np.full((4, 3), huge), np.zeros((4, 3)))
