"""velocity_torque: what a motion asks of the joints by its speed alone."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.modelling import IR50P, mass_matrix


def velocity_torque(q, qd, mass):
    """Return the torques (3,) N m that keep all joints at a steady speed, without weight    (1.78)-(1.81 corrected)."""
    small = 1e-5
    change = np.zeros((3, 3))
    pull = np.zeros(3)
    for joint in range(3):
        step = np.zeros(3)
        step[joint] = small
        slope = (mass(q + step) - mass(q - step)) / (2 * small)
        change = change + slope * qd[joint]
        pull[joint] = qd @ slope @ qd
    return change @ qd - pull / 2


def arm_mass(q):
    """that of an arm, in kg m^2"""
    return mass_matrix(IR50P, q)


def made_up_mass(q):
    """made up, in kg m^2; it depends on q1 as well"""
    a, b, c = 0.1 * np.sin(q[0] + q[1]), 0.15 * np.cos(q[1] - q[2]), 0.1 * np.sin(q[0] - q[2])
    d, e, f = 0.1 * np.cos(q[0] + q[2]), 0.12 * np.sin(q[1]), 0.08 * np.cos(q[2])
    return np.array([[0.6 + a + b, d + e, f + c], [d + e, 0.5 + b + c, a + f], [f + c, a + f, 0.4 + d]])


def _motions():
    rng = np.random.default_rng(52)
    speeds = rng.uniform(-3, 3, (12, 3))
    speeds[2:5] = np.diag([2.0, -2.5, 3.0])  # one joint at a time
    speeds[5] = 0
    masses = (arm_mass, made_up_mass)
    cases = [(rng.uniform(-1.5, 1.5, 3), qd, masses[k % 2 if k < 2 else k % 3 > 0]) for k, qd in enumerate(speeds)]
    return [*cases, (np.array([0, 1, -1]), speeds[0], arm_mass)]  # whole numbers, as a student types them


def _symptom(case, returned, expected):
    off = np.max(np.abs(returned - expected))
    given, gained = np.sum(case[1] * returned), case[1] @ expected
    key = "near" if off < 0.05 else "energy" if abs(given - gained) > 1e-3 else "torques"
    return sentences("velocity_torque", __file__)[key].format(off=off, given=given, gained=gained)


_PARTS = ("torque 1", "torque 2", "torque 3")
TASK = task_of(velocity_torque, cases=_motions, tolerance=1e-4, entry_names=_PARTS, symptom=_symptom, unit="N m")
