"""Exercises of notebook 06: each right answer by another route, most of them by simulating the case."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ir50p_lab.controllers import PID
from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P, THESIS_RODS, Friction, forward_dynamics
from ir50p_lab.simulation import simulate

BRAKE = 1e4  # N m: holds the other joints


def only_joint_1(coulomb, **more):
    return replace(IR50P, friction=Friction(fc=(coulomb, BRAKE, BRAKE)), **more)


def test_midpoint_step_is_of_second_order():
    step = solution("sim-1")
    q, qd = np.array([0.3, 0.5, -0.7]), np.array([0.4, -0.6, 0.8])

    def rate(t, x):
        return np.r_[x[3:], forward_dynamics(THESIS_RODS, x[:3], x[3:], np.zeros(3))]

    errors = []
    for h in (0.02, 0.01, 0.005):
        exact = solve_ivp(rate, (0, h), np.r_[q, qd], rtol=1e-12, atol=1e-12).y[:, -1]
        errors.append(np.abs(np.ravel(step(q, qd, h)) - exact).max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 3, atol=0.2)  # of one step: one more than of the method


def test_joint_with_coulomb_friction_stops_there():
    pid = PID(kp=(2, 0, 0), period=1e-4)
    run = simulate(only_joint_1(0.1), pid, (0, 0, 0), q0=(0.37, 0, 0), duration=20, period=1e-4, step=1e-4)
    assert (run.qd[-1] == 0).all()
    assert run.q[-1, 0] == pytest.approx(solution("sim-2"), abs=5e-4)
