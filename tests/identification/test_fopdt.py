"""FOPDT fit: exact simulation by two routes, honest standard errors, refusals at several magnitudes, no false ones."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import lfilter, lsim

from ir50p_lab.errors import IdentificationError, InputError, LabError
from ir50p_lab.identification import FOPDT, SecondOrderModel, fit_fopdt, fit_second_order
from ir50p_lab.simulation.first_order_lag import respond

PERIOD = 0.02
T_S = np.arange(200) * PERIOD  # 4 s
STEP = np.where(T_S >= 0.4, 1.0, 0.0)
SINCE = np.maximum(T_S - 0.4, 0.0)  # s since the step
NOISES = (0.0, 0.003, 0.03)  # of a response of 1
UNITS = ((-1e-5, 1.0), (1e4, -3e3), (1.0, 0.0))  # factor and offset: each noise has its own
IN_UNITS = [(size, lambda y, a=a, b=b: a * y + b) for size, (a, b) in zip(NOISES, UNITS, strict=True)]


def noise(seed, size, correlation=0.0):
    """First-order noise of standard deviation `size` and this correlation of neighbours."""
    white = np.random.default_rng(seed).normal(size=len(T_S) + 300)
    return size * lfilter([math.sqrt(1 - correlation**2)], [1, -correlation], white)[300:]


def lag(t, T):
    return -np.expm1(-np.maximum(t, 0) / T)


# --- the model


@pytest.mark.parametrize("T, L", [(0.5, 0.13), (0.02, 0.0), (7.0, 1.0), (0.3, 0.02)])
def test_response_is_the_sum_of_shifted_exponentials(T, L):
    rng = np.random.default_rng(5)
    t = np.cumsum(rng.uniform(0.001, 0.1, 300))  # uneven
    u = np.repeat(rng.normal(size=60), 5)
    u_before = 0.7
    expected = 2.0 + sum(
        -1.5 * step * lag(t - at - L, T) for at, step in zip(t, np.diff(u, prepend=u_before), strict=True)
    )
    found = FOPDT(K=-1.5, T=T, L=L, y0=2.0).response(t, u, u_before=u_before)
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_response_solves_the_differential_equation():
    T, L, K = 0.4, 0.173, 2.0
    u = 1.0 + np.sin(3 * T_S).round(1)
    u[0] = 0.0

    def late(t):
        return u[max(0, int(np.floor((t - L) / PERIOD + 1e-9)))]

    y = 0.0
    path = [y]
    corners = np.unique(np.r_[T_S[:60], T_S[:60] + L % PERIOD])
    for a, b in itertools.pairwise(corners):
        y = solve_ivp(lambda t, y, m=(a + b) / 2: (K * late(m) - y) / T, (a, b), [y], rtol=1e-10, atol=1e-12).y[0, -1]
        path.append(y)
    expected = np.array(path)[np.searchsorted(corners, T_S[:59])]
    np.testing.assert_allclose(FOPDT(K=K, T=T, L=L).response(T_S[:59], u[:59]), expected, atol=1e-8)


@pytest.mark.parametrize("a", [2.0, 1e-3, 1e-9, 0.0, -1e-3, -1.5, 0.3 + 2j])
def test_the_kernel_at_any_rate(a):
    """By the formula; near a = 0 by its series, where the formula loses digits."""
    times, jumps, L = np.array([0.4, 1.003]), np.array([1.0, -2.5]), 0.1234
    out, expected = np.zeros((2, len(T_S)), dtype=type(a))
    respond(T_S, times, jumps, a, L, out)
    for time, jump in zip(times, jumps, strict=True):
        s = np.maximum(T_S - time - L, 0)
        expected += jump * (s - a * s**2 / 2 + a**2 * s**3 / 6 if abs(a) < 1e-2 else (1 - np.exp(-a * s)) / a)
    np.testing.assert_allclose(out, expected, atol=1e-9 * np.abs(out).max())


# --- the fit


@pytest.mark.parametrize("seed", range(40))
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
    model = FOPDT(
        K=10 ** rng.uniform(-3, 3) * rng.choice([-1, 1]),
        T=dt * 10 ** rng.uniform(0.3, math.log10(0.4 * n)),
        L=dt * rng.uniform(1.5, 0.4 * n),
        y0=rng.normal(),
    )
    u = u * 10 ** rng.uniform(-3, 3)
    found = fit_fopdt(t, u, model.response(t, u))
    for name in ("K", "T", "L"):
        assert getattr(found, name) == pytest.approx(getattr(model, name), rel=1e-7)
    assert found.y0 == pytest.approx(model.y0, abs=1e-6 * np.ptp(model.response(t, u)))
    assert found.warnings == ()
    assert all(type(value) is float for value in dataclasses.astuple(found)[:-1])


def test_step_in_the_first_sample_needs_the_input_before_it():
    model = FOPDT(K=2, T=0.5, L=0.1)
    u = np.ones_like(T_S)
    y = model.response(T_S, u, u_before=0.0)
    with pytest.raises(IdentificationError, match="u_before="):
        fit_fopdt(T_S, u, y)
    found = fit_fopdt(T_S, u, y, u_before=0)
    assert (found.K, found.T, found.L) == pytest.approx((2, 0.5, 0.1))


@pytest.mark.parametrize("kind", ["step, little noise", "step, much noise", "many steps", "uneven times"])
def test_true_values_lie_within_two_standard_errors_95_times_in_100(kind):
    """White noise, 100 seeds. Binomial: 95.4 % of 100 is 95 +- 2; 88 is 3.6 deviations off."""
    rng, t, u = np.random.default_rng(7), T_S, STEP
    if kind == "many steps":
        u = np.repeat(rng.choice([0.0, 1.0], 20), 10)
    if kind == "uneven times":
        t = np.sort(rng.uniform(0, 4, 200))
        u = np.where(t >= 0.4, 1.0, 0.0)
    model = FOPDT(K=-1.5, T=0.5, L=0.133, y0=3.0)
    y = model.response(t, u)
    size = 0.01 if kind == "step, little noise" else 0.06
    hits = inside(model, [fit_fopdt(t, u, y + noise(seed, size)) for seed in range(100)])
    assert (hits >= 88).all() and hits.sum() < 300, hits


def inside(model, fits):
    """How often K, T and L lie within two standard errors."""
    z = [[(getattr(f, p) - getattr(model, p)) / getattr(f, f"{p}_stderr") for p in "KTL"] for f in fits]
    return (np.abs(z) < 2).sum(axis=0)


def test_coloured_noise_widens_the_standard_errors_and_is_named():
    """Correlation 0.7: unwidened errors hold the truth about 60 % of the time; widened ones 85 % or more."""
    model = FOPDT(K=-1.5, T=0.5, L=0.133, y0=3.0)
    y = model.response(T_S, STEP)
    fits = [fit_fopdt(T_S, STEP, y + noise(seed, 0.03, correlation=0.7)) for seed in range(50)]
    assert all("not white" in " ".join(fit.warnings) for fit in fits)
    assert (inside(model, fits) >= 43).all()
    narrow = []
    for fit in fits:
        widened = math.sqrt((1 + fit.correlation) / (1 - fit.correlation))
        errors = {f"{p}_stderr": getattr(fit, f"{p}_stderr") / widened for p in "KTL"}
        narrow.append(dataclasses.replace(fit, **errors))
    assert (inside(model, narrow)[:2] <= 37).all()


def test_a_slow_plant_is_accepted_and_flagged():
    """T longer than what was recorded of it (3.4 s), but the bend is seen."""
    for T, flagged in ((2.0, False), (3.0, False), (4.0, True), (8.0, True)):
        found = fit_fopdt(T_S, STEP, 5 * lag(SINCE - 0.2, T) + noise(1, 0.001))
        assert abs(found.T - T) < 3 * found.T_stderr
        assert any("not settled" in text for text in found.warnings) == flagged


def test_a_dead_time_lost_in_noise_is_flagged():
    """L = 0.04 s = 2 periods, which the noise of 0.15 blurs to a standard error of about 0.05 s."""
    told = 0
    for seed in range(20):
        found = fit_fopdt(T_S, STEP, lag(SINCE - 0.04, 0.5) + noise(seed, 0.15))
        said = any("cannot be told from none" in w or "not identifiable" in w for w in found.warnings)
        assert (found.L < 2 * found.L_stderr) == said
        told += said
    assert told >= 5


@pytest.mark.parametrize("flaw", ["an uneven clock", "a coarse sensor"])
def test_errors_hold_what_does_not_average(flaw):
    """Hardly any noise. Stamps that are off by up to 0.4 of a period, at the step too; y in 40 to 300 steps."""
    worst = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        T, L = rng.uniform(0.1, 0.6), rng.uniform(0.05, 0.4)
        t, y = T_S, lag(SINCE - L, T) + noise(seed, 1e-4)
        if flaw == "an uneven clock":
            t = t + PERIOD * rng.uniform(0.1, 0.4) * rng.uniform(-1, 1, len(t))
        else:
            steps = rng.uniform(40, 300)
            y = np.round(steps * y + rng.uniform()) / steps
        found = fit_fopdt(t, STEP, y)
        off = (found.K - 1) / found.K_stderr, (found.T - T) / found.T_stderr, (found.L - L) / found.L_stderr
        worst.append(np.abs(off).max())
    assert np.max(worst) < 4 and np.mean(np.array(worst) > 3) <= 0.05, worst


# --- refusals, each at several magnitudes


def refused(words, t, u, y, **options):
    with pytest.raises(IdentificationError) as caught:
        fit_fopdt(t, u, y, **options)
    assert words in str(caught.value), caught.value


@pytest.mark.parametrize("size, in_units", IN_UNITS)
@pytest.mark.parametrize("tau", [0.01, 0.1, 0.5, 2.0, 20.0])
def test_an_integrating_joint_is_refused_and_the_remedy_works(tau, size, in_units):
    """Position of a joint with viscous friction under constant torque; its velocity is of first order."""
    position = SINCE - tau * lag(SINCE, tau)
    refused("integrates", T_S, STEP, in_units(position / position.max() + noise(3, size)))
    if 0.02 < tau < 3:
        found = fit_fopdt(T_S, STEP, lag(SINCE, tau) + noise(4, size))
        assert found.T == pytest.approx(tau, rel=0.2 if size else 1e-6)


@pytest.mark.parametrize("size, in_units", IN_UNITS)
@pytest.mark.parametrize("T", [0.2, 0.6, 2.0])
def test_a_growing_response_is_refused(T, size, in_units):
    growth = np.expm1(SINCE / T)
    refused("unstable", T_S, STEP, in_units(growth / growth.max() + noise(3, size)))


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("size, in_units", IN_UNITS[:2])
def test_dead_time_below_the_period_is_said_to_be_not_identifiable(share, size, in_units):
    y = in_units(lag(SINCE - share * PERIOD, 0.2) + noise(2, size / 3))
    found = fit_fopdt(T_S, STEP, y)
    assert "dead time is not identifiable" in " ".join(found.warnings) and found.L_stderr >= 0.99 * PERIOD
    assert found.T == pytest.approx(0.2, rel=0.1)


@pytest.mark.parametrize("share", [0.001, 0.1, 0.5, 0.8])
@pytest.mark.parametrize("size, in_units", IN_UNITS[:2])
def test_time_constant_below_the_period_is_said_to_be_not_identifiable(share, size, in_units):
    y = in_units(lag(SINCE - 0.1, share * PERIOD) + noise(2, size))
    found = fit_fopdt(T_S, STEP, y)
    assert "time constant is not identifiable" in " ".join(found.warnings) and math.isinf(found.T_stderr)
    assert abs(found.K / (y[-1] - y[0]) - 1) < 0.02 + 4 * size


@pytest.mark.parametrize("seed", range(4))
def test_milliseconds_and_outliers_are_named(seed):
    rng = np.random.default_rng(seed)
    y = 2 * lag(SINCE - 0.1, rng.uniform(0.1, 0.5)) + noise(seed, 0.01)
    plain = fit_fopdt(T_S, STEP, y)
    assert plain.warnings == ()
    for times in (np.rint(1000 * T_S), 1000 * T_S + rng.uniform(0, 0.1, len(T_S))):  # of a clock in whole ms, or in us
        ms = fit_fopdt(times, STEP, y)
        assert "milliseconds" in ms.warnings[0] and ms.T == pytest.approx(1000 * plain.T, rel=3e-3)
    spoilt = y.copy()
    spoilt[rng.choice(np.arange(60, 190, 5), 3, replace=False)] += rng.choice([-3, 5], 3)
    found = fit_fopdt(T_S, STEP, spoilt)
    assert "3 outlier(s)" in found.warnings[0]
    assert abs(found.T - plain.T) < 2 * plain.T_stderr and abs(found.K - plain.K) < 2 * plain.K_stderr


@pytest.mark.parametrize("seed", range(40))
def test_a_second_order_fit_is_no_worse_than_the_truth(seed):
    """A zero, also one that starts the wrong way, and a dead time: each can do for the other nearby, not as well.

    Second route: scipy.signal's simulation of the transfer function.
    """
    rng = np.random.default_rng(seed)
    n, dt = int(rng.integers(150, 600)), 10 ** rng.uniform(-3, 0)
    t = dt * np.arange(n)
    w, damping = 2 * math.pi * rng.uniform(1, 8) / t[-1], 10 ** rng.uniform(-1.2, 0.4)
    zero = rng.choice([0.0, rng.uniform(0.2, 2), -rng.uniform(0.2, 1)]) / w
    begin, late = n // 10, n // 10 + int(rng.uniform(0, 0.05) * n)
    response = lsim(([w**2 * zero, w**2] if zero else [w**2], [1, 2 * damping * w, w**2]), np.ones(n), t)[1]
    true = np.r_[np.zeros(late), response[: n - late]]
    y = true + 10 ** rng.uniform(-4, -1.5) * np.ptp(true) * rng.normal(size=n)
    u = (np.arange(n) >= begin).astype(float)
    found = fit_second_order(t, u, y)
    assert np.std(y - found.response(t, u)) < 1.05 * np.std(y - true)


@pytest.mark.parametrize("seed, zero", [(0, 0.0), (1, 0.3), (2, -0.1)])
def test_a_second_order_model_is_offered_and_right(zero, seed):
    """Second route: scipy.signal's simulation of the transfer function."""
    rng = np.random.default_rng(seed)
    K, w, damping = rng.uniform(-3, 3), rng.uniform(4, 12), rng.uniform(0.1, 0.35)
    response = lsim(
        (K * w**2 * np.array([zero, 1.0] if zero else [1.0]), [1, 2 * damping * w, w**2]), np.ones(len(T_S)), T_S
    )[1]
    y = 1 + np.r_[np.zeros(20), response[:-20]] + noise(seed, 0.003 * abs(K))
    with pytest.raises(IdentificationError, match=r"fit_second_order\(t, u, y\)"):
        fit_fopdt(T_S, STEP, y)
    found = fit_second_order(T_S, STEP, y)
    for name, true in (("K", K), ("w", w), ("damping", damping), ("zero", zero)):
        assert abs(getattr(found, name) - true) <= 4 * getattr(found, f"{name}_stderr") + 0.003 * abs(true), name
    assert found.L < PERIOD and found.fit > 96
    np.testing.assert_allclose(found.response(T_S, STEP), y, atol=0.02 * np.ptp(y))
    assert fit_fopdt(T_S, STEP, y, anyway=True).warnings[0].startswith("gone on anyway")


def test_a_zero_too_small_to_be_kept_is_in_the_errors():
    """It looks like dead time: in half of these zero or L was off by more, up to 24 standard errors."""
    wrong = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        t, w, damping = np.arange(600) / 600, rng.uniform(20, 50), rng.uniform(0.2, 0.8)
        zero, late = rng.uniform(-0.4, 0.4) / w, 60 + 3 * (seed % 2)
        response = lsim(([w**2 * zero, w**2], [1, 2 * damping * w, w**2]), np.ones(600), t)[1]
        y = np.r_[np.zeros(late), response[: 600 - late]] + 0.02 * rng.normal(size=600)
        found = fit_second_order(t, (t >= 0.1).astype(float), y)
        truth = {"K": 1.0, "w": w, "damping": damping, "zero": zero, "L": late / 600 - 0.1}
        z = [abs(getattr(found, name) - x) / (getattr(found, f"{name}_stderr") + 1e-9) for name, x in truth.items()]
        wrong.append(max(z) > 3.5)
    assert sum(wrong) <= 3


@pytest.mark.parametrize("seed", range(5))
def test_what_is_masked_in_y_hides_no_step_of_u(seed):
    t, u, y, noise, model = step_record(seed)
    mask = np.zeros(len(t), dtype=bool)
    mask[np.argmax(u != u[0]) - 2 : np.argmax(u != u[0]) + 3] = True
    found = fit_fopdt(t, u, np.ma.array(y + noise, mask=mask))
    assert within(found, model, 4), found


def test_a_few_samples_do_not_show_whether_the_model_is_right():
    t, u = np.arange(12) * PERIOD, np.full(12, 0.05)
    assert "too few to see" in " ".join(fit_fopdt(t, u, 0.04 * lag(t - 0.03, 0.06), u_before=0).warnings)


@pytest.mark.parametrize("damping", [0.05, 0.15, 0.3])
@pytest.mark.parametrize("size, in_units", IN_UNITS)
def test_a_swinging_response_is_refused(damping, size, in_units):
    w = 6.0
    wd = w * math.sqrt(1 - damping**2)
    swing = np.cos(wd * SINCE) + damping * w / wd * np.sin(wd * SINCE)
    y = in_units(1 - np.exp(-damping * w * SINCE) * swing + noise(2, size))
    refused("second-order model", T_S, STEP, y)


@pytest.mark.parametrize("level", [0.0, 1e-6, 1.0, -1e6])
def test_constant_columns_are_refused(level):
    y = lag(SINCE - 0.1, 0.3)
    refused("u never changes", T_S, np.full_like(T_S, level), y)
    refused("y stays at", T_S, STEP, np.full_like(T_S, level))


def test_noise_and_drift_are_not_taken_for_a_response():
    for seed, size in zip(range(20), itertools.cycle([1e-6, 1.0, 1e6])):
        with pytest.raises(IdentificationError, match=r"not follow u|integrates|not the shape"):
            fit_fopdt(T_S, STEP, noise(seed, size))
    for seed in range(5):
        with pytest.raises(IdentificationError):
            fit_fopdt(T_S, STEP, noise(seed, 1.0, correlation=0.8))


@pytest.mark.parametrize("after", [1, 4, 7])
def test_too_short_a_record_is_refused(after):
    n = 20 + after
    refused(f"only {after} samples", T_S[:n], STEP[:n], np.sin(np.arange(n)))


@pytest.mark.parametrize("n", [2, 20, 200])
def test_bad_columns_get_a_sentence(n):
    t, u, y = np.arange(n) * 0.01, np.r_[0.0, np.ones(n - 1)], np.arange(float(n))
    for place in {0, n // 2, n - 1}:
        for column in range(3):
            columns = [t.copy(), u.copy(), y.copy()]
            columns[column][place] = math.nan
            with pytest.raises(InputError, match=f"nan at index {place}"):
                fit_fopdt(*columns)
    back, twice = t.copy(), t.copy()
    back[n // 2], twice[n // 2] = t[n // 2 - 1] - 1, t[n // 2 - 1]
    for wrong in (back, twice):
        with pytest.raises(InputError, match="time runs backwards or stands still"):
            fit_fopdt(wrong, u, y)
    with pytest.raises(InputError, match="y has shape"):
        fit_fopdt(t, u, y[:-1])
    with pytest.raises(InputError, match="shape"):
        fit_fopdt(t[:, None], u, y)
    with pytest.raises(InputError, match="at least two times"):
        fit_fopdt(t[:1], u[:1], y[:1])
    with pytest.raises(InputError, match="numbers"):
        fit_fopdt(t, u, ["a"] * n)
    for options in ({"u_before": math.nan}, {"u_before": math.inf}, {"u_before": "0"}):
        with pytest.raises(InputError):
            fit_fopdt(t, u, y, **options)


@pytest.mark.parametrize("bad", [dict(K=0), dict(T=0), dict(T=-1), dict(L=-0.1), dict(K=math.nan), dict(T=math.inf)])
def test_a_model_by_hand_is_checked(bad):
    with pytest.raises(InputError):
        FOPDT(**{"K": 1.0, "T": 1.0, "L": 0.1} | bad)


# --- and nothing else is refused


@pytest.mark.parametrize("size", NOISES)
@pytest.mark.parametrize("order", [2, 3, 4])
def test_plants_of_higher_order_without_swing_are_fitted(order, size):
    """Equal lags: the model is not exact, says so where the noise lets it show, and comes close."""
    x = SINCE / 0.2
    y = 1 - np.exp(-x) * sum(x**k / math.factorial(k) for k in range(order))
    found = fit_fopdt(T_S, STEP, y + noise(1, size))
    assert found.K == pytest.approx(1, abs=0.05)
    assert found.T + found.L == pytest.approx(0.2 * order, rel=0.15)  # the area above the response
    if size < 0.01:
        assert any("not white" in text for text in found.warnings)


def test_good_records_are_never_refused():
    """80 plants with 2 % noise: T and L above two periods, at least 1.5 T of response."""
    refusals = []
    for seed in range(80):
        rng = np.random.default_rng(seed)
        T, L = rng.uniform(2, 60) * PERIOD, rng.uniform(3, 60) * PERIOD
        model = FOPDT(K=rng.choice([-1, 1]) * 10 ** rng.uniform(-4, 4), T=T, L=L)
        y = model.response(T_S, STEP)
        try:
            found = fit_fopdt(T_S, STEP, y + noise(seed, 0.02 * np.ptp(y)))
        except LabError as error:
            refusals.append((T, L, str(error)))
        else:
            assert abs(found.K - model.K) < 5 * found.K_stderr
    assert refusals == []


@pytest.mark.parametrize("seed", range(3))
def test_dates_are_times_and_an_outlier_of_u_is_named(seed):
    rng = np.random.default_rng(seed)
    model = FOPDT(K=rng.uniform(1, 3), T=rng.uniform(0.2, 0.5), L=0.05)
    t, u = 0.01 * np.arange(400), np.repeat([0.0, 1.0], [40, 360])
    y = model.response(t, u) + 0.01 * rng.normal(size=400)
    dates = np.datetime64("2024-01-01") + np.round(1e6 * t).astype("timedelta64[us]")
    assert fit_fopdt(dates, u, y).T == pytest.approx(fit_fopdt(t, u, y).T, rel=1e-6)
    u[rng.integers(150, 300)] = 20.0
    assert "u has 1 outlier" in " ".join(fit_fopdt(t, u, y, anyway=True).warnings)


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_response_between_two_samples_has_no_known_time_constant(noise):
    t = 0.4 * np.arange(25)
    y = np.where(t > 2.0, 1.0, 0.0) + noise * np.random.default_rng(1).normal(size=len(t))
    found = fit_fopdt(t, (t >= 2.0).astype(float), y)
    assert found.K == pytest.approx(1, abs=0.01) and np.isinf(found.T_stderr)
    assert any("not identifiable" in text for text in found.warnings)


def step_record(seed):
    """400 s at 2 Hz, a step at 30 s, 2 % noise: t, u, the exact response, the noise and the model."""
    rng = np.random.default_rng(seed)
    t = 0.5 * np.arange(800)
    u = np.where(t >= 30, 1.0, 0.0)
    model = FOPDT(K=rng.uniform(0.5, 3), T=rng.uniform(20, 50), L=rng.uniform(3, 15), y0=20)
    return t, u, model.response(t, u), 0.02 * model.K * rng.normal(size=len(t)), model


def within(found, model, errors=3):
    return all(
        abs(getattr(found, name) - getattr(model, name)) <= errors * getattr(found, f"{name}_stderr") for name in "KTL"
    )


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("share", [0.1, 0.2, 0.4])
def test_a_drift_and_a_rest_that_was_none_are_in_the_errors_and_named(share, seed):
    t, u, y, noise, model = step_record(seed)
    away = {"drifts": t / 400, "not at rest": np.exp(-t / model.T)}
    for word, shape in away.items():
        found = fit_fopdt(t, u, y + noise + share * model.K * shape)
        assert word in " ".join(found.warnings), (word, found)
        assert within(found, model, 4), (word, found)
    plain = fit_fopdt(t, u, y + noise)
    assert within(plain, model, 4) and plain.K_stderr < 0.03 * model.K


def test_a_drift_that_is_not_significant_is_in_the_errors_in_part():
    """One step, 100 records, a drift of 0.2 to 3 times the noise that nothing is said of: K is off in a tenth.

    Without the part it was off in four tenths. Noise alone makes the errors hardly wider.
    """
    off, clean = [], []
    for seed in range(100):
        rng = np.random.default_rng(seed)
        t, u, y, noise, model = step_record(seed)
        drift = 0.02 * np.exp(rng.uniform(np.log(0.2), np.log(3))) * model.K * rng.choice([-1, 1]) * t / t[-1]
        for kind, flaw in ((off, drift), (clean, 0)):
            found = fit_fopdt(t, u, y + noise + flaw)
            if not found.warnings:
                kind.append(abs(found.K - model.K) / found.K_stderr)
    assert len(off) > 40 and np.mean(np.array(off) > 3) < 0.28, off
    assert len(clean) > 80 and 0.68 < np.sqrt(np.mean(np.square(clean))) < 1.2, clean


@pytest.mark.parametrize(
    "steps, noise, named", [(10, 0.0, True), (10, 0.02, True), (30, 0.003, True), (300, 0.02, False)]
)
def test_a_coarse_sensor_is_named_where_noise_does_not_mix_its_steps(steps, noise, named):
    for seed in range(6):
        t, u, y, white, model = step_record(seed)
        quantum = model.K / steps
        found = fit_fopdt(t, u, np.round((y + 50 * noise * white) / quantum) * quantum)
        assert ("steps only" in " ".join(found.warnings)) == named, found
        assert named or within(found, model, 4)


def test_a_coarse_sensor_is_in_the_errors_of_a_second_order_model_too():
    """Without it a value of 14 of these 20 was off by more than three errors, by up to 45."""
    off = []
    for seed in range(20):
        rng, t = np.random.default_rng([seed, 9]), np.arange(1000) * 0.01
        model = SecondOrderModel(K=2, w=rng.uniform(2, 8), damping=rng.uniform(0.3, 1), L=rng.uniform(0.1, 0.5))
        u = np.where(t >= 1, 1.0, 0.0)
        y, quantum = model.response(t, u) + 0.004 * rng.normal(size=1000), 2 / rng.uniform(20, 80)
        found = fit_second_order(t, u, np.round(y / quantum) * quantum)
        assert quantum < np.ptp(y) / 60 or "steps only" in " ".join(found.warnings), found
        names = ("K", "w", "damping", "L")
        errors = [abs(getattr(found, name) - getattr(model, name)) / getattr(found, f"{name}_stderr") for name in names]
        off.append(max(errors) > 3)
    assert sum(off) <= 5, off


@pytest.mark.parametrize("seed", range(6))
def test_disturbances_that_no_second_order_model_explains_are_a_doubt_no_refusal(seed):
    rng = np.random.default_rng(seed)
    t = np.arange(4000.0)
    u = 0.3 * lfilter([0.03], [1, -0.97], rng.normal(size=len(t)))
    model = FOPDT(K=-20, T=9, L=4, y0=97)
    y = model.response(t, u)
    disturbance = lfilter([1], [1, -0.9], rng.normal(size=len(t)))
    found = fit_fopdt(t, u, y + 0.35 * np.std(y) / np.std(disturbance) * disturbance)
    assert within(found, model, 4) and "not the shape" in " ".join(found.warnings)
