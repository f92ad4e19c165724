"""Which parameters can be told apart: ranks of ERRATA and of the symbolic derivation, by routes that must agree."""

import mujoco
import numpy as np
import pytest
import scipy.linalg
from arms import random_states

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import base_parameters, general_regressor, regressor
from ir50p_lab.identification.general_arm import GENERAL_NAMES
from ir50p_lab.identification.parameters import NAMES

L2 = 0.2


@pytest.fixture(scope="module")
def states():
    return random_states(np.random.default_rng(0), 500)


@pytest.fixture(scope="module")
def Phi(states):
    return regressor(*states)


@pytest.fixture(scope="module")
def general(states):
    return general_regressor(*states, l2=L2)


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


def test_general_arm_has_25_base_parameters(general):
    base = base_parameters(general, names=GENERAL_NAMES, known={"l2": L2})
    assert general.shape == (500, 3, 42)
    assert base.rank == 25
    groups = (
        "ZZ1 + YY2 + YY3 + l2^2 m3 + j1|XX2 - YY2 - l2^2 m3|XY2|XZ2 + l2 mz3|YZ2|ZZ2 + l2^2 m3 + j2|mx2 + l2 m3|my2"
    )
    assert base.groups[:16] == (*groups.split("|"), *"XX3 - YY3|XY3|XZ3|YZ3|ZZ3|mx3|my3|j3".split("|"))
    assert set(base.unseen) == {"m2", "mz2", "m1", "mx1", "my1", "mz1", "XX1", "YY1", "XY1", "XZ1", "YZ1"}
    assert base.singular_values[24] > 1e-2 > 1e-12 > base.singular_values[25]
    check_invariant(general, base)
    text = str(base)
    assert "25 base parameters of 42" in text
    assert "XZ2 + l2 mz3" in text
    assert "without effect: m2" in text


def random_links(rng):
    links = []
    for _ in range(3):
        spread = rng.normal(size=(3, 3)) * 0.1
        second = spread @ spread.T  # int r r^T dm of some body
        links.append((rng.uniform(0.3, 3), rng.normal(0, 0.2, 3), np.trace(second) * np.eye(3) - second))
    return links


def general_parameters(links, rotors=(0.0, 0.0, 0.0)):
    """The 33 inertial parameters, in the order of GENERAL_NAMES, of three links (m, com, inertia about it)."""
    found = {f"j{i}": x for i, x in enumerate(rotors, start=1)}
    for i, (m, com, inertia) in enumerate(links, start=1):
        about_joint = inertia + m * (com @ com * np.eye(3) - np.outer(com, com))
        found |= {f"m{i}": m} | {f"m{axis}{i}": m * x for axis, x in zip("xyz", com, strict=True)}
        for a, b in zip(*np.triu_indices(3), strict=True):  # the matrix holds -XY
            found[f"{'XYZ'[a]}{'XYZ'[b]}{i}"] = about_joint[a, b] * (1 if a == b else -1)
    return np.array([found[name] for name in GENERAL_NAMES[:33]])


@pytest.mark.parametrize("seed", range(2))
def test_general_regressor_is_the_inverse_dynamics_of_mujoco(seed):
    rng = np.random.default_rng(seed)
    links, rotors, l2 = random_links(rng), rng.uniform(0, 0.2, 3), rng.uniform(0.1, 0.6)
    text, turns = "", ("1 0 0 0", "0.7071067811865476 0.7071067811865476 0 0", "1 0 0 0")
    for i, ((m, com, I), place) in enumerate(zip(links, ("0 0 0", "0 0 0.3", f"{l2} 0 0"), strict=True)):
        numbers = " ".join(repr(float(x)) for x in (I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]))
        text += (
            f'<body pos="{place}" quat="{turns[i]}"><joint type="hinge" axis="0 0 1" armature="{float(rotors[i])!r}"/>'
            f'<inertial pos="{" ".join(map(repr, com.tolist()))}" mass="{float(m)!r}" fullinertia="{numbers}"/>'
        )
    xml = f'<mujoco><option gravity="0 0 -9.81"/><worldbody>{text}{"</body>" * 3}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    states = random_states(rng, 20)
    tau = general_regressor(*states, l2=l2)[:, :, :33] @ general_parameters(links, rotors=rotors)
    for k in range(20):
        data.qpos[:], data.qvel[:], data.qacc[:] = (x[k] for x in states)
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(tau[k], data.qfrc_inverse, rtol=1e-8, atol=1e-8)


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


def test_coefficients_in_symbols():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 50))
    columns = [a, b, 0.35 * a, 0.35**2 * b, 3 * a, -2.5 * 0.35 * b, 0.1234567 * a, 9.81 * b]
    base = base_parameters(np.column_stack(columns), names=list("abcdefgh"), known={"l2": 0.35, "g": 9.81})
    assert base.groups == ("a + l2 c + 3 e + 0.1235 g", "b + l2^2 d - 0.875 f + g h")


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
