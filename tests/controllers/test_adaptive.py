"""Adaptive control: the Lyapunov function goes down, what is learnt stays in bounds, one law for every loop."""

import numpy as np
import pytest
from arms import random_arm

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import AdaptiveControl
from ir50p_lab.controllers.adaptive_law import SLIDE, Y, passive_regressor
from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.identification import regressor
from ir50p_lab.modelling import IR50P, THESIS_RODS, coriolis_matrix, gravity, mass_matrix
from ir50p_lab.signals import sinusoid
from ir50p_lab.simulation import simulate

ZERO = np.zeros(3)
SWING = sinusoid((0.8, 0.4, 0.3), (0.5, 0.8, 1.0), offset=(0.0, 0.8, -0.8))
RICH = sinusoid((0.8, 0.6, 0.6), (1, 1.5, 2), phase=np.pi / 2)


def passive(q, qd, qdr, qddr):
    out = np.zeros((3, 20))
    passive_regressor(9.81, q[1], q[2], tuple(qd), tuple(qdr), tuple(qddr), tuple(np.sign(qdr)), out)
    return out


@pytest.mark.parametrize("seed", range(5))
def test_the_regressor_holds_the_christoffel_matrix(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    q, qd, qdr, qddr = rng.normal(0, 1, (4, 3))
    torque = np.einsum("ij,ij->i", passive(q, qd, qdr, qddr), arm.theta)
    expected = mass_matrix(arm, q) @ qddr + coriolis_matrix(arm, q, qd) @ qdr + gravity(arm, q) + arm.friction.fv * qdr
    np.testing.assert_allclose(torque, expected, rtol=1e-10, atol=1e-10)
    # at qd_r = qd it is the regressor of identification
    np.testing.assert_allclose(passive(q, qd, qd, qddr), np.squeeze(regressor(q, qd, qddr)), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_the_lyapunov_function_goes_down(seed):
    """V = s'Ms/2 + sum (theta_i - true_i)' Gamma_i^-1 (theta_i - true_i)/2, with dV/dt = -s' K s."""
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    true, T = arm.theta, 1e-4
    first = true * rng.uniform(0.5, 1.5, true.shape)
    Gamma = 2.0 * (np.abs(true) + 0.05) ** 2
    K, Lambda = np.full(3, 20.0), np.full(3, 5.0)
    law = AdaptiveControl(first, Lambda, K, Gamma, lower=-np.inf, period=T, filter_hz=np.inf)

    class Watched:
        unit, seen = "N m", []

        def step(self, t, q, reference):
            u = law.step(t, q, reference)
            self.seen.append((law.state[SLIDE : SLIDE + 3].copy(), law.theta, q.copy()))
            return u

    watched = Watched()
    simulate(arm, watched, RICH, q0=RICH(0.0)[0] + 0.1, duration=0.6, period=T, step=T)
    s, theta, q = (np.array(x) for x in zip(*watched.seen[1:], strict=True))
    kinetic = 0.5 * np.einsum("ni,nij,nj->n", s, mass_matrix(arm, q), s)
    belief = 0.5 * ((theta - true) ** 2 / Gamma).sum(axis=(1, 2))
    V = (kinetic + belief)[50:]
    assert V[-1] < V[0]
    change = np.diff(V[::20])
    assert change.max() < 0.002 * V[0] * 0.05  # what sampling leaves
    lost = (s[50:-1] ** 2 @ K).sum() * T
    assert (V[0] - V[-1] - lost) == pytest.approx(0, abs=0.12 * lost + 1e-3 * V[0])


def payload(arm, kg):
    """The arm with a point mass at its tip, as a theta (3, 20)."""
    l2, l3 = arm.l[1:]
    theta = arm.theta.copy()
    theta[:, (1, 2, 3, 4, 5)] += kg * np.array([l2**2, l2, l3, l3**2, l3 * l2])
    return theta


def test_it_learns_a_payload_while_it_tracks():
    loaded = payload(THESIS_RODS, 0.5)
    Gamma = np.zeros((3, 20))
    Gamma[:, 1:6] = 0.5

    def errors(Gamma):
        law = AdaptiveControl(THESIS_RODS, 5, 40, Gamma, period=0.002, filter_hz=50)
        run = simulate(loaded, law, RICH, q0=RICH(0.0)[0], duration=60, period=0.002, step=0.002)
        n = len(run.t) // 6
        return [np.sqrt(np.mean(run.error[part] ** 2, axis=0)) for part in (slice(n), slice(-n, None))], law.theta

    (before, after), theta = errors(Gamma)
    (_, never), _ = errors(0.0)
    assert (after[1:] < 0.25 * before[1:]).all() and (after[1:] < 0.1 * never[1:]).all()
    # and here the motion is rich enough: the mass on the hand comes out
    found = (theta[2, 3] - THESIS_RODS.theta[2, 3]) / THESIS_RODS.l[2]
    assert found == pytest.approx(0.5, rel=0.05)


def test_bounds_hold_and_frozen_parameters_stay():
    Gamma = np.zeros((3, 20))
    Gamma[:, 2:4] = 100.0
    first = THESIS_RODS.theta
    law = AdaptiveControl(first, 5, 20, Gamma, lower=0.9 * first, upper=1.1 * first + 1e-9, period=0.005)
    simulate(payload(THESIS_RODS, 2.0), law, RICH, q0=RICH(0.0)[0], duration=5, period=0.005)
    theta = law.theta
    assert (theta <= 1.1 * first + 2e-9).all() and (theta >= 0.9 * first).all()
    assert (theta[:, 2:4] == 1.1 * first[:, 2:4] + 1e-9).any()
    np.testing.assert_array_equal(theta[:, [0, 1, *range(4, 20)]], first[:, [0, 1, *range(4, 20)]])


def test_small_errors_and_a_limited_drive_teach_nothing():
    def learnt(measured, **options):
        law = AdaptiveControl(IR50P, 5, 10, 1.0, limit_pwm=255, **options)
        for k in range(5):
            law.step(0.01 * k, np.array(measured), np.zeros((3, 3)))
        return np.abs(law.theta - IR50P.theta_pwm).max()

    assert learnt([0.01] * 3) > 0
    assert learnt([0.01] * 3, dead_band=0.06) == 0 < learnt([0.02] * 3, dead_band=0.06)
    assert learnt([30.0, 0, 0]) == 0  # the command would be 1500 counts


def test_the_dead_band_keeps_noise_from_walking_the_parameters_away():
    def drift(dead_band):
        law = AdaptiveControl(IR50P, 2, 10, 20.0, limit_pwm=255, dead_band=dead_band)
        rng = np.random.default_rng(0)
        for k in range(3000):
            law.step(0.01 * k, rng.normal(0, 0.006, 3), np.zeros((3, 3)))
        return np.abs(law.theta - IR50P.theta_pwm).max()

    assert drift(2.0) == 0 < 0.5 < drift(0.0)


def test_python_step_and_compiled_loops_agree_to_the_bit():
    Gamma = 0.5 * (np.abs(IR50P.theta_pwm) + 1)

    def made():
        return AdaptiveControl(0.9 * IR50P.theta_pwm, (5, 3, 7), (80, 80, 80), Gamma, limit_pwm=255, lower=-np.inf)

    class InPython:
        unit = "PWM"

        def __init__(self):
            self.inside = made()

        def step(self, t, measured, reference):
            return self.inside.step(t, measured, reference)

    laws = made(), InPython()
    runs = [simulate(IR50P, c, SWING, q0=SWING(0.0)[0], duration=2) for c in laws]
    np.testing.assert_array_equal(runs[0].u, runs[1].u)
    np.testing.assert_array_equal(laws[0].theta, laws[1].inside.theta)
    benches = []
    for c in (made(), InPython()):
        with SimulatedBench(IR50P, seed=4, q0=SWING(0.0)[0], record_to=False) as bench:
            benches.append(bench.follow(c, SWING, 2).u)
    np.testing.assert_array_equal(*benches)


def test_reset_goes_back_to_the_first_belief():
    law = AdaptiveControl(IR50P, 5, 10, 1.0, limit_pwm=255)
    np.testing.assert_array_equal(law.theta, IR50P.theta_pwm)
    first = [law.step(0.01 * k, np.full(3, 0.02), np.zeros((3, 3))) for k in range(9)]
    learnt = law.theta
    assert (learnt != IR50P.theta_pwm).any()
    law.reset()
    np.testing.assert_array_equal(law.theta, IR50P.theta_pwm)
    np.testing.assert_array_equal(first, [law.step(0.01 * k, np.full(3, 0.02), np.zeros((3, 3))) for k in range(9)])
    np.testing.assert_array_equal(law.theta, learnt)
    assert law.state.size == Y + 60


def test_header():
    head = AdaptiveControl(IR50P, 5, 10, 1.0, limit_pwm=255, dead_band=0.1).header()
    assert head["controller"] == "AdaptiveControl" and head["Lambda"] == "5 5 5" and head["dead_band"] == "0.1 0.1 0.1"
    rows = [[float(x) for x in head[f"first_theta_{i}"].split()] for i in (1, 2, 3)]
    np.testing.assert_allclose(rows, IR50P.theta_pwm, rtol=1e-5)


@pytest.mark.parametrize(
    "make, error, words",
    [
        (lambda: AdaptiveControl(IR50P, -1, 10, 1), InputError, ["Lambda", "-1"]),
        (lambda: AdaptiveControl(IR50P, 1, np.nan, 1), InputError, ["K", "nan"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, -1), InputError, ["Gamma", "negative"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, np.inf), InputError, ["Gamma"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, np.ones((2, 20))), InputError, ["Gamma", "(3, 20)"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, "fast"), InputError, ["Gamma"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, lower=np.nan), InputError, ["lower", "NaN"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, upper=0.01), InputError, ["joint 1", "bounds"]),
        (lambda: AdaptiveControl(-IR50P.theta, 1, 10, 1), InputError, ["outside its bounds"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, dead_band=-1), InputError, ["dead_band of joint 1 = -1", ">= 0"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, smooth=(1, 2)), InputError, ["smooth"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, filter_hz=0), InputError, ["filter_hz = 0"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, period=-1), InputError, ["period = -1"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, limit=-5), InputError, ["limit of joint 1 = -5"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1, limit_pwm=0), InputError, ["limit of joint 1 = 0"]),
        (lambda: AdaptiveControl(THESIS_RODS, 1, 10, 1, limit_pwm=255), ArmError, ["no actuators"]),
        (lambda: AdaptiveControl("arm", 1, 10, 1), InputError, ["expected an Arm"]),
        (lambda: AdaptiveControl(IR50P, 1, 10, 1).step(0, [0, np.nan, 0], np.zeros((3, 3))), InputError, ["nan"]),
    ],
)
def test_bad_input_gets_a_sentence(make, error, words):
    with pytest.raises(error) as caught:
        make()
    for word in words:
        assert word in str(caught.value)
