"""Bounded estimates: within their limits, optimal by another route, and no worse than they must be."""

import numpy as np
import pytest
from arms import random_arm, random_states
from scipy.optimize import nnls

from ir50p_lab.identification import fit, regressor
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS, NAMES, OFFSETS, ONLY_THESIS
from ir50p_lab.modelling import IR50P

RIGID = [sorted(set(acts) & set(COLUMNS["rigid"])) for acts in ACTS_ON]
BOUNDED = [k for k, name in enumerate(NAMES) if name not in (*OFFSETS, *ONLY_THESIS)]


def poor_data(seed, noise=30.0, n=300, theta=None):
    """Short, noisy data: plain least squares finds negative masses in it."""
    rng = np.random.default_rng(seed)
    q, qd, qdd = random_states(rng, n)
    Phi = regressor(q, 0.3 * qd, 0.1 * qdd)
    theta = IR50P.theta_pwm if theta is None else theta
    return Phi, np.einsum("nij,ij->ni", Phi, theta) + rng.normal(0, noise, (n, 3))


@pytest.mark.parametrize("seed", range(5))
def test_physically_consistent_where_least_squares_is_not(seed):
    Phi, y = poor_data(seed)
    plain, found = fit(Phi, y), fit(Phi, y, method="bounded", l2=IR50P.l[1])
    assert (plain.theta[:, BOUNDED] < 0).any()
    assert (found.theta[:, BOUNDED] >= 0).all()
    np.testing.assert_allclose(found.theta[1:, 5], IR50P.l[1] * found.theta[1:, 3], rtol=1e-12)
    assert not any("hardly possible" in text for text in found.warnings)
    assert (found.sigma < 1.05 * plain.sigma).all()  # at next to no loss of fit
    at = [(j, k) for j in range(3) for k in BOUNDED if NAMES[k] in found.columns[j] and found.theta[j, k] == 0]
    told = " ".join(text for text in found.warnings if "at a bound" in text)
    assert at and all(f"{NAMES[k]} = 0 (bound 0)" in told for j, k in at if k != 5)
    assert all(np.isinf(found.stderr[j, k]) for j, k in at)
    inside = [(j, k) for j in range(3) for k in BOUNDED if found.theta[j, k] > 0]
    assert all(np.isfinite(found.stderr[j, k]) for j, k in inside)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("rows", ["joint", "shared"])
def test_equals_nonnegative_least_squares_of_lawson_and_hanson(seed, rows):
    # another algorithm: offsets as differences of two non-negative numbers
    Phi, y = poor_data(seed)
    found = fit(Phi, y, method="bounded", rows=rows)
    for joints, here in [([0, 1, 2], COLUMNS["rigid"])] if rows == "shared" else [([j], RIGID[j]) for j in range(3)]:
        A, b = Phi[:, joints][:, :, here].reshape(-1, len(here)), y[:, joints].ravel()
        offsets = [here.index(NAMES.index(name)) for name in OFFSETS if NAMES.index(name) in here]
        x, _ = nnls(np.hstack([A, -A[:, offsets]]), b)
        expected = x[: len(here)]
        expected[offsets] -= x[len(here) :]
        scale = np.abs(expected).max()
        np.testing.assert_allclose(found.theta[joints[0], here], expected, rtol=1e-6, atol=1e-8 * scale)


@pytest.mark.parametrize("seed", range(2))
def test_good_data_are_left_alone(seed):
    arm = random_arm(np.random.default_rng(seed), coulomb=True)
    Phi = regressor(*random_states(np.random.default_rng(seed), 2000))
    y = np.einsum("nij,ij->ni", Phi, arm.theta_pwm)
    y += np.random.default_rng(seed).normal(0, 1e-4, y.shape) * np.abs(y).max()
    plain, found = fit(Phi, y), fit(Phi, y, method="bounded")
    inside = all((plain.theta[j, [k for k in RIGID[j] if k in BOUNDED]] >= 0).all() for j in range(3))
    assert inside
    np.testing.assert_allclose(found.theta, plain.theta, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(found.stderr, plain.stderr, rtol=1e-7)
    assert not any("at a bound" in text for text in found.warnings)
