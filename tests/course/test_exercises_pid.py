"""Exercises of notebook 09: right answers by another route."""

import numpy as np
import pytest

from ir50p_lab.controllers import PID, ContinuousPID, simc
from ir50p_lab.course.exercises import solution
from ir50p_lab.course.exercises._catalogue import find
from ir50p_lab.identification import FOPDT
from ir50p_lab.modelling import THESIS_A
from ir50p_lab.simulation import simulate


def test_remaining_error_is_where_a_simulation_ends():
    run = simulate(THESIS_A, ContinuousPID((50, 100, 50), kd=(20, 20, 20)), (np.pi / 2, np.pi / 2, -np.pi / 3))
    np.testing.assert_allclose(solution("pid-1"), run.error[-1], atol=1e-6)


def test_the_law_is_that_of_the_package():
    rng = np.random.default_rng(5)
    e, (kp, ki, kd), T = rng.normal(0, 0.3, 9), (20.0, 8.0, 1.5), 0.02
    pid = PID(kp, ki=ki, kd=kd, period=T, filter_hz=np.inf, derivative_on="error")
    u = [pid.step(k * T, np.zeros(3), [[value] * 3, [0] * 3, [0] * 3])[0] for k, value in enumerate(e)]
    assert solution("pid-2")(e, kp, ki, kd, T) == pytest.approx(u[-1])


@pytest.mark.parametrize(("factor", "grows"), [(0.98, False), (1.02, True)])
def test_longest_period_by_stepping(factor, grows):
    v, T = 1.0, factor * solution("pid-3")
    for _ in range(500):
        v += T * (-40.0 * v) / 0.25
    assert (abs(v) > 1) == grows


def test_critical_damping_has_a_double_pole():
    poles = np.roots([0.2, 1.5 + solution("pid-4"), 20.0])
    assert np.allclose(poles, poles.mean(), atol=1e-6) and poles.real.max() < 0


def test_simc_is_that_of_the_package():
    rule = simc(FOPDT(K=0.01, T=0.2, L=0.03), tau_c=0.06, kind="PI")
    np.testing.assert_allclose(solution("pid-5"), (rule.kp, rule.ki))


def test_prose_of_the_exercises():
    """What the remarks claim."""
    softer, thesis = solution("pid-1"), find("pid-1").slips[1].wrong
    assert 2 < softer[1] / thesis[1] < 2.5  # half the Kp, more than twice the error
    assert 0.2 < 4 * (0.06 + 0.03)  # the minimum of pid-5 is T
