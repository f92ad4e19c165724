"""The delay: found on the bench within a period or two from steps, while Fourier motion cannot tell it."""

from types import SimpleNamespace

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import estimate_delay
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import at_rest, fourier, steps

rng = np.random.default_rng(0)
POSES = np.column_stack([rng.uniform(-0.6, 0.6, 40), rng.uniform(0.2, 1, 40), rng.uniform(-1.3, -0.5, 40)])
STEPS = steps(np.arange(40) * 1.5, POSES)
A, B = at_rest(*rng.normal(0, 0.2, (2, 3, 5)) / np.arange(1, 6))
FOURIER = fourier(A, B, period=10.0, q0=(0, 0.6, -0.9), periods=6)


def bench(reference, delay, seed=1):
    pid = PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)
    unit = ArmInstance(delay=delay)
    with SimulatedBench(IR50P, seed=seed, unit=unit, q0=reference(0.0)[0], record_to=False) as arm:
        return arm.follow(pid, reference, 60)


@pytest.mark.parametrize("delay", [0, 2, 5, 8])
def test_steps_on_the_bench_tell_it_within_two_periods(delay):
    found = estimate_delay(bench(STEPS, delay))
    assert abs(found.delay - 0.01 * delay) < 0.021
    assert abs(found.delay - 0.01 * delay) < 3 * found.stderr
    assert found.rms.shape == (16, 3)


def test_fourier_motion_cannot_tell_it():
    """The claim of the docstring: the estimate is off by far more, and it says so."""
    found = estimate_delay(bench(FOURIER, 2))
    assert np.abs(found.per_joint - 0.02).max() > 0.04 and found.warnings


def test_bad_input():
    t = np.arange(3000) * 0.01
    q = np.sin(t)[:, None] * [1.0, 1.0, 1.0]
    good = SimpleNamespace(t=t, q=q, u=q)
    with pytest.raises(InputError, match=r"give shape \(3,\)"):
        estimate_delay(t, q[:, :2], q[:, :2])
    for slow in (2.0, 10.0):
        with pytest.raises(IdentificationError, match="record steps"):
            estimate_delay(good, slow=slow)
