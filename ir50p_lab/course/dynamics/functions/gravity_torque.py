"""gravity_torque: what holds the arm up."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def gravity_torque(q, l, m, lc, g):
    """Return the torques (3,) N m that hold the arm at rest in the pose q    (1.111)-(1.114)."""
    T = frames(q, l)
    along = [T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]]
    torque = np.zeros(3)
    for i in range(3):
        centre = T[i][:3, 3] + lc[i] * along[i]
        J = jacobian(T, i + 1, centre)
        torque = torque + m[i] * g * J[2]
    return torque


def _poses():
    rng = np.random.default_rng(51)
    cases = []
    for k in range(9):
        l = rng.uniform(0.1, 0.4, 3)  # m
        lc, m = l * rng.uniform(0.2, 0.8, 3), rng.uniform(0.3, 2, 3)
        cases.append((rng.uniform(-2, 2, 3) * (k > 0) + 0.0, l, m, lc, (9.81, 1.62)[k % 2]))
    return [*cases, (np.array([0, 1, -1]), *cases[1][1:])]  # whole numbers, as a student types them


_EARLIER = ("jacobian", "forward_kinematics", "frames", "dh_matrix", "rot_z")
_PARTS = ("torque 1", "torque 2", "torque 3")
TASK = task_of(gravity_torque, cases=_poses, leans_on=_EARLIER, tolerance=1e-6, entry_names=_PARTS, unit="N m")
