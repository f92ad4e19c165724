"""Which parameters can be told apart: ranks by routes that must agree."""

import numpy as np
import pytest
import scipy.linalg
from arms import random_states

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import base_parameters, regressor
from ir50p_lab.identification.parameters import NAMES


@pytest.fixture(scope="module")
def states():
    return random_states(np.random.default_rng(0), 500)


@pytest.fixture(scope="module")
def Phi(states):
    return regressor(*states)


def check_invariant(Phi, base):
    """Phi theta = Phi_base (matrix theta), for any theta; and QR with pivoting finds the same rank."""
    A = Phi.reshape(-1, Phi.shape[-1])
    theta = np.random.default_rng(1).normal(size=A.shape[1])
    expected = A @ theta
    np.testing.assert_allclose(A[:, base.columns] @ (base.matrix @ theta), expected, atol=1e-9 * np.abs(expected).max())
    length = np.linalg.norm(A, axis=0)
    seen = length > 1e-12 * length.max()
    pivots = np.abs(np.diag(scipy.linalg.qr(A[:, seen] / length[seen], mode="r", pivoting=True)[0]))
    assert np.sum(pivots > 1e-9) == base.rank


def test_thesis_regressor_has_rank_20(Phi):
    base = base_parameters(Phi)
    assert base.rank == 20
    assert base.groups == base.names == NAMES
    assert base.singular_values[0] < 10 * base.singular_values[-1]
    assert base.unseen == ()
    check_invariant(Phi, base)


@pytest.mark.parametrize(("row", "rank", "unseen"), [(0, 9, 11), (1, 11, 8), (2, 9, 11)])
def test_rows_have_ranks_9_11_9(Phi, row, rank, unseen):
    base = base_parameters(Phi[:, row])
    assert (base.rank, len(base.unseen)) == (rank, unseen)
    assert ("theta7 + theta8" in base.groups) == (row == 1)  # both columns are the waist's acceleration there
    check_invariant(Phi[:, row], base)


@pytest.mark.parametrize("seed", range(3))
def test_recovers_random_dependence(seed):
    rng = np.random.default_rng(seed)
    independent, dependent = rng.integers(2, 8), rng.integers(1, 5)
    A = rng.normal(size=(100, independent))
    mix = rng.integers(-2, 3, (independent, dependent))
    base = base_parameters(np.hstack([A, A @ mix]))
    assert base.rank == independent
    np.testing.assert_array_equal(base.columns, np.arange(independent))
    np.testing.assert_allclose(base.matrix[:, independent:], mix, atol=1e-12)


def test_groups_are_written_as_sums():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 50))
    columns = [a, b, 0.35 * a, -b, 3 * a, 0 * a, 0.1234567 * a]
    base = base_parameters(np.column_stack(columns), names=list("abcdefg"))
    assert base.groups == ("a + 0.35 c + 3 e + 0.1235 g", "b - d")
    assert "2 base parameters of 7" in str(base) and "without effect: f" in str(base)


RNG = np.random.default_rng(0)
A = RNG.normal(size=(200, 3))
NEAR = 1.5e-8 * np.linalg.norm(A.sum(axis=1)) * RNG.normal(size=200) / np.sqrt(200)
UNCLEAR = np.column_stack([A, A.sum(axis=1) + NEAR])


@pytest.mark.parametrize(
    ("Phi", "options", "error", "message"),
    [
        (np.zeros(5), {}, InputError, r"shape \(5,\)"),
        (np.full((9, 2), np.nan), {}, InputError, "Phi holds nan"),
        (np.ones((3, 2)), {}, InputError, "2 p rows at least"),
        (np.ones((9, 2)), {"names": ["a"]}, InputError, "1 names for 2 columns"),
        (np.zeros((9, 2)), {}, IdentificationError, "no motion"),
        # each column sticks out of the others a little above the tolerance, all together far less
        (UNCLEAR, {}, IdentificationError, r"the rank is not clear: 4 columns .* 3 singular values"),
    ],
)
def test_bad_input(Phi, options, error, message):
    with pytest.raises(error, match=message):
        base_parameters(Phi, **options)
