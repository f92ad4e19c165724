"""Exercises of notebook 10: right answers by another route."""

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.exercises import solution
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold, low_pass


def test_the_filtered_ramp_is_behind_by_that_much():
    ramp = 0.5 * np.arange(500) * 0.01
    assert ramp[-1] - low_pass(ramp, 2.0, 100)[-1] == pytest.approx(solution("bench-4"), abs=1e-6)


@pytest.mark.parametrize(("share", "moves"), [(0.8, False), (1.3, True)])
def test_friction_holds_up_to_that_error(share, moves):
    """From a set point that is nearer joint 1 does not start; from one farther away it does (units differ by 5 %)."""
    bench = SimulatedBench(IR50P, record_to=False).open()
    goal = share * solution("bench-5")
    bench.follow(PID((289, 0, 0), limit_pwm=255), hold([goal, 0, 0]), 3)
    assert (np.ptp(bench.truth.q[:, 0]) > 0.01) == moves
