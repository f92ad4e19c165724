"""`fit` finds what made the data, says how sure it is, and says what it cannot know."""

import dataclasses

import numpy as np
import pytest
from arms import random_arm
from rounding_noise import NOISE
from scipy.signal import butter, lfilter, sosfiltfilt

from ir50p_lab.errors import InputError
from ir50p_lab.identification import Estimate, fit, regressor
from ir50p_lab.identification import least_squares as least_squares_of_any
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, NAMES
from ir50p_lab.identification.regression import independent_samples, long_run_sum
from ir50p_lab.modelling import IR50P, THESIS_C, mass_matrix

METHODS = ("ls", "bounded")
RIGID = [sorted(set(acts) & set(COLUMNS["rigid"])) for acts in ACTS_ON]


def motion(seed, n=2000, period=0.05):
    """A smooth rich motion: eleven sines per joint, q, qd, qdd (n, 3)."""
    rng = np.random.default_rng(seed)
    t = np.arange(n)[:, None] * period
    q, qd, qdd = np.zeros((3, n, 3))
    for w in rng.uniform(0.3, 5.0, 11):
        a, phase = rng.normal(0, 0.5, 3), rng.uniform(0, 6, 3)
        q += a * np.sin(w * t + phase)
        qd += a * w * np.cos(w * t + phase)
        qdd -= a * w**2 * np.sin(w * t + phase)
    return q, qd, qdd


def torque(Phi, theta):
    return np.einsum("nij,ij->ni", Phi, theta)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seed", range(2))
def test_without_noise_every_method_finds_theta(method, seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng, coulomb=True)
    Phi = regressor(*motion(seed), g=arm.g)
    for rows, theta in (("shared", arm.theta), ("joint", arm.theta_pwm)):
        y = torque(Phi, theta)
        found = fit(Phi, y, method=method, rows=rows)
        for joint in range(3):
            here = list(range(20)) if rows == "shared" else RIGID[joint]
            scale = np.abs(theta[joint]).max()
            np.testing.assert_allclose(found.theta[joint, here], theta[joint, here], rtol=1e-5, atol=1e-7 * scale)
        np.testing.assert_allclose(found.predict(Phi), y, atol=1e-5 * np.abs(y).max())


@pytest.mark.parametrize("seed", range(2))
def test_equals_the_normal_equations_and_lstsq(seed):
    Phi = regressor(*motion(seed))
    y = torque(Phi, IR50P.theta_pwm) + np.random.default_rng(seed).normal(0, 5, (len(Phi), 3))
    found = fit(Phi, y)
    for joint, here in enumerate(RIGID):
        A = Phi[:, joint, here]
        expected = np.linalg.lstsq(A, y[:, joint], rcond=None)[0]
        np.testing.assert_allclose(found.theta[joint, here], expected, rtol=1e-8, atol=1e3 * NOISE)
        np.testing.assert_allclose(
            found.theta[joint, here], np.linalg.solve(A.T @ A, A.T @ y[:, joint]), rtol=1e-6
        )  # (2.35)
        assert found.condition[joint] == pytest.approx(np.linalg.cond(A / np.linalg.norm(A, axis=0)), rel=1e-8)
        left = y[:, joint] - A @ expected
        assert found.sigma[joint] == pytest.approx(np.sqrt(left @ left / (len(A) - len(here))))
    shared = fit(Phi, y, rows="shared", columns="thesis")
    expected = np.linalg.lstsq(Phi.reshape(-1, 20), y.ravel(), rcond=None)[0]
    for row in shared.theta:
        np.testing.assert_allclose(row, expected, rtol=1e-8)


def deviations(noise, *, seeds, n=1500):
    """(theta found - true) / stderr of all parameters, one row per seed."""
    Phi = regressor(*motion(0, n))
    clean, theta = torque(Phi, IR50P.theta_pwm), IR50P.theta_pwm
    rows = []
    for seed in seeds:
        found = fit(Phi, clean + noise(np.random.default_rng(seed), n))
        used = np.isfinite(found.stderr)
        rows.append(((found.theta - theta) / found.stderr)[used])
    return np.array(rows)


def white(rng, n):
    return rng.normal(0, 5, (n, 3))


def low_passed(rng, n):
    return 20 * sosfiltfilt(butter(4, 1.5, fs=20, output="sos"), rng.normal(size=(n, 3)), axis=0)


def autoregressive(rng, n):
    return lfilter([1.0], [1.0, -0.9], rng.normal(size=(n, 3)), axis=0)


@pytest.mark.parametrize("noise", [white, low_passed, autoregressive])
def test_hac_errors_are_honest_for_any(noise):
    z = deviations(noise, seeds=range(25))
    assert 0.8 < z.std() < 1.2
    assert np.mean(np.abs(z) < 3) >= 0.99
    assert np.mean((np.abs(z) < 3).all(axis=1)) >= 0.8


@pytest.mark.parametrize("rho", [0.0, 0.9, 0.985])
def test_long_run_variance_of_an_autoregression(rho):
    # known: sigma^2 / (1 - rho)^2 a sample
    n = 100_000
    scores = lfilter([1.0], [1.0, -rho], np.random.default_rng(0).normal(size=(n, 8)), axis=0)
    S, independent = long_run_sum(scores, scores), independent_samples(scores)
    assert np.mean(np.diag(S)) * (1 - rho) ** 2 / n == pytest.approx(1.0, abs=0.1)
    assert independent / n == pytest.approx(1 if rho == 0 else 2 * (1 - rho) / np.pi, rel=0.1)


# what the data cannot say ------------------------------------------------------------------------------------------


def test_theta7_and_theta8_cannot_be_told_apart_by_joint_2():
    Phi = regressor(*motion(7))
    found = fit(Phi, torque(Phi, THESIS_C), columns="thesis", unit="N m")
    assert found.unidentifiable == ("joint 2: theta8",)
    assert found.theta[1, 6] == pytest.approx(THESIS_C[1, 6] + THESIS_C[1, 7])
    assert (found.theta[1, 7], found.stderr[1, 7]) == (0.0, np.inf)
    assert "theta8" not in found.columns[1]
    assert any(
        "theta8 cannot be told apart from theta7: theta7 stands for theta7 +1 theta8" in w for w in found.warnings
    )


def test_a_joint_that_stands_still_says_so():
    q, qd, qdd = motion(8)
    for x in (q, qd, qdd):
        x[:, 0] = 0.0
    Phi = regressor(q, qd, qdd)
    found = fit(Phi, torque(Phi, IR50P.theta_pwm))
    for name in ("theta1", "theta2", "theta5", "theta6", "fv1", "fc1"):
        assert f"joint 1: {name}" in found.unidentifiable
        assert found.stderr[0, NAMES.index(name)] == np.inf
    assert found.columns[0] == ("Tf1",)
    assert any("nothing in the data excites it" in text for text in found.warnings)
    # without centrifugal torque the inertias about the joint axes act as one
    assert {"joint 2: theta9", "joint 2: theta10"} < set(found.unidentifiable)
    true = IR50P.theta_pwm[1]
    np.testing.assert_allclose(found.theta[1, [1, 4]], [true[1] + true[8], true[4] + true[9]], rtol=1e-6)
    np.testing.assert_allclose(found.predict(Phi), torque(Phi, IR50P.theta_pwm), atol=1e-6)


def test_l2_ties_theta6_to_theta4():
    Phi = regressor(*motion(11))
    y = torque(Phi, IR50P.theta_pwm) + np.random.default_rng(0).normal(0, 5, (len(Phi), 3))
    for rows in ("joint", "shared"):
        free, tied = fit(Phi, y, rows=rows), fit(Phi, y, rows=rows, l2=IR50P.l[1])
        np.testing.assert_allclose(tied.theta[1:, 5], IR50P.l[1] * tied.theta[1:, 3], rtol=1e-12)
        np.testing.assert_allclose(tied.stderr[1:, 5], IR50P.l[1] * tied.stderr[1:, 3], rtol=1e-9)
        assert (tied.stderr[1:, 5] < free.stderr[1:, 5]).all()
    assert fit(Phi, y, l2=0.2).theta[0, 5] == pytest.approx(fit(Phi, y).theta[0, 5])  # joint 1 carries theta6 alone


def test_biased_data_are_called_impossible():
    Phi = regressor(*motion(12))
    theta = IR50P.theta_pwm.copy()
    theta[0, 10], theta[2, 19], theta[1, 8] = -5.0, -20.0, -20.0
    found = fit(Phi, torque(Phi, theta) + np.random.default_rng(0).normal(0, 1, (len(Phi), 3)))
    assert any("joint 1: fv1 = -5" in text and "hardly possible" in text for text in found.warnings)
    assert any("mass matrix of these parameters is not positive definite" in text for text in found.warnings)
    q = np.column_stack([np.zeros(2000), *np.random.default_rng(0).uniform(-np.pi, np.pi, (2, 2000))])
    M = mass_matrix(found.theta, q)
    assert np.min([np.linalg.det(M[:, :k, :k]).min() for k in (1, 2, 3)]) < 0
    sound = fit(Phi, torque(Phi, IR50P.theta_pwm))
    assert sound.warnings == ()


def test_summary_and_text():
    Phi = regressor(*motion(14))
    y = torque(Phi, IR50P.theta_pwm) + np.random.default_rng(0).normal(0, 5, (len(Phi), 3))
    found = fit(Phi, y)
    assert isinstance(found, Estimate)
    assert found.summary[0].startswith("joint 1: 7 parameters from 2000 samples, residual ")
    text = str(found)
    assert "parameters in PWM" in text
    assert "theta1" in text
    assert str(fit(Phi, y, rows="shared")).count("all joints: 18 parameters") == 1
    np.testing.assert_allclose(found.predict(Phi) + found.residuals, y, atol=1e-10)
    with pytest.raises(InputError, match="Phi has shape"):
        found.predict(Phi[0])
    assert dataclasses.replace(found, unit="N m").unit == "N m"


# refusals ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"method": "LS"}, "method = 'LS'"),
        ({"rows": "both"}, "rows = 'both'"),
        ({"l2": 0.0}, "l2 = 0.0"),
        ({"l2": 200.0}, "in millimetres"),
        ({"columns": "all"}, "columns = 'all'"),
    ],
)
def test_bad_options(how, message):
    Phi = regressor(*motion(17, n=100))
    with pytest.raises(InputError, match=message):
        fit(Phi, torque(Phi, IR50P.theta_pwm), **how)


def test_what_a_column_stands_for_is_told_in_the_units_of_the_columns():
    a, b = np.random.default_rng(0).normal(size=(2, 100))
    found = least_squares_of_any(np.column_stack([a, b, 4 * a, 0 * a]), a + b, names=("a", "b", "c", "d"))
    assert found.dropped == ("c", "d") and found.x == pytest.approx([1, 1, 0, 0])
    assert "c cannot be told apart from a: a stands for a +4 c" in found.warnings
    assert "d cannot be found: nothing in the data excites it" in found.warnings
