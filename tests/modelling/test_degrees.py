"""Angles in degrees get a warning from every function that takes angles; angles within a turn of the limits do not."""

import warnings

import numpy as np
import pytest

from ir50p_lab import modelling as m
from ir50p_lab.errors import SuspiciousAngleWarning
from ir50p_lab.identification import regressor
from ir50p_lab.simulation import simulate

ZERO = np.zeros(3)
SMOOTH = m.IR50P.without_friction()
TAKES_ANGLES = {
    "forward_kinematics": m.forward_kinematics,
    "frames": m.frames,
    "jacobian": m.jacobian,
    "transform": lambda arm, q: m.transform(arm, q, 0, 3),
    "energy": lambda arm, q: m.energy(arm, q, 0 * np.asarray(q)),
    "regressor": lambda arm, q: regressor(q, 0 * np.asarray(q), 0 * np.asarray(q)),
    "mass_matrix": m.mass_matrix,
    "coriolis_matrix": lambda arm, q: m.coriolis_matrix(arm, q, 0 * np.asarray(q)),
    "gravity": m.gravity,
    "inverse_dynamics": lambda arm, q: m.inverse_dynamics(arm, q, 0 * np.asarray(q), 0 * np.asarray(q)),
    "forward_dynamics": lambda arm, q: m.forward_dynamics(arm, q, 0 * np.asarray(q), 0 * np.asarray(q)),
    "simulate to": lambda arm, q: simulate(arm, reference=np.asarray(q), duration=0.02),
    "simulate from": lambda arm, q: simulate(arm, q0=np.asarray(q), duration=0.02),
}


@pytest.mark.parametrize("name", TAKES_ANGLES)
@pytest.mark.parametrize("q", [(30, 0, -20), (0, 90, 0), (0.0, 0.0, -135.0)])
def test_degrees_are_warned_of_where_they_are_given(name, q):
    with pytest.warns(SuspiciousAngleWarning, match=r"q has an angle more than a turn .*np\.radians") as caught:
        TAKES_ANGLES[name](SMOOTH, q)
    assert len(caught) == 1 and caught[0].filename == __file__


def test_many_poses_and_a_theta():
    poses = np.array([ZERO, [0, 0, 45.0], ZERO])
    for arm in (SMOOTH, SMOOTH.theta):
        with pytest.warns(SuspiciousAngleWarning, match="q has an angle"):
            m.gravity(arm, poses)


@pytest.mark.parametrize("name", TAKES_ANGLES)
def test_angles_within_a_turn_are_not(name):
    rng = np.random.default_rng(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for q in rng.uniform(-2 * np.pi, 2 * np.pi, (50, 3)):
            TAKES_ANGLES[name](SMOOTH, q)
