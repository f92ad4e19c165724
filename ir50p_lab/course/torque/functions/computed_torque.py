"""computed_torque: what to send so that errors die as fast as chosen."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


def computed_torque(q, qd, reference, model, kp, kd):
    """Return the push (3,) with which q, qd follow the reference's rows q, qd, qdd, by model(q, qd, qdd) (2.19)."""
    q_planned, qd_planned, qdd_planned = reference
    wanted = qdd_planned + kd * (qd_planned - qd) + kp * (q_planned - q)
    return model(q, qd, wanted)


def bent(q, qd, qdd):
    """a made-up arm: heavier when it is bent, with springs and a brake that grows with the speed"""
    mass = np.array([[2 + np.cos(q[1]), 0.3, 0.1], [0.3, 1.5 + 0.4 * np.cos(q[2]), 0.2], [0.1, 0.2, 0.8]])
    return mass @ qdd + qd * np.abs(qd) + 3 * np.sin(q) + 0.7


def straight(q, qd, qdd):
    """another made-up arm, whose joints push each other"""
    return 0.5 * qdd + np.array([qdd[1], qdd[2], qdd[0]]) * np.cos(q) + 2 * qd + q**2


def _motions():
    rng = np.random.default_rng(141)
    cases = []
    for k in range(6):
        q, qd, *reference = rng.uniform(-1.5, 1.5, (5, 3))
        kp, kd = rng.uniform(5, 60, 3), rng.uniform(2, 20, 3)
        cases.append((q, qd, np.array(reference), (bent, straight)[k % 2], kp, kd))
    q, qd, reference = rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3), rng.uniform(-1, 1, (3, 3))
    still = np.array([[0, 1, -1], [0, 0, 0], [0, 0, 0]])
    return [
        *cases,
        (q, qd, reference, bent, 25.0, 10.0),  # one number for all joints
        (reference[0].copy(), reference[1].copy(), reference, straight, 25.0, 10.0),  # exactly on its path
        (np.array([0, 1, 0]), np.array([0, 0, 1]), still, bent, 30, 4),  # whole numbers
    ]


TASK = task_of(computed_torque, cases=_motions, unit="of the model", entry_names=("joint 1", "joint 2", "joint 3"))
