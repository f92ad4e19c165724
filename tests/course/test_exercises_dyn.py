"""Exercises of notebook 04: right answers by hand or by another route."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.course.exercises._catalogue import find
from ir50p_lab.modelling import IR50P, THESIS_RODS, derive, energy, forward_kinematics


def test_rod_with_hand_by_summing_slices():
    n = 20_000
    x = (np.arange(n) + 0.5) * 0.4 / n
    assert solution("dyn-1") == pytest.approx((0.6 / n * x**2).sum() + 0.2 * 0.4**2, rel=1e-8)


def test_holding_torque_is_the_gradient_of_the_whole_potential():
    def potential(q):
        return energy(IR50P, q, np.zeros(3)).potential + 0.5 * 9.81 * forward_kinematics(IR50P, q)[2]

    q, step = np.array([0.3, 0.5, -0.7]), 1e-6 * np.eye(3)
    gradient = [(potential(q + d) - potential(q - d)) / 2e-6 for d in step]
    assert np.allclose(solution("dyn-2"), gradient, atol=1e-8)


def test_acceleration_fulfils_the_symbolic_equation_of_motion():
    numeric = derive().numeric(THESIS_RODS)
    q, qd, tau = np.array([0.3, 0.5, -0.7]), np.array([0.4, -0.6, 0.8]), np.array([1.0, 20.0, 5.0])
    qdd = solution("dyn-3")(q, qd, tau)
    assert np.allclose(numeric.M(q) @ qdd + numeric.C(q, qd) @ qd + numeric.g(q), tau, atol=1e-12)


def test_friction_and_voltage_by_hand():
    assert solution("dyn-4") == pytest.approx(-(2 * 0.02 + 0.5 + 0.4 * np.exp(-0.16)))
    assert solution("dyn-5") == pytest.approx(1.6 * (2 + 0.2 * 3) + 2.5 * 0.5)


def test_prose_of_the_exercises():
    """What the remarks after a right answer claim."""
    rod, hand = 0.6 * 0.4**2 / 3, 0.2 * 0.4**2
    assert hand == pytest.approx(rod)  # half of the inertia from a quarter of the mass
    own = next(iter(find("dyn-2").slips.values()))
    assert (solution("dyn-2")[1] - own[1]) / own[1] == pytest.approx(0.75, abs=0.03)
    forearm = IR50P.Izz[2] + IR50P.m[2] * IR50P.lc[2] ** 2
    assert 50**2 * 8e-5 > forearm
