"""What the thesis prints in 2.2.4: wrong where the list of errors says so, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from ir50p_lab.course.printed_identification import recursive_2_46, regressor_2_51, torque_2_48, torque_in_symbols
from ir50p_lab.identification import regressor
from ir50p_lab.modelling import IR50P, THESIS_RODS, Friction, inverse_dynamics

ARM = replace(IR50P, friction=Friction(fv=(0.1, 0.2, 0.3)))
q, qd, qdd = np.random.default_rng(0).uniform(-2, 2, (3, 50, 3))


def wrong_joints(printed, right):
    return (np.abs(printed - right).max(axis=0) > 1e-9).tolist()


def test_the_symbolic_route_agrees_with_the_package():
    np.testing.assert_allclose(torque_in_symbols(ARM, q, qd, qdd), inverse_dynamics(ARM, q, qd, qdd), atol=1e-12)
    assert np.allclose(regressor(q, qd, qdd) @ ARM.theta[0], torque_in_symbols(ARM, q, qd, qdd), atol=1e-12)


@pytest.mark.parametrize(
    ("moving", "wrong"),
    [
        ((0, 0, 0), [False, True, False]),  # gravity: lc2 for l2
        ((1, 0, 0), [False, True, True]),  # U3: q1' for its square
        ((0, 1, 0), [False, True, True]),  # U3: s2 q2' for s3 q2'^2, and in the friction
        ((0, 0, 1), [False, True, True]),  # U2: no q3'^2; U3: friction
        ((1, 0, 1), [True, True, True]),  # U1: no l2
    ],
)
def test_2_48_is_wrong_there(moving, wrong):
    v = qd * moving
    assert wrong_joints(torque_2_48(ARM, q, v, 0 * q), inverse_dynamics(ARM, q, v, 0 * q)) == wrong


def test_2_48_with_a_unit_arm_hides_the_missing_length():
    v = qd * (1, 0, 1)
    arm = replace(THESIS_RODS, friction=Friction())
    assert not wrong_joints(torque_2_48(arm, q, v, 0 * q), inverse_dynamics(arm, q, v, 0 * q))[0]


def test_2_51_is_wrong_in_two_columns():
    difference = np.abs(regressor_2_51(q, qd, qdd) - regressor(q, qd, qdd)).max(axis=0)
    assert np.argwhere(difference > 1e-9).tolist() == [[0, 1], [0, 4], [1, 1], [1, 4], [2, 4]]
    unit = np.where(qd == 0, qd, 1.0)  # at q1' = 1 a lost square does not show
    difference = np.abs(regressor_2_51(q, unit, qdd) - regressor(q, unit, qdd)).max(axis=0)
    assert np.argwhere(difference > 1e-9).tolist() == [[0, 1], [0, 4]]


def test_2_46_as_printed_is_no_least_squares():
    Phi = regressor(q, qd, qdd)
    y = Phi @ ARM.theta[0]
    with_prior = np.linalg.solve(np.eye(20) + np.einsum("nip,niq->pq", Phi, Phi), np.einsum("nip,ni->p", Phi, y))
    assert np.abs(recursive_2_46(Phi, y, np.eye(20)) - with_prior).max() > 0.05
