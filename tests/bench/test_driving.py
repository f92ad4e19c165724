"""PWM mapping and stop criterion: the thesis' map drives at rest, its criterion stops far off, letting go drops joint 2."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.bench import StopCriterion, bridge_inputs, mean_voltage, sign_and_magnitude, thesis_map
from ir50p_lab.controllers import PID
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold, quintic
from ir50p_lab.simulation import simulate

AT_REST = hold((0, 0, 0))(0)


def pid(ki2=150):
    return PID(kp=(289, 225, 270), ki=(50, ki2, 50), kd=(40, 30, 30), limit_pwm=255)


@given(st.floats(-600, 600))
def test_direction_times_duty_is_the_command(u):
    direction, duty = sign_and_magnitude(u)
    assert direction * duty == pytest.approx(max(-255, min(255, u)), abs=0.5) and 0 <= duty <= 255
    share, reverse = bridge_inputs(u)
    assert 0 <= share <= 1 and share - reverse == pytest.approx(direction * duty / 255)
    assert mean_voltage(duty, direction) == pytest.approx(12 * (share - reverse))


def test_the_map_of_the_thesis_drives_a_joint_that_shall_stand():
    assert thesis_map(0) == 127.5 and thesis_map(-255) == 0 and thesis_map(255) == 255 and thesis_map(999) == 255
    u = np.linspace(-255, 255, 511)
    right = mean_voltage(sign_and_magnitude(u)[1], sign_and_magnitude(u)[0])
    np.testing.assert_allclose(right, 12 * u / 255, atol=1e-12)
    assert mean_voltage(thesis_map(0)) == 6  # half the supply at u = 0
    np.testing.assert_allclose(mean_voltage(thesis_map(u), wiring="locked anti-phase"), right, atol=1e-12)


@pytest.mark.parametrize("bad", [math.nan, math.inf, [0, math.nan, 0]])
def test_numbers_that_are_not_finite(bad):
    for function in (sign_and_magnitude, bridge_inputs, thesis_map, mean_voltage):
        with pytest.raises(InputError, match="finite"):
            function(bad)


@pytest.mark.parametrize("duty", [-1, 255.1, 300, 1e6])
def test_bad_duty_and_wiring(duty):
    with pytest.raises(InputError, match="0 to 255"):
        mean_voltage(duty)
    with pytest.raises(InputError, match="wiring"):
        mean_voltage(0, wiring="star")


# ---- the stop criterion


class Proportional:
    """u = 100 e, and what it was shown."""

    unit = "PWM"

    def step(self, t, measured, reference):
        self.shown = np.array(reference[0]) - measured
        return 100 * self.shown


def unsmoothed(controller, **options):
    stop = StopCriterion(controller, **options)
    stop.smooth = 0
    return stop


def run(stop, errors, **motion):
    """Feed errors of joint 1 at 100 Hz; returns u and stopped of joint 1 over time."""
    u, stopped = [], []
    for k, e in enumerate(errors):
        u.append(stop.step(0.01 * k, np.array([-e, 0.5, 0.5]), AT_REST)[0])
        stopped.append(bool(stop.stopped[0]))
    return np.array(u), np.array(stopped)


def test_hysteresis_per_joint_and_either_sign():
    for sign in (1, -1):
        stop = unsmoothed(Proportional())
        u, stopped = run(stop, sign * np.array([0.05, 0.011, 0.009, 0.015, 0.019, 0.021, 0.015, 0.009]))
        assert stopped.tolist() == [False, False, True, True, True, False, False, True]
        np.testing.assert_allclose(u, sign * np.array([5, 1.1, 1.1, 1.1, 1.1, 2.1, 1.5, 1.5]), atol=1e-12)
        assert not stop.stopped[1:].any()  # 0.5 rad off


def test_off_lets_go_and_the_controller_inside_sees_no_error():
    inside = Proportional()
    stop = unsmoothed(inside, hold="off")
    u, _ = run(stop, [0.05, 0.009, 0.015])
    np.testing.assert_allclose(u, [5, 0, 0])
    assert inside.shown[0] == 0 and inside.shown[1] == -0.5


def test_the_signed_criterion_of_the_thesis_stops_far_off():
    errors = [-1.0] * 5
    _, stopped = run(unsmoothed(Proportional(), signed=True, hold="off"), errors)
    assert stopped.all()
    _, stopped = run(unsmoothed(Proportional()), errors)
    assert not stopped.any()


def test_a_moving_reference_is_followed():
    stop = unsmoothed(Proportional())
    stop.step(0.0, np.zeros(3), AT_REST)
    assert stop.stopped.all()
    stop.step(0.01, np.zeros(3), (np.zeros(3), (0.1, 0, 0), np.zeros(3)))
    assert stop.stopped.tolist() == [False, True, True]


def follow(controller):
    start, goal = (0, 0.3, -1), (1.0, 0.6, -1.2)
    reference = quintic(start, goal, duration=3)
    return simulate(IR50P, controller, reference, duration=40, q0=start, stops=True)


def test_what_letting_go_does_under_gravity():
    kept, off = follow(StopCriterion(pid())), follow(StopCriterion(pid(), hold="off"))
    late = slice(2500, None)
    assert np.abs(kept.error[late, :2]).max() < 0.025  # the outer bound and the low pass
    assert np.abs(kept.qd[late, 1]).max() < 0.02  # held while it still creeps, it creeps on to the outer bound
    assert np.abs(off.qd[late, 1]).max() > 0.2  # joint 2 drops and is lifted, for ever
    assert off.error[late, 1].max() > 0.03
    assert np.ptp(off.q[late, 0]) < 1e-9  # joint 1: gravity does not turn it


def test_reset_and_unit():
    stop = StopCriterion(pid())
    assert stop.unit == "PWM"
    run(stop, [0.005] * 40)
    assert stop.stopped[0]
    stop.reset()
    assert not stop.stopped.any() and not stop.controller.state.any()


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"hold": "brake"}, "hold"),
        ({"controller": None}, "controller"),
    ],
)
def test_bad_options(options, match):
    with pytest.raises(InputError, match=match):
        StopCriterion(**{"controller": pid()} | options)
