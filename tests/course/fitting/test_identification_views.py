"""Pictures of notebook 12: their numbers against other routes; what is drawn is what was computed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.draw.painter import Painter
from ir50p_lab.course.fitting import results, views
from ir50p_lab.errors import InputError
from ir50p_lab.identification import RLS, fit_joint, load_excitations, process, regressor, validate
from ir50p_lab.modelling import IR50P, gravity, mass_matrix
from ir50p_lab.signals import quintic

pytestmark = pytest.mark.numeric
PID_TABLES = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}
POSE = np.array([0, 0.7, -0.8])


@pytest.fixture(scope="module")
def excitation():
    return views.kept_motion(IR50P)


def recorded(excitation, seconds, arm=IR50P, seed=0):
    bench = SimulatedBench(arm, seed=seed, unit=ArmInstance(spread=0), q0=excitation.q_start, record_to=False).open()
    return bench.follow(PID(**PID_TABLES, position_filter_hz=3, filter_hz=np.inf), excitation, seconds)


@pytest.fixture(scope="module")
def records(excitation):
    return recorded(excitation, 40), recorded(excitation, 30, seed=1)


# ---- feedback


@pytest.mark.parametrize("excitation", [0.0, 0.03, 0.1, 0.5])
def test_bias_of_least_squares_in_closed_loop(excitation):
    loop = views.FeedbackLoop(b=0.01, K=300)
    r, u, y = loop.run(excitation)
    np.testing.assert_allclose(u, loop.K * (r - y))  # the controller
    expected = (0.01 * excitation**2 - 0.1**2 / 300) / (excitation**2 + 0.1**2)
    assert (u @ y) / (u @ u) == pytest.approx(expected)
    sampled = np.random.default_rng(1).normal(size=(2, 200_000)) * [[excitation], [0.1]]  # the other route: much data
    u = 300 * (sampled[0] - sampled[1]) / (1 + 0.01 * 300)
    y = 0.01 * u + sampled[1]
    assert (u @ y) / (u @ u) == pytest.approx(expected, abs=2e-4)


def test_feedback_view_says_both_slopes():
    loop = views.FeedbackLoop(b=0.01, K=300)
    view = views.FeedbackView(loop, 0.5)
    before = Painter(view.figure).png()
    assert "0.0100" in view.update(0.5) and "instrument" not in view.update(0)
    assert Painter(view.figure).png() != before
    line = view.figure.axes[0].lines[-1]
    assert np.diff(line.get_ydata())[0] / np.diff(line.get_xdata())[0] == pytest.approx(-1 / 300)


def test_two_copies():
    reference = quintic(POSE, POSE + 0.4, duration=2)
    closed, blind, other = views.two_copies(IR50P, PID(**PID_TABLES), reference, 4)
    np.testing.assert_array_equal(closed.u[:300], blind.u[:300])
    assert np.abs(blind.q[-1] - closed.q[-1]).max() > np.abs(other.q[-1] - closed.q[-1]).max()


# ---- arms


def test_payload_is_a_point_mass_at_the_tip():
    loaded, q = IR50P.with_payload(0.3), np.random.default_rng(0).uniform(-1, 1, (20, 3))
    l2, l3 = IR50P.l[1:]
    lever = l2 * np.cos(q[:, 1]) + l3 * np.cos(q[:, 1] + q[:, 2])
    more = gravity(loaded, q) - gravity(IR50P, q)
    np.testing.assert_allclose(more[:, 1], 0.3 * 9.81 * lever, atol=1e-12)
    M = mass_matrix(loaded, q) - mass_matrix(IR50P, q)
    np.testing.assert_allclose(M[:, 0, 0], 0.3 * lever**2, atol=1e-12)
    np.testing.assert_allclose(M[:, 2, 2], 0.3 * l3**2, atol=1e-12)


# ---- excitation


def test_the_arm_of_the_course_has_kept_motions_another_one_gets_its_own(monkeypatch):
    assert [views.kept_motion(IR50P, k) for k in (0, 1)] == [
        load_excitations()[x] for x in ("training", "validation 1")
    ]
    seen = {}

    def quick(arm, **options):
        seen.update(options)
        return SimpleNamespace(reference="made here")

    monkeypatch.setattr(views, "optimise_excitation", quick)
    assert views.kept_motion(replace(IR50P, name="another"), 1) == "made here"
    assert seen["table"] > 0 and seen["seed"] == 1


def test_relative_errors_are_those_of_a_covariance(excitation):
    percent, u = views.relative_errors(IR50P, excitation, 1 / excitation.period)
    t = excitation.period * (np.arange(300) + 0.5) / 300
    rows = excitation.sample(t)
    Phi = regressor(rows[:, 0], rows[:, 1], rows[:, 2])
    A = Phi[:, 0, [0, 1, 4, 5, 10, 11, 16]]
    stderr = 8 * np.sqrt(np.linalg.pinv(A.T @ A)[0, 0] * 300 / 1100)
    assert percent[0] == pytest.approx(100 * stderr / IR50P.theta_pwm[0, 0], rel=1e-6)
    np.testing.assert_allclose(u, np.einsum("nij,ij->ni", Phi, IR50P.theta_pwm), atol=1e-9)


def test_frequency_view(excitation):
    view = views.FrequencyView(IR50P, excitation)
    assert "within reach" in view.update(0.03) and "out of reach" in view.update(0.3)


# ---- results


def test_learn_leaves_out_what_stands(records):
    all_of_it, some = results.learn(records[0], delay=0.02), results.learn(records[0], delay=0.02, slow=0.05)
    assert abs(some.theta[0, 0] / IR50P.theta_pwm[0, 0] - 1) < 0.15
    assert not np.allclose(all_of_it.theta, some.theta)


def test_online_signals_lead_to_the_same_parameters(records):
    """Sample by sample with a causal filter, or afterwards with one that is not late."""
    train, _ = records
    signals, rls = results.OnlineSignals(), RLS()
    for q, u in zip(train.q, train.u, strict=True):
        rls.step(*signals.step(q, u))
    late = results.learn(train, delay=0.02, slow=0.05).theta
    for place in ((0, 0), (1, 2), (2, 3), (0, 10)):
        assert rls.theta[place] == pytest.approx(late[place], rel=0.15)


def test_cutoff_view(records):
    view = results.CutoffView(*records, [0.7, 1.5, 4.0], delay=0.02, span=(10, 14))
    assert view.fits["zero-phase"].shape == (3, 3)
    said = view.update(1.5)
    assert f"zero-phase: fit {view.fits['zero-phase'][1, 0]:.0f}" in said
    assert [1.5, 1.5] in [list(line.get_xdata()) for line in view.figure.axes[1].lines]
    with pytest.raises(InputError):
        view.update(60.0)


def test_forgetting_follows_a_payload(records, excitation):
    loaded = recorded(excitation, 40, arm=IR50P.with_payload(0.3))
    parts = [process(run, delay=0.02, slow=0.05) for run in (records[0], loaded)]
    levels = [results.learn(run, delay=0.02, slow=0.05).theta[2, 3] for run in (records[0], loaded)]
    assert levels[1] - levels[0] == pytest.approx(0.3 * IR50P.l[2] / IR50P.actuators.gain[2], rel=0.1)
    view = results.ForgettingView(parts, levels)
    short, long = view.run(10)[-1], view.run(1e4)[-1]
    assert abs(short - levels[1]) < 0.5 * abs(long - levels[1])
    assert "0.9950" in view.update(10)


def test_spoilt_data_can_be_repaired(records):
    t, q, u = records[0].t[:3000], np.degrees(records[0].q[:3000, 0]), records[0].u[:3000, 0]
    q[1000:1080] = np.nan
    t, q, u = (np.roll(column, 1500) for column in (t, q, u))
    for _ in range(2):
        with pytest.raises(InputError):
            fit_joint(t, q, u)
        keep = np.isfinite(q)
        t, q, u = t[keep], q[keep], u[keep]
    order = np.argsort(t)
    assert any("degrees" in text for text in fit_joint(t[order], q[order], u[order]).warnings)
    found = fit_joint(t[order], np.radians(q[order]), u[order])
    whole = fit_joint(records[0].t[:3000], records[0].q[:3000, 0], records[0].u[:3000, 0])
    assert found.inertia == pytest.approx(whole.inertia, rel=0.1)


def test_a_curved_driver_is_seen(records):
    steps = {"delay": 0.02, "slow": 0.05}
    bends = []
    for exponent in (1.0, 1.3):
        train, valid = (results.curved(run, exponent) for run in records)
        bends.append(results.bend(validate(results.learn(train, **steps), valid, delay=0.02)))
    assert (np.abs(bends[0]) < 40).all() and (bends[1] > bends[0] + 25).all()
    u = np.linspace(-200, 200, 401)[:, None] * [1, 1, 1]
    exact = SimpleNamespace(predicted=u, residuals=0.1 * u + 30 * (u / 255) * np.abs(u / 255))
    np.testing.assert_allclose(results.bend(exact), 30)


def test_figures_show_what_they_are_given(records):
    figure = results.ablation_figure(["a", "b"], np.array([[60, 70, 80], [90, 91, 92.0]]), np.array([95, 96, 97.0]))
    assert [t.get_text() for t in figure.axes[0].get_yticklabels()] == ["a", "b"]
    best = validate(results.learn(records[0], delay=0.02, slow=0.05), records[1], delay=0.02)
    figure = results.validation_figure(best, replace(best), (10, 20))
    assert f"{best.fit[2]:.0f} %" in figure.axes[2].get_title()
