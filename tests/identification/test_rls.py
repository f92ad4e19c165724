"""Recursive least squares: equal to the batch, to the corrected equations of the thesis, and stable for ever."""

import numpy as np
import pytest
from arms import random_states

from ir50p_lab.errors import InputError
from ir50p_lab.identification import RLS, fit, regressor
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS
from ir50p_lab.modelling import IR50P


def data(seed, n, noise=1.0, theta=None):
    rng = np.random.default_rng(seed)
    Phi = regressor(*random_states(rng, n))
    theta = IR50P.theta_pwm if theta is None else theta
    return Phi, np.einsum("nij,ij->ni", Phi, theta) + noise * rng.normal(size=(n, 3))


def relative(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("rows", ["joint", "shared"])
@pytest.mark.parametrize("seed", range(3))
def test_equals_least_squares(rows, seed):
    Phi, y = data(seed, 3000)
    batch = fit(Phi, y, rows=rows)
    rls = RLS(rows=rows, P0=1e8)
    history = rls.run(Phi, y)
    assert relative(history[-1], batch.theta) < 1e-6
    np.testing.assert_array_equal(history[-1], rls.theta)
    one_by_one = RLS(rows=rows, P0=1e8)
    for block, sample in zip(Phi[:200], y[:200], strict=True):
        theta = one_by_one.step(block, sample)
    np.testing.assert_array_equal(theta, history[199])


def test_p_is_the_inverse_of_the_information():
    Phi, y = data(1, 500)
    rls = RLS(rows="shared", columns="thesis")
    rls.run(Phi, y)
    A = Phi.reshape(-1, 20)
    assert relative(rls.P, np.linalg.inv(A.T @ A + np.eye(20) / 1e8)) < 1e-8
    rls = RLS(rows="joint")
    rls.run(Phi, y)
    for joint in range(3):
        here = sorted(set(ACTS_ON[joint]) & set(COLUMNS["rigid"]))
        A = Phi[:, joint, here]
        assert relative(rls.P[joint][np.ix_(here, here)], np.linalg.inv(A.T @ A + np.eye(len(here)) / 1e8)) < 1e-8


@pytest.mark.parametrize("forgetting", [1.0, 0.98])
def test_equals_the_thesis_equations_with_the_inversion_lemma_put_right(forgetting):
    # block form: S = forgetting I + phi^T P phi, K = P phi S^-1, P = (I - K phi^T) P / forgetting, in plain double
    # precision: from a state where P is small already
    Phi, y = data(2, 350)
    rls = RLS(rows="shared", columns="thesis", forgetting=forgetting)
    theta, P = rls.run(Phi[:50], y[:50])[-1, 0], rls.P
    for phi_T, sample in zip(Phi[50:], y[50:], strict=True):
        S = forgetting * np.eye(3) + phi_T @ P @ phi_T.T
        K = np.linalg.solve(S, phi_T @ P).T
        theta = theta + K @ (sample - phi_T @ theta)
        P = (np.eye(20) - K @ phi_T) @ P / forgetting
        np.testing.assert_allclose(rls.step(phi_T, sample)[0], theta, rtol=1e-7, atol=1e-7)
    assert relative(rls.P, P) < 1e-7


def test_as_printed_the_gain_is_wrong():
    # (2.43), (2.44) with P^-1 in the bracket, and line 2 of (2.43), A^-1 + B^-1 for (A + B)^-1
    Phi, y = data(3, 300, noise=0.0)
    theta, P = np.zeros(20), np.eye(20)
    true = IR50P.theta
    y = np.einsum("nij,ij->ni", Phi, true)
    for phi_T, sample in zip(Phi, y, strict=True):
        bracket = np.eye(3) + phi_T @ np.linalg.solve(P, phi_T.T)
        K = np.linalg.solve(bracket, phi_T @ P).T
        theta = theta + K @ (sample - phi_T @ theta)
        P = (np.eye(20) - K @ phi_T) @ P
    right = RLS(rows="shared", columns="thesis", P0=1.0)
    right.run(Phi, y)
    assert relative(right.theta[0], true[0]) < 0.1 * relative(theta, true[0])
    assert np.linalg.matrix_rank(Phi[0].T @ Phi[0]) == 3  # no inverse to speak of: line 2 cannot be meant


def slow_motion(seed, n=3000):
    """Regressor of a smooth motion: what makes P badly conditioned at first."""
    rng, t = np.random.default_rng(seed), np.arange(n)[:, None] * 0.01
    q, qd, qdd = np.zeros((3, n, 3))
    for w in rng.uniform(0.3, 5, 9):
        a, phase = rng.normal(0, 0.3, 3), rng.uniform(0, 6, 3)
        q += a * np.sin(w * t + phase)
        qd += a * w * np.cos(w * t + phase)
        qdd -= a * w * w * np.sin(w * t + phase)
    return regressor(q, qd, qdd)


def plain(Phi, y, P0, gain):
    """(2.46) corrected in plain double precision; returns theta, asymmetry of P, its smallest relative eigenvalue."""
    theta, P, smallest = np.zeros(20), P0 * np.eye(20), np.inf
    for phi_T, sample in zip(Phi, y, strict=True):
        S = np.eye(3) + phi_T @ P @ phi_T.T
        left = P @ phi_T.T if gain == "P phi" else (phi_T @ P).T
        K = np.linalg.lstsq(S.T, left.T, rcond=None)[0].T
        theta, P = theta + K @ (sample - phi_T @ theta), (np.eye(20) - K @ phi_T) @ P
        if np.abs(theta).max() > 1e6:
            break
        smallest = min(smallest, np.linalg.eigvalsh((P + P.T) / 2).min() / np.abs(P).max())
    return theta, np.abs(P - P.T).max() / np.abs(P).max(), smallest


@pytest.mark.parametrize("seed", range(2))
def test_the_factored_form_holds_where_the_plain_one_breaks(seed):
    Phi, true = slow_motion(seed), IR50P.theta[0]
    y = np.einsum("nij,j->ni", Phi, true)
    assert plain(Phi, y, 1e8, "P phi")[1] > 1e-6  # P is no longer symmetric
    assert plain(Phi, y, 1e12, "P phi")[2] < -0.1  # nor positive
    assert np.abs(plain(Phi, y, 1e8, "(phi^T P)^T")[0]).max() > 1e6  # and then theta runs away
    for P0 in (1e8, 1e12):
        rls = RLS(rows="shared", columns="thesis", P0=P0)
        rls.run(Phi, y)
        assert np.abs(rls.theta[0] - true).max() < 1e-9
        np.testing.assert_allclose(rls.P, rls.P.T, rtol=1e-10, atol=1e-14 * np.abs(rls.P).max())
        assert (rls._D > 0).all()


@pytest.mark.parametrize("forgetting", [1.0, 0.9999, 0.99])
def test_stable_over_a_million_samples(forgetting):
    n, rounds = 50_000, 20
    Phi, y = data(4, n, noise=0.01)
    rls = RLS(rows="shared", columns="thesis", P0=1e8, forgetting=forgetting)
    y = np.einsum("nij,ij->ni", Phi, IR50P.theta) + (y - np.einsum("nij,ij->ni", Phi, IR50P.theta_pwm))
    for _ in range(rounds):
        rls.run(Phi, y, history=False)
    P = rls.P
    assert np.abs(P - P.T).max() <= 1e-12 * np.abs(P).max()
    assert np.linalg.eigvalsh(P).min() > 0
    # least squares with the same weights is the judge
    weights = np.sqrt(forgetting ** np.arange(n)[::-1])
    A, b = (Phi * weights[:, None, None]).reshape(-1, 20), (y * weights[:, None]).ravel()
    expected = np.linalg.lstsq(A, b, rcond=None)[0]
    assert relative(rls.theta[0], expected) < 1e-6


def test_forgetting_without_excitation_does_not_blow_up():
    Phi, y = data(5, 5000)
    rls = RLS(forgetting=0.99)
    rls.run(Phi, y)
    before = rls.theta
    still = regressor(np.full((200_000, 3), 0.3), np.zeros((200_000, 3)), np.zeros((200_000, 3)))
    rng = np.random.default_rng(0)
    held = np.einsum("nij,ij->ni", still, IR50P.theta_pwm) + rng.normal(0, 1, (200_000, 3))
    rls.run(still, held, history=False)
    assert np.isfinite(rls.theta).all()
    assert np.linalg.eigvalsh(rls.P[0][np.ix_([0, 16], [0, 16])]).min() > 0
    assert rls.P.max() <= 1.01e8 * 20
    after = rls.run(Phi, y)[-1]  # and it comes back
    assert relative(after, before) < 1e-6


def test_forgetting_follows_a_change():
    heavier = IR50P.theta_pwm.copy()
    heavier[:, 3] *= 1.5
    Phi, y = data(6, 4000)
    Phi2, y2 = data(7, 4000, theta=heavier)
    errors = {}
    for forgetting in (1.0, 0.995):
        rls = RLS(forgetting=forgetting)
        rls.run(Phi, y)
        errors[forgetting] = np.abs(rls.run(Phi2, y2)[-1][1:, 3] / heavier[1:, 3] - 1).max()
    assert errors[0.995] < 0.05 < 0.1 < errors[1.0]


def test_columns_left_out_are_zero():
    Phi, y = data(9, 400)
    rls = RLS()
    theta = rls.run(Phi, y)[-1]
    for joint, acts in enumerate(ACTS_ON):
        here = sorted(set(acts) & set(COLUMNS["rigid"]))
        assert np.flatnonzero(theta[joint]).tolist() == np.flatnonzero(rls.P[joint].any(axis=0)).tolist() == here


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_bad_samples_are_refused_and_change_nothing(size):
    Phi, y = data(10, 20)
    rls = RLS()
    rls.run(Phi * size, y * size)
    theta, P = rls.theta, rls.P
    bad = Phi[0].copy()
    bad[1, 2] = np.nan
    with pytest.raises(InputError, match="Phi holds nan"):
        rls.step(bad * size, y[0])
    with pytest.raises(InputError, match="y holds inf"):
        rls.step(Phi[0] * size, [1, np.inf, 0])
    with pytest.raises(InputError, match=r"Phi has shape \(1, 2, 20\)"):
        rls.step(Phi[0, :2], y[0])
    with pytest.raises(InputError, match=r"y has shape \(1, 20, 3\)"):
        rls.step(Phi[0], y)
    with pytest.raises(InputError, match="y has shape"):
        rls.run(Phi, y[:-1])
    np.testing.assert_array_equal(rls.theta, theta)
    np.testing.assert_array_equal(rls.P, P)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rows": "both"}, "choose 'joint' or 'shared'"),
        ({"P0": 0}, "P0 = 0"),
        ({"P0": np.inf}, "P0 = inf"),
        ({"P0": -1e8}, "P0 = -1"),
        ({"forgetting": 0}, "forgetting = 0"),
        ({"forgetting": 1.001}, "forgetting = 1.001"),
        ({"forgetting": np.nan}, "forgetting = nan"),
        ({"columns": "all"}, "choose 'rigid' or 'thesis'"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(InputError, match=message):
        RLS(**options)
