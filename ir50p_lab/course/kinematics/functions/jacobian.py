"""jacobian: how fast a point of the arm moves and turns, per joint speed."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.frames import frames


def jacobian(T, link, point):
    """Return velocity and turning of a point on a link, per joint speed, (6, 3)    (1.32)-(1.43 corrected)."""
    J = np.zeros((6, 3))
    for joint in range(link):
        axis = T[joint][:3, 2]
        origin = T[joint][:3, 3]
        lever = point - origin
        J[:3, joint] = np.cross(axis, lever)
        J[3:, joint] = axis
    return J


def _points():
    rng = np.random.default_rng(31)
    cases = []
    for k in range(9):
        q, l = rng.uniform(-2, 2, 3), LENGTHS[k % 3]
        T = frames(q, l)
        link = 3 - k % 3
        tip = T[link][:3, 3]
        cases.append((T, link, tip.copy() if k < 3 else tip + rng.uniform(-0.1, 0.1, 3)))
    return cases


TASK = task_of(
    jacobian,
    cases=_points,
    leans_on=("frames", "dh_matrix", "rot_z"),
    tolerance=1e-5,  # as for damped_step
)
