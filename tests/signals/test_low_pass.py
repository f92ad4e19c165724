"""Filters: gain and lag by two routes, the loop's numbers equal to the record's, impossible cut-offs refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refused
from scipy.signal import freqz_sos

from ir50p_lab.signals import LowPass, alias, low_pass, low_pass_lag

RATE = 100.0
T = np.arange(4000) / RATE
SLOW = np.sin(2 * np.pi * 0.3 * T) + 0.5 * np.sin(2 * np.pi * 0.17 * T + 1)
FILTERS = [(order, cutoff) for order in (1, 2, 4, 8) for cutoff in (0.5, 2.0, 10.0, 45.0)]


def low_pass_response(cutoff, rate, f, *, order):
    """What the filter does to the frequencies f, Hz, complex."""
    return freqz_sos(LowPass(cutoff, rate, order=order).sections, worN=f, fs=rate)[1]


@pytest.mark.parametrize(("order", "cutoff"), FILTERS)
def test_gain_is_that_of_butterworth(order, cutoff):
    found = np.abs(low_pass_response(cutoff, RATE, [0, cutoff], order=order))
    np.testing.assert_allclose(found, (1, math.sqrt(0.5)), rtol=1e-9)
    analogue = np.tan(np.pi * np.array([1.0, 20.0, 40.0]) / RATE) / np.tan(np.pi * cutoff / RATE)
    np.testing.assert_allclose(  # Butterworth by its definition, frequencies bent by the bilinear transform
        np.abs(low_pass_response(cutoff, RATE, [1, 20, 40], order=order)),
        1 / np.sqrt(1 + analogue ** (2 * order)),
        rtol=1e-6,
    )


@pytest.mark.parametrize(("order", "cutoff"), FILTERS)
def test_group_delay_is_the_slope_of_the_phase(order, cutoff):
    f, h = np.array([0.01, 0.3, cutoff, 30.0]), 1e-4
    phase = np.angle(low_pass_response(cutoff, RATE, np.r_[f - h, f + h], order=order)).reshape(2, -1)
    slope = np.remainder(phase[0] - phase[1], 2 * np.pi) / (4 * np.pi * h)
    np.testing.assert_allclose(low_pass_lag(cutoff, RATE, order=order, at_hz=f), slope, rtol=1e-5, atol=1e-7)


def test_lag_of_first_order_is_one_over_the_cut_off():
    assert low_pass_lag(3.0, RATE) == pytest.approx(1 / (2 * math.pi * 3), rel=5e-3)
    assert low_pass_lag(3.0, RATE) == pytest.approx(1 / (2 * RATE * math.tan(math.pi * 3 / RATE)), rel=1e-12)


@pytest.mark.parametrize(("order", "cutoff"), FILTERS)
def test_sample_by_sample_gives_the_same_numbers(order, cutoff):
    rng = np.random.default_rng(1)
    x = rng.normal(3, 1, (200, 3))
    whole, loop = low_pass(x, cutoff, RATE, order=order), LowPass(cutoff, RATE, order=order)
    np.testing.assert_allclose([loop.step(row) for row in x], whole, rtol=1e-11, atol=1e-12)
    single = LowPass(cutoff, RATE, order=order)
    np.testing.assert_allclose([single.step(v) for v in x[:, 1]], whole[:, 1], rtol=1e-11, atol=1e-12)
    loop.reset()
    np.testing.assert_allclose(loop.step(x[5]), x[5], rtol=1e-12)


def test_zero_phase_has_half_the_power_gain():
    y = low_pass(np.sin(2 * np.pi * 5 * T), 5.0, RATE, order=2, kind="zero-phase")[1000:-1000]
    assert np.abs(y).max() == pytest.approx(0.5, rel=1e-3)


@given(st.floats(-1e3, 1e3), st.integers(1, 8), st.floats(0.1, 49.9))
def test_a_constant_passes_from_the_first_sample_on(level, order, cutoff):
    for kind in ("causal", "zero-phase"):
        y = low_pass(np.full(1100, level), cutoff, RATE, order=order, kind=kind)
        np.testing.assert_allclose(y, level, rtol=1e-4, atol=1e-9)


# ---- the thesis' cut-off


def test_300_hz_at_100_hz_is_refused_with_the_reason():
    refused(r"300 Hz, but samples at 100 Hz hold nothing above half their rate, 50 Hz", low_pass, SLOW, 300, 100)


def test_why_noise_above_half_the_rate_cannot_be_filtered_any_more():
    f = np.array([300.0, 290, 60, 49, 110, 997])
    np.testing.assert_allclose(alias(f, RATE), [0, 10, 40, 49, 10, 3], atol=1e-9)
    for high in f[1:]:  # the samples of both frequencies are the same
        low = alias(high, RATE)
        np.testing.assert_allclose(np.cos(2 * np.pi * high * T), np.cos(2 * np.pi * low * T), atol=1e-8)


@pytest.mark.parametrize("excess", [0.0, 1e-9, 0.1, 1.0, 50.0, 250.0, 1e6])
@pytest.mark.parametrize(
    "make", [lambda f: low_pass(SLOW, f, RATE), lambda f: LowPass(f, RATE), lambda f: low_pass_lag(f, RATE)]
)
def test_cut_off_at_or_above_half_the_rate(make, excess):
    refused("hold nothing above half their rate, 50 Hz", make, 50 + excess)
    make(49.9)


@pytest.mark.parametrize("cutoff", [0, -1e-9, -3, math.nan, None, "5", (3, 4)])
def test_cut_offs_that_are_none(cutoff):
    refused("cutoff_hz", low_pass, SLOW, cutoff, RATE)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", [0, 17, -1])
def test_numbers_that_are_not_finite(bad, place):
    x = SLOW.copy()
    x[place] = bad
    refused("x holds", low_pass, x, 3, RATE)
    loop = LowPass(3, RATE)
    loop.step(0.0)
    refused("finite", loop.step, bad)
    assert loop.step(0.0) == 0.0  # the refused sample has left no trace


def test_other_bad_input():
    refused("rate_hz", low_pass, SLOW, 3, 0)
    refused("order", low_pass, SLOW, 3, RATE, order=0)
    refused("kind", low_pass, SLOW, 3, RATE, kind="fast")
    refused("shape", low_pass, np.zeros((2, 2, 2)), 3, RATE)
    refused("numbers", low_pass, "noise", 3, RATE)
    refused("backward", low_pass, SLOW[:5], 3, RATE, kind="zero-phase")
    refused("half the rate", low_pass_lag, 3, RATE, at_hz=60)
