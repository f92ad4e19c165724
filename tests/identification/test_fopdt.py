"""FOPDT fit: exact simulation, honest standard errors, refusals that name the remedy, no false ones."""

import math

import numpy as np
import pytest
from refusals import refused
from scipy.signal import lfilter

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification import FOPDT, fit_fopdt
from ir50p_lab.simulation.first_order_lag import respond

PERIOD = 0.02
T_S = np.arange(200) * PERIOD  # 4 s
STEP = np.where(T_S >= 0.4, 1.0, 0.0)
SINCE = np.maximum(T_S - 0.4, 0.0)  # s since the step


def noise(seed, size, correlation=0.0):
    """First-order noise of standard deviation `size` and this correlation of neighbours."""
    white = np.random.default_rng(seed).normal(size=len(T_S) + 300)
    return size * lfilter([math.sqrt(1 - correlation**2)], [1, -correlation], white)[300:]


def lag(t, T):
    return -np.expm1(-np.maximum(t, 0) / T)


def errors(found, **truth):
    """Distance from the truth in standard errors, (3,)."""
    return np.array([abs(getattr(found, k) - x) / getattr(found, f"{k}_stderr") for k, x in truth.items()])


def said(found):
    return " ".join(found.warnings)


# --- the model


@pytest.mark.parametrize("a", [2.0, 1e-3, 1e-9, 0.0, -1e-3, -1.5])
def test_the_kernel_at_any_rate(a):
    """By the formula; near a = 0 by its series, where the formula loses digits."""
    times, jumps, L = np.array([0.4, 1.003]), np.array([1.0, -2.5]), 0.1234
    out, expected = np.zeros((2, len(T_S)))
    respond(T_S, times, jumps, a, L, out)
    for time, jump in zip(times, jumps, strict=True):
        s = np.maximum(T_S - time - L, 0)
        expected += jump * (s - a * s**2 / 2 + a**2 * s**3 / 6 if abs(a) < 1e-2 else (1 - np.exp(-a * s)) / a)
    np.testing.assert_allclose(out, expected, atol=1e-9 * np.abs(out).max())


# --- the fit


@pytest.mark.parametrize("seed", range(9))
def test_exact_data_of_any_scale_give_the_exact_model(seed):
    """Even and uneven times, a step, many steps, or an input that changes at every sample."""
    rng = np.random.default_rng(seed)
    dt, n = 10 ** rng.uniform(-3, 2), int(rng.integers(60, 400))
    t = np.sort(rng.uniform(0, n, n)) * dt - 50 if seed % 3 == 0 else np.arange(n) * dt
    u = [
        np.where(np.arange(n) >= n // 10, 1.0, -0.3),
        np.repeat(rng.choice([0, 1.0], n // 10 + 1), 10)[:n],
        rng.normal(size=n).cumsum(),
    ][seed % 3 if seed % 2 else 0]
    u = u * 10 ** rng.uniform(-3, 3)
    T, L = dt * 10 ** rng.uniform(0.3, math.log10(0.4 * n)), dt * rng.uniform(1.5, 0.4 * n)
    model = FOPDT(K=10 ** rng.uniform(-3, 3) * rng.choice([-1, 1]), T=T, L=L, y0=rng.normal())
    y = model.response(t, u)
    found = fit_fopdt(t, u, y)
    assert [found.K, found.T, found.L] == pytest.approx([model.K, T, L], rel=1e-7)
    assert found.y0 == pytest.approx(model.y0, abs=1e-6 * np.ptp(y))
    assert found.warnings == ()


def test_step_in_the_first_sample_needs_the_input_before_it():
    u = np.ones_like(T_S)
    y = FOPDT(K=2, T=0.5, L=0.1).response(T_S, u, u_before=0.0)
    refused("u_before=", fit_fopdt, T_S, u, y, error=IdentificationError)
    found = fit_fopdt(T_S, u, y, u_before=0)
    assert (found.K, found.T, found.L) == pytest.approx((2, 0.5, 0.1))


@pytest.mark.parametrize("kind", ["a step", "many steps, uneven times"])
def test_true_values_lie_within_two_standard_errors_95_times_in_100(kind):
    """White noise, 15 seeds, three parameters. Binomial: 95.4 % of 45 is 42.9 +- 1.4; 38 is 3.5 deviations off."""
    rng, t, u = np.random.default_rng(7), T_S, STEP
    if kind != "a step":
        t, u = np.sort(rng.uniform(0, 4, 200)), np.repeat(rng.choice([0.0, 1.0], 8), 25)
    truth = {"K": -1.5, "T": 0.5, "L": 0.133}
    y = FOPDT(**truth, y0=3.0).response(t, u)
    z = np.array([errors(fit_fopdt(t, u, y + noise(seed, 0.06)), **truth) for seed in range(15)])
    assert 38 <= (z < 2).sum() < 45
    assert (z < 4).all()


@pytest.mark.parametrize("flaw", ["coloured", "drifts", "not at rest", "clock", "coarse"])
def test_what_white_noise_does_not_hold_is_in_the_errors(flaw):
    """Without the widening K, T or L of most of these is off by more than four errors, by up to a hundred."""
    for seed in range(8):
        rng = np.random.default_rng(seed)
        truth = {"K": 1.0, "T": rng.uniform(0.1, 0.5), "L": rng.uniform(0.05, 0.4)}
        t, y = T_S, lag(SINCE - truth["L"], truth["T"])
        if flaw == "coloured":
            y = y + noise(seed, 0.03, correlation=0.8)
        elif flaw == "clock":
            t = t + PERIOD * rng.uniform(0.1, 0.4) * rng.uniform(-1, 1, len(t))
        elif flaw == "coarse":
            steps = rng.uniform(40, 300)
            y = np.round(steps * y + rng.uniform()) / steps
        else:
            y = y + noise(seed, 0.01) + 0.3 * (t / 4 if flaw == "drifts" else np.exp(-t / truth["T"]))
        found = fit_fopdt(t, STEP, y)
        assert (errors(found, **truth) < 4.5).all(), found
        word = {"coloured": "not white", "drifts": "drifts", "not at rest": "not at rest"}.get(flaw, "")
        assert word in said(found), found


def test_what_a_record_cannot_tell_is_said():
    """T longer than the record; a dead time lost in noise; T or L below a period."""
    slow = fit_fopdt(T_S, STEP, 5 * lag(SINCE - 0.2, 6.0) + noise(1, 0.001))
    assert "not settled" in said(slow) and abs(slow.T - 6.0) < 3 * slow.T_stderr
    lost = fit_fopdt(T_S, STEP, lag(SINCE - 0.04, 0.5) + noise(0, 0.3))
    assert "cannot be told from zero" in said(lost) or "not identifiable" in said(lost)
    at_once = fit_fopdt(T_S, STEP, lag(SINCE - 0.5 * PERIOD, 0.2) + noise(2, 0.001))
    assert "dead time is not identifiable" in said(at_once) and at_once.L_stderr >= 0.99 * PERIOD
    sudden = fit_fopdt(T_S, STEP, lag(SINCE - 0.1, 0.1 * PERIOD) + noise(2, 0.003))
    assert "time constant is not identifiable" in said(sudden) and math.isinf(sudden.T_stderr)


def test_milliseconds_and_outliers_are_named():
    y = 2 * lag(SINCE - 0.1, 0.3) + noise(0, 0.01)
    plain = fit_fopdt(T_S, STEP, y)
    assert plain.warnings == ()
    ms = fit_fopdt(np.rint(1000 * T_S), STEP, y)
    assert "milliseconds" in ms.warnings[0] and ms.T == pytest.approx(1000 * plain.T, rel=3e-3)
    spoilt, glitch = y.copy(), STEP.copy()
    spoilt[[70, 100, 150]] += [-3, 5, 5]
    glitch[120] = 20.0
    found = fit_fopdt(T_S, STEP, spoilt)
    assert "y has 3 outlier(s)" in found.warnings[0]
    assert abs(found.T - plain.T) < 2 * plain.T_stderr and abs(found.K - plain.K) < 2 * plain.K_stderr
    assert "u has 1 outlier" in said(fit_fopdt(T_S, glitch, y, anyway=True))
    hidden = np.ma.array(y, mask=(T_S > 0.35) & (T_S < 0.45))  # what is masked in y hides no step of u
    assert (errors(fit_fopdt(T_S, STEP, hidden), K=2, T=0.3, L=0.1) < 4).all()


# --- refusals


def swing(damping, w=6.0):
    wd = w * math.sqrt(1 - damping**2)
    return 1 - np.exp(-damping * w * SINCE) * (np.cos(wd * SINCE) + damping * w / wd * np.sin(wd * SINCE))


REFUSED = {  # y, and what is said
    "an integrating joint": (SINCE - 0.5 * lag(SINCE, 0.5), "integrates"),
    "a slow ramp": (SINCE - 20 * lag(SINCE, 20), "integrates"),
    "a growing response": (np.expm1(SINCE / 0.6), "unstable"),
    "a swing": (swing(0.15), "not have the shape of the model"),
    "a long swing": (swing(0.05), "y does not follow u"),
    "nothing": (0 * SINCE, "y does not follow u"),
}


@pytest.mark.parametrize("size", [0.001, 0.03])
@pytest.mark.parametrize("y, words", REFUSED.values(), ids=REFUSED)
def test_what_is_no_fopdt_is_refused(y, words, size):
    y = 1e4 * (y / max(y.max(), 1.0) + noise(3, size)) - 3e3
    refused(words, fit_fopdt, T_S, STEP, y, error=IdentificationError)


def test_anyway_goes_on_and_a_doubt_is_a_warning():
    forced = fit_fopdt(T_S, STEP, swing(0.15), anyway=True)
    assert forced.warnings[0].startswith("went on anyway: the response does not have the shape")
    assert "not have the shape of the model (9" in said(fit_fopdt(T_S, STEP, swing(0.3)))


def test_too_little_is_refused():
    for u, y, words in (
        (0 * STEP + 3, SINCE, "u never changes"),
        (STEP, 0 * SINCE - 1e6, "y stays at"),
        (np.where(T_S > T_S[-5], 1.0, 0.0), SINCE, "only 4 samples"),
    ):
        refused(words, fit_fopdt, T_S, u, y, error=IdentificationError)
    for change in ({"y": SINCE[1:]}, {"y": np.where(T_S == 1, np.nan, SINCE)}, {"t": T_S[::-1]}, {"u_before": "0"}):
        refused("", fit_fopdt, **{"t": T_S, "u": STEP, "y": SINCE} | change)
    for bad in ({"K": 0}, {"T": 0}, {"L": -0.1}, {"K": math.nan}):
        refused("give finite K", FOPDT, **{"K": 1.0, "T": 1.0, "L": 0.1} | bad)


# --- and nothing else is refused


@pytest.mark.parametrize("seed", range(20))
def test_good_records_are_never_refused(seed):
    """2 % noise: T and L above two periods, at least 1.5 T of response."""
    rng = np.random.default_rng(seed)
    T, L = rng.uniform(2, 60) * PERIOD, rng.uniform(3, 60) * PERIOD
    model = FOPDT(K=rng.choice([-1, 1]) * 10 ** rng.uniform(-4, 4), T=T, L=L)
    y = model.response(T_S, STEP)
    found = fit_fopdt(T_S, STEP, y + noise(seed, 0.02 * np.ptp(y)))
    assert abs(found.K - model.K) < 5 * found.K_stderr
