"""Exercises of notebook 08: right answers by another route."""

import numpy as np
import pytest

from ir50p_lab.controllers import ContinuousPID
from ir50p_lab.course.exercises import grade, solution
from ir50p_lab.course.exercises._catalogue import find
from ir50p_lab.modelling import THESIS_A
from ir50p_lab.simulation import simulate


def test_remaining_error_is_where_a_simulation_ends():
    run = simulate(THESIS_A, ContinuousPID((50, 100, 50), kd=(20, 20, 20)), (np.pi / 2, np.pi / 2, -np.pi / 3))
    np.testing.assert_allclose(solution("pid-1"), run.error[-1], atol=1e-6)


@pytest.mark.parametrize(("factor", "grows"), [(0.98, False), (1.02, True)])
def test_longest_period_by_stepping(factor, grows):
    v, T = 1.0, factor * solution("pid-3")
    for _ in range(500):
        v += T * (-40.0 * v) / 0.25
    assert (abs(v) > 1) == grows


def test_a_period_that_grows_is_refused():
    longest = find("pid-3")
    assert grade(longest, 0.0125).state == "right"
    assert grade(longest, 0.0126).state == grade(longest, 0.0124).state == "wrong"
