"""What stands in for functions of 04 and 05 that have no task yet; plain NumPy on those of 01 and 03."""

import numpy as np

from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def _links(q, l, lc):
    """Of each link: its Jacobian (6, 3) at the centre of mass, its axes (3, 3)."""
    T = frames(q, l)
    along = T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]
    return [(jacobian(T, i + 1, T[i][:3, 3] + lc[i] * along[i]), T[i + 1][:3, :3]) for i in range(3)]


def mass_matrix(q, l, m, lc, inertia, rotor):
    """The mass matrix (3, 3), kg m^2."""
    M = np.diag(rotor)
    for (J, R), mass, own in zip(_links(q, l, lc), m, inertia, strict=True):
        M = M + mass * J[:3].T @ J[:3] + J[3:].T @ R @ own @ R.T @ J[3:]
    return M


def velocity_torque(q, qd, mass):
    """Torques of the speeds (3,) N m, by central differences."""
    h = 1e-5
    slope = np.array([(mass(q + h * e) - mass(q - h * e)) / (2 * h) for e in np.eye(3)])  # dM/dq1, ...
    return np.einsum("kij,k,j", slope, qd, qd) - np.einsum("kij,i,j->k", slope, qd, qd) / 2


def gravity_torque(q, l, m, lc, g):
    """What holds the arm (3,) N m."""
    return sum(mass * g * J[2] for (J, _), mass in zip(_links(q, l, lc), m, strict=True))
