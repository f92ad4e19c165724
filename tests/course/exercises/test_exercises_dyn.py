"""Exercises of notebook 04: right answers by hand or by another route."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import THESIS_RODS, derive


def test_acceleration_fulfils_the_symbolic_equation_of_motion():
    numeric = derive().numeric(THESIS_RODS)
    q, qd, tau = np.array([0.3, 0.5, -0.7]), np.array([0.4, -0.6, 0.8]), np.array([1.0, 20.0, 5.0])
    qdd = solution("dyn-3")(q, qd, tau)
    assert np.allclose(numeric.M(q) @ qdd + numeric.C(q, qd) @ qd + numeric.g(q), tau, atol=1e-12)


def test_voltage_by_hand():
    assert solution("dyn-5") == pytest.approx(1.6 * (2 + 0.2 * 3) + 2.5 * 0.5)
