"""Will the motors follow: what is computed against what the simulated bench then does."""

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import ComputedTorque, check_saturation
from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.modelling import IR50P, THESIS_C, THESIS_RODS, gravity, inverse_dynamics
from ir50p_lab.signals import hold, quintic, sinusoid

START, END = (0.0, 0.9, -1.2), (1.2, 0.2, -0.4)


def test_it_is_inverse_dynamics_along_the_motion():
    motion = quintic(START, END, duration=3)
    found = check_saturation(IR50P, motion)
    rows = motion.sample(found.t)
    np.testing.assert_allclose(found.u, inverse_dynamics(IR50P.theta_pwm, *rows.transpose(1, 0, 2)), rtol=1e-12)
    np.testing.assert_allclose(found.use, np.abs(found.u).max(axis=0) / 255)
    assert found.unit == "PWM" and found.t[-1] == pytest.approx(3) and "fits" in str(found)


def test_stretch_is_the_border():
    for duration in (0.5, 2.0, 20.0):
        stretch = check_saturation(IR50P, quintic(START, END, duration=duration)).stretch
        assert (stretch > 1) == check_saturation(IR50P, quintic(START, END, duration=duration)).saturates
        fits = check_saturation(IR50P, quintic(START, END, duration=duration * stretch * 1.01))
        fails = check_saturation(IR50P, quintic(START, END, duration=duration * stretch * 0.98))
        assert not fits.saturates and fails.saturates and fits.first is None and "saturates" in str(fails)


def test_the_bench_follows_what_fits_and_not_what_does_not():
    law = ComputedTorque(IR50P, (25, 9, 49), (10, 6, 14), limit_pwm=255, model_velocity="reference")

    def worst(duration):
        motion = quintic(START, END, duration=duration)
        with SimulatedBench(IR50P, seed=1, q0=START, record_to=False) as bench:
            bench.follow(law, motion, duration)
            return np.abs(bench.truth.q - motion.sample(bench.truth.t)[:, 0]).max(axis=0)

    limit = check_saturation(IR50P, quintic(START, END, duration=1.0)).stretch  # s
    assert worst(2.0 * limit).max() < 0.12
    assert worst(0.5 * limit).max() > 0.25


def test_a_load_too_heavy_to_hold_never_fits():
    heavy = 3 * IR50P.theta_pwm
    found = check_saturation(heavy, hold((0, 0, 0)), 1.0, limit=255)
    assert found.stretch == np.inf and found.saturates and found.first == 0.0
    assert np.abs(3 * gravity(IR50P.theta_pwm, np.zeros(3))).max() > 255 and "not even slowly" in str(found)


def test_limits():
    motion = sinusoid((0.8, 0.6, 0.6), (1, 1.5, 2))
    free = check_saturation(THESIS_C, motion, 10, limit=(50, 50, 50))
    tight = check_saturation(THESIS_C, motion, 10, limit=30)
    assert tight.stretch > free.stretch and free.unit == "N m"


@pytest.mark.parametrize(
    "make, error, words",
    [
        (lambda m: check_saturation(THESIS_C, m), InputError, ["limit = None"]),
        (lambda m: check_saturation(THESIS_RODS, m), ArmError, ["actuators"]),
        (lambda m: check_saturation(IR50P, m, limit=-1), InputError, ["limit", "-1"]),
        (lambda m: check_saturation(IR50P, m, 0), InputError, ["seconds = 0"]),
        (lambda m: check_saturation(IR50P, sinusoid(1, 1)), InputError, ["seconds = inf"]),
        (lambda m: check_saturation(IR50P, m, period=-1), InputError, ["period = -1"]),
        (lambda m: check_saturation(IR50P, [0, 0, 0]), InputError, ["reference"]),
        (lambda m: check_saturation("arm", m), InputError, ["expected an Arm"]),
        (lambda m: check_saturation(IR50P, m, g=3), InputError, ["g = 3"]),
    ],
)
def test_bad_input_gets_a_sentence(make, error, words):
    with pytest.raises(error) as caught:
        make(quintic(START, END, duration=1))
    for word in words:
        assert word in str(caught.value)
