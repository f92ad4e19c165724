"""The general tool against examples by hand, against simulation, and Routh against the roots."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from ir50p_lab.controllers import (
    feedback_linearise,
    gains_for_poles,
    hurwitz,
    lie_derivative,
    pendulum_with_motor_lag,
    routh_table,
)
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, inverse_dynamics

x1, x2, x3, v = sp.symbols("x1 x2 x3 v")


def test_lie_derivative_by_hand():
    assert lie_derivative(x1**2 * x2, (x2, -x1), (x1, x2)) == 2 * x1 * x2**2 - x1**3


def test_one_joint_is_computed_torque():
    """x'' = f + b u (2.8): the law is (2.9)."""
    f = -9.81 * sp.sin(x1) - 0.3 * x2
    found = feedback_linearise((x2, f), (0, 1 / (2 + x1**2)), x1, (x1, x2))
    assert found.relative_degree == 2 and found.hidden == 0 and found.coordinates == (x1, x2)
    assert sp.simplify(found.law(v) - (2 + x1**2) * (v - f)) == 0


def test_an_arm_joint_gives_inverse_dynamics():
    """Joint 3 of the arm, the others held: the same command as (2.19)."""
    arm = IR50P.without_friction()
    q = np.array([0.0, 0.7, 0.0])
    M33 = inverse_dynamics(arm, q, [0, 0, 0], [0, 0, 1])[2] - inverse_dynamics(arm, q, [0, 0, 0], [0, 0, 0])[2]
    weight = arm.g * arm.m[2] * arm.lc[2]
    law = feedback_linearise((x2, -weight * sp.cos(0.7 + x1) / M33), (0, 1 / M33), x1, (x1, x2)).law(v)
    found = float(law.subs({x1: -0.4, x2: 1.1, v: 2.5}))
    assert found == pytest.approx(inverse_dynamics(arm, [0, 0.7, -0.4], [0, 0, 1.1], [0, 0, 2.5])[2], rel=1e-12)


def test_hidden_states_are_counted():
    found = feedback_linearise((x2, -x1, -x3), (0, 1, 1), x1, (x1, x2, x3))
    assert found.relative_degree == 2 and found.hidden == 1


@pytest.fixture(scope="module")
def pendulum():
    f, g, h, x, parameters = pendulum_with_motor_lag()
    return f, g, x, parameters, feedback_linearise(f, g, h, x)


def simulated(pendulum, gains, seconds, target=None):
    f, g, x, parameters, found = pendulum
    u = found.controller(gains, parameters)
    rate = sp.lambdify(
        (x, sp.Symbol("u")), [sp.sympify(a + b * sp.Symbol("u")).subs(parameters) for a, b in zip(f, g, strict=True)]
    )

    def right(t, state):
        return rate(state, u(state, None if target is None else target(t)))

    return solve_ivp(right, (0, seconds), [0.5, 0.0, 0.0], rtol=1e-9, atol=1e-10, dense_output=True)


def test_pendulum_with_motor_lag_has_degree_three_and_the_error_dynamics_asked_for(pendulum):
    found = pendulum[4]
    assert found.relative_degree == 3 and found.hidden == 0
    gains = gains_for_poles((-4, -5, -6))
    np.testing.assert_allclose(gains, [120, 74, 15])
    run = simulated(pendulum, gains, 3)
    t = np.linspace(0, 3, 50)
    # y''' + K2 y'' + K1 y' + K0 y = 0 from where it starts: SciPy's matrix exponential as the oracle
    from scipy.linalg import expm

    start = [
        float(e.subs(pendulum[3]).subs(dict(zip(pendulum[2], (0.5, 0, 0), strict=True)))) for e in found.coordinates
    ]
    A = np.array([[0, 1, 0], [0, 0, 1], -gains])
    np.testing.assert_allclose(run.sol(t)[0], [(expm(A * k) @ start)[0] for k in t], atol=1e-6)


def test_it_tracks(pendulum):
    def target(t):
        return np.sin(t), np.cos(t), -np.sin(t), -np.cos(t)

    run = simulated(pendulum, gains_for_poles((-4, -5, -6)), 6, target)
    assert abs(run.y[0, -1] - np.sin(6)) < 1e-6


def test_positive_gains_are_not_enough_from_three_on(pendulum):
    """s^3 + s^2 + s + 8: all gains positive, and unstable; (2.11) needs more than 'positive'."""
    gains = (8, 1, 1)
    assert not hurwitz(gains)
    np.testing.assert_allclose(routh_table(gains)[:, 0], [1, 1, -7, 8])
    assert np.roots([1, 1, 1, 8]).real.max() > 0.5
    run = simulated(pendulum, gains, 10)
    assert np.abs(run.y[0]).max() > 10
    for n in (1, 2):
        for positive in np.random.default_rng(n).uniform(0.01, 100, (50, n)):
            assert hurwitz(positive)


@given(st.lists(st.floats(-5, 20), min_size=1, max_size=6))
def test_routh_agrees_with_the_roots(gains):
    roots = np.roots([1.0, *gains[::-1]])
    largest = roots.real.max() if len(roots) else -1.0
    if abs(largest) > 1e-5 and len(roots) == len(gains):
        assert hurwitz(gains) == (largest < 0)


@given(st.lists(st.floats(-10, -0.1), min_size=1, max_size=5))
def test_gains_for_poles_put_them_there(poles):
    gains = gains_for_poles(poles)
    assert hurwitz(gains)
    np.testing.assert_allclose(np.poly(poles), [1, *gains[::-1]])
    pair = gains_for_poles([-1 + 2j, -1 - 2j, *poles])
    assert len(pair) == len(poles) + 2 and hurwitz(pair)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: feedback_linearise((x2,), (0, 1), x1, (x1, x2)), ["1 rates for 2 states"]),
        (lambda: feedback_linearise((x2, 0), (0,), x1, (x1, x2)), ["1 rates for 2 states"]),
        (lambda: feedback_linearise((x2, -x1), (0, 0), x1, (x1, x2)), ["does not show"]),
        (lambda: feedback_linearise((), (), x1, ()), ["does not show"]),
        (lambda: lie_derivative(x1, (x1,), (x1, x2)), ["1 rates for 2 states"]),
        (lambda: gains_for_poles((-1, 2)), ["negative real part"]),
        (lambda: gains_for_poles((-1 + 1j,)), ["partner"]),
        (lambda: gains_for_poles(()), ["poles"]),
        (lambda: gains_for_poles((np.nan,)), ["poles"]),
        (lambda: hurwitz(()), ["gains"]),
        (lambda: hurwitz((1, np.nan)), ["gains"]),
        (lambda: hurwitz("high"), ["gains"]),
        (lambda: routh_table(np.ones((2, 2))), ["gains"]),
        (lambda: feedback_linearise((x2, 0), (0, 1), x1, (x1, x2)).controller((1,)), ["1 gains for relative degree 2"]),
        (lambda: feedback_linearise((x2, x3), (0, 1), x1, (x1, x2)).controller((1, 1)), ["no number", "x3"]),
    ],
)
def test_bad_input_gets_a_sentence(make, words):
    with pytest.raises(InputError) as caught:
        make()
    for word in words:
        assert word in str(caught.value)
