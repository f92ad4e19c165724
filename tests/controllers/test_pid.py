"""The sampled PID, one test per feature."""

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.controllers import PID, ContinuousPID

ZERO = np.zeros(3)


def hold(*q):
    return np.array([q, ZERO, ZERO], dtype=float)


def run(pid, angles, target=(0.0, 0.0, 0.0), start=0.0, period=0.01):
    return np.array([pid.step(start + k * period, q, hold(*target)) for k, q in enumerate(np.atleast_2d(angles))])


def test_velocity_filter_is_the_first_order_low_pass_it_says():
    pid = PID(kp=(0, 0, 0), kd=(1, 1, 1), filter_hz=5)
    u = run(pid, 0.01 * np.arange(30)[:, None] * np.ones(3))  # velocity 1 rad/s from sample 1 on
    expected = 1 - np.exp(-2 * np.pi * 5 * 0.01 * np.arange(30))
    np.testing.assert_allclose(-u[:, 0], expected, atol=1e-12)
    unfiltered = run(PID(kp=(0, 0, 0), kd=(1, 1, 1), filter_hz=np.inf), 0.01 * np.arange(3)[:, None] * np.ones(3))
    np.testing.assert_allclose(unfiltered[:, 0], [0, -1, -1], atol=1e-12)


def test_position_filter_is_the_first_order_low_pass_it_says():
    u = run(PID(kp=1, position_filter_hz=3), [ZERO, *np.ones((30, 3))])  # q leaps from 0 to 1 rad
    np.testing.assert_allclose(-u[:, 0], 1 - np.exp(-2 * np.pi * 3 * 0.01 * np.arange(31)), atol=1e-12)


def test_no_position_filter_is_the_default_to_the_last_bit():
    q = np.random.default_rng(2).normal(size=(50, 3))
    gains = {"kp": (3, 4, 5), "ki": (1, 2, 3), "kd": (0.5, 0.2, 0.1)}
    plain = run(PID(**gains), q)
    np.testing.assert_array_equal(run(PID(**gains, position_filter_hz=np.inf), q), plain)
    np.testing.assert_array_equal(run(PID(**gains, position_filter_hz=None), q), plain)
    for bad in (0, -1, np.nan):
        refused("position_filter_hz", PID, kp=(1, 1, 1), position_filter_hz=bad)


def test_no_derivative_kick_on_the_measurement_and_one_on_the_error():
    for on, kick in (("measurement", False), ("error", True)):
        pid = PID(kp=(1, 1, 1), kd=(1, 1, 1), filter_hz=np.inf, derivative_on=on)
        run(pid, np.zeros((5, 3)))
        u = pid.step(0.05, np.zeros(3), hold(1, 1, 1))
        assert (u > 50).all() if kick else (u == 1).all()


def test_a_moving_reference_brings_its_velocity():
    pid = PID(kp=(0, 0, 0), kd=(2, 2, 2))
    u = pid.step(0.0, ZERO, [ZERO, [0.5, 0.5, 0.5], ZERO])
    np.testing.assert_allclose(u, 1.0)


@pytest.mark.parametrize("unit", ["limit", "limit_pwm"])
def test_the_command_is_limited(unit):
    pid = PID(kp=(100, 100, 100), **{unit: (10, 20, 255)})
    assert (pid.step(0.0, ZERO, hold(1, -1, 9)) == [10, -20, 255]).all()
    assert pid.unit == ("PWM" if unit == "limit_pwm" else "N m")


def test_anti_windup_lets_go_at_once():
    def after_saturation(anti_windup):
        pid = PID(kp=(1, 1, 1), ki=(10, 10, 10), limit=5, anti_windup=anti_windup)
        run(pid, np.zeros((500, 3)), target=(9, 9, 9))  # 5 s far from the target, limited
        return pid.step(5.0, [9.5, 9.5, 9.5], hold(9, 9, 9))

    assert (after_saturation(True) < 5).all()
    assert (after_saturation(False) == 5).all()  # wound up: still full drive, though past the target


def test_gains_change_without_a_bump():
    rng = np.random.default_rng(0)
    pid = PID(kp=(10, 10, 10), ki=(2, 2, 2), kd=(3, 3, 3), filter_hz=5)
    q = np.cumsum(rng.normal(0, 0.01, (60, 3)), axis=0)
    before = run(pid, q, target=(0.5, 0.5, 0.5))[-1]
    pid.set_gains(kp=(50, 20, 5), kd=(1, 9, 0), ki=(0, 5, 1))
    after = pid.step(0.60, q[-1] + 0.01 * pid.state[3:6], hold(0.5, 0.5, 0.5))
    assert (np.abs(after - before) < 0.5).all()
    assert (pid.kp == (50, 20, 5)).all() and (pid.ki == (0, 5, 1)).all() and (pid.kd == (1, 9, 0)).all()
    bumpy = PID(kp=(50, 20, 5), ki=(0, 5, 1), kd=(1, 9, 0), filter_hz=5)
    assert (np.abs(run(bumpy, q, target=(0.5, 0.5, 0.5))[-1] - before) > 2).any()


def test_reset_forgets():
    pid = PID(kp=(1, 1, 1), ki=(1, 1, 1), kd=(1, 1, 1))
    first = run(pid, np.ones((20, 3)))
    pid.reset()
    assert (run(pid, np.ones((20, 3))) == first).all()


@pytest.mark.parametrize("pause", [0.005, 0.02, 0.15, 60.0])
def test_after_a_pause_the_speed_is_taken_over_its_true_length(pause):
    pid = PID(kp=0, kd=1, ki=1, filter_hz=np.inf)
    pid.step(0.0, ZERO, hold(0, 0, 0))
    u = pid.step(pause, np.full(3, 0.3), hold(0, 0, 0))
    np.testing.assert_allclose(u, -0.3 / pause - 0.3 * min(pause, 0.1), rtol=1e-9)  # the integral counts ten periods


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: PID(kp=(1, -1, 1)), ["kp", "-1", ">= 0"]),
        (lambda: PID(kp=(1, np.nan, 1)), ["kp", "nan"]),
        (lambda: PID(kp=(1, 1)), ["kp", "(2,)"]),
        (lambda: PID(kp=(1, 1, 1), period=0), ["period = 0"]),
        (lambda: PID(kp=(1, 1, 1), filter_hz=-1), ["filter_hz = -1"]),
        (lambda: PID(kp=(1, 1, 1), limit=0), ["limit of joint 1 = 0"]),
        (lambda: PID(kp=(1, 1, 1), limit=1, limit_pwm=1), ["not both"]),
        (lambda: PID(kp=(1, 1, 1), derivative_on="nothing"), ["'nothing'", "'error'"]),
        (lambda: PID(kp=(1, 1, 1)).step(0, [0, np.nan, 0], hold(0, 0, 0)), ["measured q", "nan"]),
        (lambda: PID(kp=(1, 1, 1)).step(0, np.zeros((2, 3)), hold(0, 0, 0)), ["(2, 3)"]),
        (lambda: PID(kp=(1, 1, 1)).step(0, [0, 0, 0], [0, 0, 0]), ["reference", "(3,)"]),
        (lambda: ContinuousPID(kp=(1, 1, 1), limit=-5), ["limit of joint 1 = -5"]),
        (lambda: ContinuousPID(kp=(1, 1, -1)), ["kp", "-1"]),
    ],
)
def test_bad_input_gets_a_sentence(make, words):
    refused(words, make)


def test_header_says_gains_and_filters():
    header = PID(kp=(289, 225.5, 270), ki=1, kd=(40, 30, 30), position_filter_hz=3).header()
    assert header == {
        "controller": "PID",
        "kp": "289 225.5 270",
        "ki": "1 1 1",
        "kd": "40 30 30",
        "filter_hz": "10",
        "position_filter_hz": "3",
    }
    assert PID(kp=1, filter_hz=np.inf).header()["filter_hz"] == PID(kp=1).header()["position_filter_hz"] == "inf"


def test_time_that_runs_backwards_is_said_and_adds_nothing():
    pid = PID(kp=1, ki=1, kd=1)
    before = pid.step(5.0, ZERO, hold(1, 1, 1))
    with pytest.warns(UserWarning, match=r"t = 4\.99 s after 5 s: time runs backwards"):
        np.testing.assert_array_equal(pid.step(4.99, ZERO, hold(1, 1, 1)), before)
    pid.reset()
    pid.step(0.0, ZERO, hold(0, 0, 0))  # another run: no word
    refused("at t = nan s", pid.step, np.nan, ZERO, hold(0, 0, 0))
