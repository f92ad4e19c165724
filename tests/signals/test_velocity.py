"""Velocity estimates: the Kalman gain by three routes, noise and lag as theory has them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.errors import InputError
from ir50p_lab.signals import (
    difference_velocity,
    kalman_velocity,
    low_pass_lag,
    noise_and_lag,
    quintic,
)
from ir50p_lab.signals.velocity import steady_gain

RATE, PERIOD = 100.0, 0.01
SETTINGS = [(0.0056, 3.0), (0.0056, 10.0), (0.0056, 100.0), (1e-4, 10.0), (0.05, 1.0)]


@pytest.mark.parametrize(("noise", "change"), SETTINGS)
def test_gain_of_constant_velocity_is_kalatas_closed_form(noise, change):
    index = change * PERIOD**2 / noise
    r = (4 + index - math.sqrt(8 * index + index**2)) / 4
    alpha = 1 - r**2
    beta = 2 * (2 - alpha) - 4 * math.sqrt(1 - alpha)
    np.testing.assert_allclose(steady_gain(index), [alpha, beta], rtol=1e-6)


@pytest.mark.parametrize(("noise", "change"), SETTINGS)
def test_gain_is_where_the_riccati_recursion_settles(noise, change):
    F, G = np.array([[1, PERIOD], [0, 1]]), np.array([PERIOD**2 / 2, PERIOD]) * change
    P = np.eye(2)
    for _ in range(8000):
        K = P[:, 0] / (P[0, 0] + noise**2)
        P = F @ (P - np.outer(K, P[0])) @ F.T + np.outer(G, G)
    gain = steady_gain(change * PERIOD**2 / noise) / (1, PERIOD)
    np.testing.assert_allclose(gain, P[:, 0] / (P[0, 0] + noise**2), rtol=1e-5)


def test_predicting_and_correcting_sample_by_sample_gives_the_same_numbers():
    q = np.random.default_rng(0).normal(size=(300, 3))
    x, K = np.array([q[0], np.zeros(3)]), steady_gain(10.0 * PERIOD**2 / 0.0056) / (1, PERIOD)
    velocities = [x[1]]
    for row in q[1:]:
        x = np.array([[1, PERIOD], [0, 1]]) @ x
        x = x + np.outer(K, row - x[0])
        velocities.append(x[1])
    found = kalman_velocity(q, RATE, noise=0.0056, change=10.0)
    np.testing.assert_allclose(found, velocities, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(kalman_velocity(q[:, 1], RATE, noise=0.0056, change=10.0), found[:, 1], rtol=1e-12)


@given(st.floats(-2, 2), st.floats(-3, 3), st.floats(0.5, 100))
def test_steady_motion_is_found_without_lag(q0, speed, change):
    q = q0 + speed * np.arange(3000) * PERIOD
    assert kalman_velocity(q, RATE, noise=0.0056, change=change)[-1] == pytest.approx(speed, abs=1e-4)


def test_noise_at_rest_and_lag_in_acceleration_are_those_of_theory():
    filters = {"noise": 0.0056, "change": 10}
    q = np.random.default_rng(3).normal(0, 0.0056, (200_000, 3))
    alpha, beta = steady_gain(10 * PERIOD**2 / 0.0056)
    theory = 0.0056 / PERIOD * beta * math.sqrt(2 / (alpha * (4 - 2 * alpha - beta)))
    assert kalman_velocity(q, RATE, **filters)[1000:].std() == pytest.approx(theory, rel=0.03)
    t = np.arange(2000) * PERIOD
    late = t[-1] - kalman_velocity(0.5 * t**2, RATE, **filters)[-1]  # at 1 rad/s^2 the lag is the error of velocity
    assert late == pytest.approx(PERIOD * (alpha / beta - 0.5), rel=1e-6)


def test_differences_amplify_noise():
    q = np.random.default_rng(4).normal(0, 0.0056, 100_000)
    assert difference_velocity(q, RATE).std() == pytest.approx(math.sqrt(2) * RATE * 0.0056, rel=0.02)


def test_noise_against_lag_on_one_record():
    t = np.arange(3000) * PERIOD
    rows = quintic((0, 0, 0), (1.5, 1, 1), duration=4, start=10).sample(t)
    q = np.rint(rows[:, 0, 0] * 189.1 + np.random.default_rng(1).normal(0, 1, 3000)) / 189.1
    noise = q[:900].std()
    estimates = {f"low pass {cutoff} Hz": difference_velocity(q, RATE, cutoff_hz=cutoff) for cutoff in (2, 5, 10)}
    estimates |= {f"Kalman {c}": kalman_velocity(q, RATE, noise=noise, change=c) for c in (3.0, 10.0, 30.0)}

    def judged(truth):
        where = {"rest": slice(0, 900), "motion": slice(900, 1600)}
        return {name: noise_and_lag(qd, truth, RATE, **where) for name, qd in estimates.items()}

    found = judged(rows[:, 1, 0])
    blind = judged(difference_velocity(q, RATE, cutoff_hz=3.0, order=2, kind="zero-phase"))
    for cutoff in (2, 5, 10):
        theory = low_pass_lag(cutoff, RATE) + PERIOD / 2  # the difference is half a period late
        assert found[f"low pass {cutoff} Hz"].lag == pytest.approx(theory, abs=3e-3)
    for name, one in found.items():
        assert one.lag == pytest.approx(blind[name].lag, abs=4e-3) and one.noise == blind[name].noise
    for family in ("low pass", "Kalman"):  # less of the one is more of the other
        members = sorted((one.noise, one.lag) for name, one in found.items() if family in name)
        assert [lag for _, lag in members] == sorted((lag for _, lag in members), reverse=True)
    quiet, low = found["Kalman 10.0"], found["low pass 5 Hz"]
    assert quiet.noise < low.noise and quiet.lag < low.lag  # with less noise and less lag than the low pass


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"rate_hz": 0}, "rate_hz"),
        ({"rate_hz": math.nan}, "rate_hz"),
        ({"noise": 0.0}, "noise"),
        ({"noise": (1, 1)}, "noise"),
        ({"change": -1}, "change"),
        ({"change": math.inf}, "change"),
    ],
)
def test_bad_options(options, match):
    with pytest.raises(InputError, match=match):
        kalman_velocity(np.zeros(20), **({"rate_hz": RATE, "noise": 0.01, "change": 10.0} | options))


def test_bad_records():
    with pytest.raises(InputError, match="three samples"):
        difference_velocity([0.0, 1.0], RATE)
    still = np.zeros(200)
    with pytest.raises(InputError, match="does not move"):
        noise_and_lag(still, still, RATE, rest=slice(0, 50), motion=slice(50, 200))
    with pytest.raises(InputError, match="10 or more"):
        noise_and_lag(still, still, RATE, rest=slice(0, 5), motion=slice(50, 200))
    with pytest.raises(InputError, match=r"\(n,\)"):
        noise_and_lag(still[:, None], still[:, None], RATE, rest=slice(0, 50), motion=slice(50, 200))
