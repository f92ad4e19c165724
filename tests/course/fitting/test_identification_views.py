"""Views of notebooks 12 and 13: their numbers against other routes; what is drawn is what was computed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course import fitting
from ir50p_lab.course.fitting import views
from ir50p_lab.identification import fit, load_excitations, process, regressor
from ir50p_lab.modelling import IR50P, gravity, mass_matrix
from ir50p_lab.signals import quintic

PID_TABLES = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}
POSE = np.array([0, 0.7, -0.8])


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
    views.kept_motion.cache_clear()
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
    views.kept_motion.cache_clear()


# ---- results


def test_rows_of_a_recording_are_those_of_the_package():
    excitation, unit = views.kept_motion(IR50P), ArmInstance(spread=0)
    bench = SimulatedBench(IR50P, seed=0, unit=unit, q0=excitation.q_start, record_to=False).open()
    record = bench.follow(PID(**PID_TABLES, position_filter_hz=3, filter_hz=np.inf), excitation, 40)
    Y, u, use = fitting.columns(record)
    theta, errors = fitting.fit_rows(Y, u, use)
    motion = process(record, delay=0.02, slow=0.05)
    theirs = fit(regressor(motion.q, motion.qd, motion.qdd), motion.u, use=motion.use)
    waist = fitting.ACTS[0]
    np.testing.assert_allclose(theta[0, waist], theirs.theta[0, waist], atol=1e-6)
    assert np.isnan(errors[0, 2]) and (errors[0, waist] > 0).all()
    masses = [fitting.mass_of(IR50P.theta_pwm, q) for q in (POSE, -POSE)]
    gains = np.array(IR50P.actuators.gain)[:, None]
    np.testing.assert_allclose(gains * masses, mass_matrix(IR50P, np.array([POSE, -POSE])), atol=1e-9)


def test_a_motion_keeps_the_limits_or_is_none():
    x = np.zeros((3, 11))
    x[:, 0] = POSE
    x[:, 1] = 0.05
    assert fitting.waves(IR50P, x).duration == 110
    x[0, 0] = 3.0
    assert fitting.waves(IR50P, x) is None


def test_the_gripper_shows_in_what_is_fitted():
    """Half a minute of its motion with it and without it: its weight at the elbow's column."""
    found = []
    for run in (fitting.gripper_run(IR50P), fitting.bare_run(IR50P, PID(1000, 1000, 40, limit_pwm=255)).between(5, 60)):
        found.append(fitting.fit_rows(*fitting.columns(run))[0][2, 3])
    assert found[0] - found[1] == pytest.approx(0.3 * IR50P.l[2] / IR50P.actuators.gain[2], rel=0.1)
