"""gravity_torque: what holds the arm up."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def gravity_torque(q, l, m, lc, g):
    """Torques (3,) N m that hold the arm at rest in the pose q    (1.111)-(1.114)."""
    T = frames(q, l)
    along = [T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]]
    torque = np.zeros(3)
    for i in range(3):
        centre = T[i][:3, 3] + lc[i] * along[i]
        J = jacobian(T, i + 1, centre)
        torque = torque + m[i] * g * J[2]
    return torque


_ARMS = np.array([[0.3, 0.25, 0.15], [0.2, 0.4, 0.3], [0.12, 0.35, 0.25]])  # m


def _poses():
    rng = np.random.default_rng(51)
    cases = []
    for k in range(9):
        q, l = rng.uniform(-2, 2, 3), _ARMS[k % 3].copy()
        m, lc = rng.uniform(0.3, 2, 3), l * rng.uniform(0.2, 0.8, 3)
        cases.append((q, l, m, lc, (9.81, 9.81, 1.62)[k % 3]))
    return [(np.zeros(3), *cases[0][1:]), *cases]


TASK = task_of(
    gravity_torque,
    cases=_poses,
    leans_on=("jacobian", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    tolerance=1e-6,
    unit="N m",
)
