"""Exercises of notebook 14: right answers by another route."""

import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P, inverse_dynamics


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
