"""Filters: gain by two routes, impossible cut-offs refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refused

from ir50p_lab.signals import alias, low_pass

RATE = 100.0
T = np.arange(4000) / RATE
SLOW = np.sin(2 * np.pi * 0.3 * T) + 0.5 * np.sin(2 * np.pi * 0.17 * T + 1)
FILTERS = [(order, cutoff) for order in (1, 2, 4, 8) for cutoff in (0.5, 2.0, 10.0, 45.0)]


def low_pass_response(cutoff, rate, f, *, order):
    """What the filter does to the frequencies f, Hz, complex."""
    n = np.arange(30_000)
    answer = low_pass((n == 1).astype(float), cutoff, rate, order=order)  # to an impulse
    return np.exp(-2j * np.pi / rate * np.outer(f, n - 1)) @ answer


@pytest.mark.parametrize(("order", "cutoff"), FILTERS)
def test_gain_is_that_of_butterworth(order, cutoff):
    found = np.abs(low_pass_response(cutoff, RATE, [0, cutoff], order=order))
    np.testing.assert_allclose(found, (1, math.sqrt(0.5)), rtol=1e-9)
    analogue = np.tan(np.pi * np.array([1.0, 20.0, 40.0]) / RATE) / np.tan(np.pi * cutoff / RATE)
    np.testing.assert_allclose(  # Butterworth by its definition, frequencies bent by the bilinear transform
        np.abs(low_pass_response(cutoff, RATE, [1, 20, 40], order=order)),
        1 / np.sqrt(1 + analogue ** (2 * order)),
        rtol=1e-6,
        atol=1e-12,
    )


def test_zero_phase_has_half_the_power_gain():
    y = low_pass(np.sin(2 * np.pi * 5 * T), 5.0, RATE, order=2, kind="zero-phase")[1000:-1000]
    assert np.abs(y).max() == pytest.approx(0.5, rel=1e-3)


@given(st.floats(-1e3, 1e3), st.integers(1, 8), st.floats(0.1, 49.9))
def test_a_constant_passes_from_the_first_sample_on(level, order, cutoff):
    for kind in ("causal", "zero-phase"):
        y = low_pass(np.full(1100, level), cutoff, RATE, order=order, kind=kind)
        np.testing.assert_allclose(y, level, rtol=1e-4, atol=1e-9)


# ---- the thesis' cut-off


def test_why_noise_above_half_the_rate_cannot_be_filtered_any_more():
    f = np.array([300.0, 290, 60, 49, 110, 997])
    np.testing.assert_allclose(alias(f, RATE), [0, 10, 40, 49, 10, 3], atol=1e-9)
    for high in f[1:]:  # the samples of both frequencies are the same
        low = alias(high, RATE)
        np.testing.assert_allclose(np.cos(2 * np.pi * high * T), np.cos(2 * np.pi * low * T), atol=1e-8)


@pytest.mark.parametrize("excess", [0.0, 1e-9, 0.1, 1.0, 50.0, 250.0, 1e6])
def test_cut_off_at_or_above_half_the_rate(excess):
    said = f"{50 + excess:g} Hz, but samples at 100 Hz hold nothing above half their rate, 50 Hz"
    refused([said], low_pass, SLOW, 50 + excess, RATE)
    low_pass(SLOW, 49.9, RATE)


@pytest.mark.parametrize("cutoff", [0, -1e-9, -3, math.nan, None, "5", (3, 4)])
def test_cut_offs_that_are_none(cutoff):
    refused("cutoff_hz", low_pass, SLOW, cutoff, RATE)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", [0, 17, -1])
def test_numbers_that_are_not_finite(bad, place):
    x = SLOW.copy()
    x[place] = bad
    refused("x holds", low_pass, x, 3, RATE)


def test_other_bad_input():
    refused("rate_hz", low_pass, SLOW, 3, 0)
    refused("order", low_pass, SLOW, 3, RATE, order=0)
    refused("kind", low_pass, SLOW, 3, RATE, kind="fast")
    refused("shape", low_pass, np.zeros((2, 2, 2)), 3, RATE)
    refused("numbers", low_pass, "noise", 3, RATE)
    refused("backward", low_pass, SLOW[:5], 3, RATE, kind="zero-phase")
