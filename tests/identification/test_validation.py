"""Validation: the fit of Table 4.4 by hand, a model that is right scores 100 %, one that is wrong less, raw u is kept."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refused

from ir50p_lab.identification import nrmse_fit, regressor, validate
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import at_rest, fourier

THETA = np.array(IR50P.theta_pwm)
A, B = at_rest(*np.random.default_rng(2).normal(0, 0.15, (2, 3, 4)))
TARGET = fourier(A, B, period=10.0, q0=(0, 0.6, -1), periods=2)


def analytic(rate=200.0, delay=0.0):
    """u = Phi theta of an analytic motion, at the samples; with a delay it acts later than it stands there."""
    t = np.arange(int(20 * rate)) / rate
    q = TARGET.sample(t)[:, 0]
    rows = TARGET.sample(t + delay)
    u = np.einsum("nij,ij->ni", regressor(rows[:, 0], rows[:, 1], rows[:, 2]), THETA)
    return SimpleNamespace(t=t, q=q, u=u)


# --- numbers


@given(st.integers(0, 1000), st.floats(-2, 1))
def test_fit_by_hand(seed, level):
    y = np.random.default_rng(seed).normal(3, 2, (50, 3))
    p = y.mean(axis=0) + (1 - level) * (y - y.mean(axis=0))
    rms, fit = nrmse_fit(y, p)
    np.testing.assert_allclose(rms, abs(level) * y.std(axis=0), atol=1e-12)
    np.testing.assert_allclose(fit, 100 * (1 - abs(level)), atol=1e-9)
    np.testing.assert_allclose(nrmse_fit(y[:, 0], p[:, 0]), (rms[0], fit[0]), atol=1e-12)


def test_the_right_model_scores_and_a_wrong_one_does_not():
    record = analytic()
    found = validate(THETA, record, cutoff_hz=8.0, held=False)
    assert (found.fit > 98).all() and found.of == "u"
    np.testing.assert_allclose(found.measured.std(axis=0), found.rms / (1 - found.fit / 100))
    np.testing.assert_array_equal(found.measured, record.u[np.searchsorted(record.t, found.t)])  # raw, all of them
    np.testing.assert_array_equal(found.residuals, found.measured - found.predicted)
    np.testing.assert_array_equal(
        validate(SimpleNamespace(theta=THETA), record, cutoff_hz=8.0, held=False).rms, found.rms
    )
    for joint, column in ((0, 0), (1, 2), (2, 15)):
        wrong = THETA.copy()
        wrong[joint, column] *= 1.5
        fit = validate(wrong, record, cutoff_hz=8.0, held=False).fit
        assert fit[joint] < found.fit[joint] - 3
        np.testing.assert_allclose(np.delete(fit, joint), np.delete(found.fit, joint))


@pytest.mark.parametrize("delay", [0.02, 0.1])
def test_delay_is_taken_into_account(delay):
    record = analytic(delay=delay)
    assert (validate(THETA, record, cutoff_hz=8.0, delay=delay, held=False).fit > 98).all()
    assert (validate(THETA, record, cutoff_hz=8.0, held=False).fit < 97).all()


# --- refusals


def test_bad_input():
    record = analytic(rate=50.0)
    refused("q has shape", validate, THETA, record.t, record.q[:, :2], record.u[:, :2])
    refused("theta with shape", validate, THETA[:2], record)
    for delay in (-1, np.nan, None):
        refused("delay", validate, THETA, record, delay=delay)


@pytest.mark.parametrize(
    "y, p, words",
    [
        (np.zeros(5), np.zeros(4), "one shape"),
        (np.zeros(1), np.zeros(1), "one shape"),
        (np.arange(5.0), np.full(5, np.nan), "predicted holds"),
        (np.ones((5, 2)), np.zeros((5, 2)), "never changes"),
    ],
)
def test_bad_columns(y, p, words):
    refused(words, nrmse_fit, y, p)
