"""Velocity estimates: the Kalman gain by three routes, noise and lag as theory has them, loop equal to record."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.errors import InputError
from ir50p_lab.signals import (
    VelocityKalman,
    difference_velocity,
    low_pass_lag,
    noise_and_lag,
    quintic,
)

RATE, PERIOD = 100.0, 0.01
SETTINGS = [(0.0056, 3.0), (0.0056, 10.0), (0.0056, 100.0), (1e-4, 10.0), (0.05, 1.0)]


@pytest.mark.parametrize(("noise", "change"), SETTINGS)
def test_gain_of_constant_velocity_is_kalatas_closed_form(noise, change):
    index = change * PERIOD**2 / noise
    r = (4 + index - math.sqrt(8 * index + index**2)) / 4
    alpha = 1 - r**2
    beta = 2 * (2 - alpha) - 4 * math.sqrt(1 - alpha)
    gain = VelocityKalman(PERIOD, noise=noise, change=change).gain
    np.testing.assert_allclose(gain, [[alpha, beta / PERIOD, 0]] * 3, rtol=1e-6)


@pytest.mark.parametrize(("noise", "change"), SETTINGS)
@pytest.mark.parametrize("size", [2, 3])
def test_gain_is_where_the_riccati_recursion_settles(noise, change, size):
    F = np.array([[1, PERIOD, PERIOD**2 / 2], [0, 1, PERIOD], [0, 0, 1]])[:size, :size]
    G = np.array([PERIOD**2 / 2, PERIOD, 1])[:size] * change
    P = np.eye(size)
    for _ in range(8000):
        K = P[:, 0] / (P[0, 0] + noise**2)
        P = F @ (P - np.outer(K, P[0])) @ F.T + np.outer(G, G)
    model = "velocity" if size == 2 else "acceleration"
    gain = VelocityKalman(PERIOD, noise=noise, change=change, model=model).gain
    np.testing.assert_allclose(gain[0, :size], P[:, 0] / (P[0, 0] + noise**2), rtol=1e-5)


@pytest.mark.parametrize("model", ["velocity", "acceleration"])
def test_sample_by_sample_gives_the_same_numbers(model):
    q = np.random.default_rng(0).normal(size=(300, 3))
    loop, whole = VelocityKalman(model=model), VelocityKalman(model=model)
    steps = np.array([loop.step(row) for row in q])
    np.testing.assert_array_equal(steps, np.stack(whole.estimate(q), axis=1))
    loop.reset()
    np.testing.assert_array_equal(loop.step(q[0])[1], 0)


@given(st.floats(-2, 2), st.floats(-3, 3), st.floats(0.5, 100))
def test_steady_motion_is_found_without_lag(q0, speed, change):
    q = np.repeat((q0 + speed * np.arange(3000) * PERIOD)[:, None], 3, axis=1)
    angle, velocity = VelocityKalman(change=change).estimate(q)
    np.testing.assert_allclose(angle[-1], q[-1], atol=1e-5)
    np.testing.assert_allclose(velocity[-1], speed, atol=1e-4)


def test_noise_at_rest_and_lag_in_acceleration_are_those_of_theory():
    sigma = 0.0056
    q = np.random.default_rng(3).normal(0, sigma, (200_000, 3))
    kalman = VelocityKalman(noise=sigma, change=10)
    alpha, beta = kalman.gain[0, 0], kalman.gain[0, 1] * PERIOD
    theory = sigma / PERIOD * beta * math.sqrt(2 / (alpha * (4 - 2 * alpha - beta)))
    assert kalman.estimate(q)[1][1000:].std() == pytest.approx(theory, rel=0.03)
    t = np.arange(2000) * PERIOD
    ramp = np.repeat((0.5 * t**2)[:, None], 3, axis=1)
    late = t[-1] - kalman.estimate(ramp)[1][-1, 0]  # at 1 rad/s^2 the lag is the error of velocity
    assert late == pytest.approx(PERIOD * (alpha / beta - 0.5), rel=1e-6)
    jerkless = VelocityKalman(noise=sigma, change=1, model="acceleration")
    assert t[-1] - jerkless.estimate(ramp)[1][-1, 0] == pytest.approx(0, abs=1e-4)


def test_differences_amplify_noise():
    q = np.random.default_rng(4).normal(0, 0.0056, 100_000)
    assert difference_velocity(q, RATE).std() == pytest.approx(math.sqrt(2) * RATE * 0.0056, rel=0.02)


def test_noise_against_lag_on_one_record():
    t = np.arange(3000) * PERIOD
    rows = quintic((0, 0, 0), (1.5, 1, 1), duration=4, start=10).sample(t)
    q = np.rint(rows[:, 0, 0] * 189.1 + np.random.default_rng(1).normal(0, 1, 3000)) / 189.1
    found = noise_and_lag(q, RATE, rest=slice(0, 900), motion=slice(900, 1600), truth=rows[:, 1, 0])
    blind = noise_and_lag(q, RATE, rest=slice(0, 900), motion=slice(900, 1600))
    by_name = {one.name: one for one in found}
    for cutoff in (2, 5, 10):
        theory = low_pass_lag(cutoff, RATE) + PERIOD / 2  # the difference is half a period late
        assert by_name[f"difference, low pass {cutoff} Hz"].lag == pytest.approx(theory, abs=3e-3)
    for one, other in zip(found, blind, strict=True):
        assert one.lag == pytest.approx(other.lag, abs=4e-3) and one.noise == other.noise
    for family in ("low pass", "Kalman"):  # less of the one is more of the other
        members = sorted((one.noise, one.lag) for one in found if family in one.name)
        assert [lag for _, lag in members] == sorted((lag for _, lag in members), reverse=True)
    quiet, low = by_name["Kalman, 10 rad/s²"], by_name["difference, low pass 5 Hz"]
    assert quiet.noise < low.noise and quiet.lag < low.lag  # with less noise and less lag than the low pass


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"period": 0}, "period"),
        ({"period": math.nan}, "period"),
        ({"noise": 0.0}, "noise"),
        ({"noise": (1, 1)}, "noise"),
        ({"change": -1}, "change"),
        ({"change": math.inf}, "change"),
        ({"model": "jerk"}, "model"),
    ],
)
def test_bad_options(options, match):
    with pytest.raises(InputError, match=match):
        VelocityKalman(**options)


def test_bad_samples():
    kalman = VelocityKalman()
    kalman.step(np.zeros(3))
    for bad in ((math.nan, 0, 0), (0, 0), np.zeros((2, 3)), "q"):
        with pytest.raises(InputError):
            kalman.step(bad)
    np.testing.assert_array_equal(kalman.step(np.zeros(3)), np.zeros((2, 3)))
    with pytest.raises(InputError):
        kalman.estimate(np.zeros(3))
    with pytest.raises(InputError, match="three samples"):
        difference_velocity([0.0, 1.0], RATE)
    with pytest.raises(InputError, match="does not move"):
        noise_and_lag(np.zeros(200), RATE, rest=slice(0, 50), motion=slice(50, 200), truth=np.zeros(200))
    with pytest.raises(InputError, match="10 or more"):
        noise_and_lag(np.zeros(200), RATE, rest=slice(0, 5), motion=slice(50, 200))
