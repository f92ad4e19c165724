"""What the thesis prints in 2.2.4: wrong where the list of errors says so, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from ir50p_lab.course.printed.identification import regressor_2_51, torque_2_48
from ir50p_lab.identification import regressor
from ir50p_lab.modelling import IR50P, Friction, inverse_dynamics

ARM = replace(IR50P, friction=Friction(fv=(0.1, 0.2, 0.3)))
q, qd, qdd = np.random.default_rng(0).uniform(-2, 2, (3, 50, 3))


def wrong_joints(printed, right):
    return (np.abs(printed - right).max(axis=0) > 1e-9).tolist()


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


def test_2_51_is_wrong_in_two_columns():
    difference = np.abs(regressor_2_51(q, qd, qdd) - regressor(q, qd, qdd)).max(axis=0)
    assert np.argwhere(difference > 1e-9).tolist() == [[0, 1], [0, 4], [1, 1], [1, 4], [2, 4]]
    unit = np.where(qd == 0, qd, 1.0)  # at q1' = 1 a lost square does not show
    difference = np.abs(regressor_2_51(q, unit, qdd) - regressor(q, unit, qdd)).max(axis=0)
    assert np.argwhere(difference > 1e-9).tolist() == [[0, 1], [0, 4]]
