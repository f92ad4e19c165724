"""Pictures for tuning: what is drawn is what was simulated; the same picture for the same numbers."""

from types import SimpleNamespace

import numpy as np
import pytest

from ir50p_lab.controllers import PID
from ir50p_lab.course.loops.tuning_views import one_joint
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

TARGET = np.array([0.8, 0.5, -0.7])


@pytest.fixture(scope="module")
def run():
    return simulate(IR50P, PID((289, 225, 270), kd=(40, 30, 30), limit_pwm=255), TARGET, duration=2)


def test_one_joint_shows_each_run_and_the_target_of_the_first(run):
    """A simulated run and one with a flat reference, as recordings have it."""
    flat = SimpleNamespace(t=run.t, q=run.q + 0.1, u=run.u - 5, reference=run.reference[:, 0])
    figure = one_joint(run, flat, labels=["a", "b"], joint=2)
    target, first, second = (line.get_ydata() for line in figure.axes[0].lines)
    np.testing.assert_array_equal(target, run.reference[:, 0, 1])
    np.testing.assert_array_equal(first, run.q[:, 1])
    np.testing.assert_array_equal(second, flat.q[:, 1])
    np.testing.assert_array_equal(figure.axes[1].lines[1].get_ydata(), flat.u[:, 1])
