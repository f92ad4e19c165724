"""mass_matrix: how heavy the arm is for its joints."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def mass_matrix(q, l, m, lc, inertia, rotor):
    """Mass matrix (3, 3) kg m^2 of the arm    (1.90 corrected)."""
    T = frames(q, l)
    along = [T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]]
    M = np.diag(rotor)
    for i in range(3):
        J = jacobian(T, i + 1, T[i][:3, 3] + lc[i] * along[i])
        R = T[i + 1][:3, :3]
        M = M + m[i] * J[:3].T @ J[:3] + J[3:].T @ R @ inertia[i] @ R.T @ J[3:]
    return M


def _one():
    return [(np.zeros(3), np.ones(3), np.ones(3), np.ones(3), np.ones((3, 1, 1)) * np.eye(3), np.ones(3))]


TASK = task_of(mass_matrix, cases=_one, leans_on=("jacobian", "frames", "dh_matrix", "rot_z"))
