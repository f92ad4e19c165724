"""Recursive least squares: equal to the batch, to the corrected equations of the thesis, and stable for ever."""

import numpy as np
import pytest
from arms import random_states

from ir50p_lab.errors import InputError
from ir50p_lab.identification import RLS, fit, regressor
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS
from ir50p_lab.modelling import IR50P


def data(seed, n, noise=1.0, theta=IR50P.theta_pwm):
    rng = np.random.default_rng(seed)
    Phi = regressor(*random_states(rng, n))
    return Phi, np.einsum("nij,ij->ni", Phi, theta) + noise * rng.normal(size=(n, 3))


def relative(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("rows", ["joint", "shared"])
def test_equals_least_squares_sample_by_sample_and_at_once(rows):
    Phi, y = data(0, 1000)
    rls, at_once, one_by_one = RLS(rows=rows), RLS(rows=rows), RLS(rows=rows)
    history = rls.run(Phi, y)
    batch = fit(Phi, y, rows=rows)
    assert relative(history[-1], batch.theta) < 1e-6
    np.testing.assert_array_equal(history[-1], rls.theta)
    assert relative(at_once.run(Phi, y, history=False), history[-1]) < 1e-9
    for block, sample in zip(Phi[:50], y[:50], strict=True):
        theta = one_by_one.step(block, sample)
    np.testing.assert_array_equal(theta, history[49])
    for joint in range(3):  # columns left out are zero; P is the inverse of the information
        here = COLUMNS["rigid"] if rows == "shared" else sorted(set(ACTS_ON[joint]) & set(COLUMNS["rigid"]))
        A = Phi.reshape(-1, 20)[:, here] if rows == "shared" else Phi[:, joint, here]
        P = rls.P if rows == "shared" else rls.P[joint]
        assert np.flatnonzero(P.any(axis=0)).tolist() == np.flatnonzero(history[-1][joint]).tolist() == list(here)
        assert relative(P[np.ix_(here, here)], np.linalg.inv(A.T @ A + np.eye(len(here)) / 1e8)) < 1e-7


def recursion(Phi, y, P0, right=True):
    """(2.46) in plain double precision: corrected, or with P^-1 in the bracket as printed. Returns theta and P."""
    theta, P = np.zeros(20), P0 * np.eye(20)
    for phi_T, sample in zip(Phi, y, strict=True):
        inside = phi_T @ P if right else np.linalg.solve(P, phi_T.T).T
        K = np.linalg.solve(np.eye(3) + inside @ phi_T.T, phi_T @ P).T
        theta, P = theta + K @ (sample - phi_T @ theta), (np.eye(20) - K @ phi_T) @ P
    return theta, P


def test_equals_the_thesis_equations_with_the_inversion_lemma_put_right():
    Phi, y = data(2, 300, theta=IR50P.theta)
    rls = RLS(rows="shared", columns="thesis", P0=10.0)
    rls.run(Phi, y)
    theta, P = recursion(Phi, y, 10.0)
    assert relative(rls.theta[0], theta) < 1e-9 and relative(rls.P, P) < 1e-9
    Phi, y = data(3, 300, noise=0.0, theta=IR50P.theta)
    right, as_printed = (recursion(Phi, y, 1.0, right=right)[0] for right in (True, False))
    assert relative(right, IR50P.theta[0]) < 0.1 * relative(as_printed, IR50P.theta[0])


def test_the_sum_holds_where_the_subtraction_breaks():
    """A smooth motion makes P badly conditioned at first: by (2.45) it loses its symmetry."""
    rng, t = np.random.default_rng(0), np.arange(2000)[:, None] * 0.01
    w, a, phase = rng.uniform(0.3, 5, 9), rng.normal(0, 0.3, (9, 3)), rng.uniform(0, 6, (9, 3))
    q, qd, qdd = (sum(b * w**k * f(w * t + p) for w, b, p in zip(w, a, phase, strict=True))
                  for k, f in enumerate((np.sin, np.cos, lambda x: -np.sin(x))))  # fmt: skip
    Phi = regressor(q, qd, qdd)
    y = np.einsum("nij,j->ni", Phi, IR50P.theta[0])
    _, P = recursion(Phi, y, 1e8)
    assert np.abs(P - P.T).max() > 1e-6 * np.abs(P).max()
    rls = RLS(rows="shared", columns="thesis", P0=1e12)
    rls.run(Phi, y)
    assert np.abs(rls.theta[0] - IR50P.theta[0]).max() < 1e-6
    assert np.abs(rls.P - rls.P.T).max() < 1e-10 * np.abs(rls.P).max() and np.linalg.eigvalsh(rls.P).min() > 0


@pytest.mark.parametrize("forgetting", [1.0, 0.9999])
def test_stable_over_a_million_samples(forgetting):
    Phi, y = data(4, 50_000, noise=0.01, theta=IR50P.theta)
    rls = RLS(rows="shared", columns="thesis", forgetting=forgetting)
    for _ in range(20):
        rls.run(Phi, y, history=False)
    assert np.abs(rls.P - rls.P.T).max() <= 1e-12 * np.abs(rls.P).max()
    assert np.linalg.eigvalsh(rls.P).min() > 0
    weights = np.sqrt(forgetting ** np.arange(len(y))[::-1])  # least squares with the same weights is the judge
    A, b = (Phi * weights[:, None, None]).reshape(-1, 20), (y * weights[:, None]).ravel()
    assert relative(rls.theta[0], np.linalg.lstsq(A, b, rcond=None)[0]) < 1e-5


def test_forgetting_without_excitation_does_not_blow_up():
    Phi, y = data(5, 5000)
    rls = RLS(forgetting=0.99)
    before = rls.run(Phi, y, history=False)
    still = regressor(np.full((50_000, 3), 0.3), np.zeros((50_000, 3)), np.zeros((50_000, 3)))
    held = np.einsum("nij,ij->ni", still, IR50P.theta_pwm) + np.random.default_rng(0).normal(0, 1, (50_000, 3))
    assert np.isfinite(rls.run(still, held, history=False)).all()
    assert 0 < np.linalg.eigvalsh(rls.P[0][np.ix_([0, 16], [0, 16])]).min() and rls.P.max() <= 1.01e8
    assert relative(rls.run(Phi, y, history=False), before) < 1e-5  # and it comes back


def test_forgetting_follows_a_change():
    heavier = IR50P.theta_pwm.copy()
    heavier[:, 3] *= 1.5
    (Phi, y), after = data(6, 4000), data(7, 4000, theta=heavier)
    errors = {}
    for forgetting in (1.0, 0.995):
        rls = RLS(forgetting=forgetting)
        rls.run(Phi, y, history=False)
        errors[forgetting] = np.abs(rls.run(*after, history=False)[1:, 3] / heavier[1:, 3] - 1).max()
    assert errors[0.995] < 0.05 < 0.1 < errors[1.0]


def test_bad_samples_are_refused_and_change_nothing():
    Phi, y = data(10, 20)
    rls = RLS()
    rls.run(Phi, y)
    theta, bad = rls.theta, Phi[0].copy()
    bad[1, 2] = np.nan
    for sample, measured, words in (
        (bad, y[0], "Phi holds nan"),
        (Phi[0], [1, np.inf, 0], "y holds inf"),
        (Phi[0, :2], y[0], r"Phi has shape \(1, 2, 20\)"),
        (Phi[0], y, r"y has shape \(1, 20, 3\)"),
    ):
        with pytest.raises(InputError, match=words):
            rls.step(sample, measured)
    with pytest.raises(InputError, match="y has shape"):
        rls.run(Phi, y[:-1])
    np.testing.assert_array_equal(rls.theta, theta)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rows": "both"}, "choose 'joint' or 'shared'"),
        ({"P0": 0}, "P0 = 0"),
        ({"P0": np.inf}, "P0 = inf"),
        ({"forgetting": 0}, "forgetting = 0"),
        ({"forgetting": 1.001}, "forgetting = 1.001"),
        ({"columns": "all"}, "choose 'rigid' or 'thesis'"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(InputError, match=message):
        RLS(**options)
