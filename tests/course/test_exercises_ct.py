"""Exercises of notebook 14: right answers by another route."""

import numpy as np
import pytest

from ir50p_lab.controllers import gains_for_poles
from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P, inverse_dynamics


def test_the_border_by_the_roots():
    border = solution("ct-1")
    for K0, stable in ((0.999 * border, True), (1.001 * border, False)):
        assert (np.roots([1, 4, 6, K0]).real.max() < 0) == stable


def test_two_poles():
    np.testing.assert_allclose(gains_for_poles((-8, -8)), solution("ct-2"))


def test_the_error_that_stays_by_simulation():
    e, rate = 0.0, 0.0
    for _ in range(20000):
        qdd = ((0.6 * (-49 * e - 14 * rate) + 4.0) - 5.5) / 0.6
        rate += 1e-3 * qdd
        e += 1e-3 * rate
    assert solution("ct-3") == pytest.approx(e, abs=1e-6)


def test_top_speed_needs_full_drive():
    needed = inverse_dynamics(IR50P.theta_pwm, [0, 0, 0], [solution("ct-4"), 0, 0], [0, 0, 0])
    assert needed[0] == pytest.approx(255)
