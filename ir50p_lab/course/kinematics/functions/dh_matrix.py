"""dh_matrix: one joint with its link, from four motions."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions.rot_z import rot_z


def shift(x, y, z):
    """Return a shift as a transform (4, 4)."""
    T = np.eye(4)
    T[:3, 3] = [x, y, z]
    return T


def turn_z(angle):
    """Return a turn about z as a transform (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = rot_z(angle)
    return T


def turn_x(angle):
    """Return a turn about x as a transform (4, 4)."""
    c = np.cos(angle)
    s = np.sin(angle)
    T = np.eye(4)
    T[1:3, 1:3] = [[c, -s], [s, c]]
    return T


def dh_matrix(theta, d, a, alpha):
    """Return the transform of one joint and its link, (4, 4)    (1.29)."""
    joint = turn_z(theta) @ shift(0, 0, d)
    link = shift(a, 0, 0) @ turn_x(alpha)
    return joint @ link


def _rows():
    rows = np.random.default_rng(11).uniform(-1.5, 1.5, (6, 4))
    return [tuple(map(float, row)) for row in (*np.diag([0.4, 0.3, 0.2, 0.6]), *rows)]  # each motion alone, then all


def _symptom(case, returned, expected):
    if not np.allclose(returned[3], [0, 0, 0, 1]):
        return "its last row is not (0, 0, 0, 1): a transform needs that row, whatever the motion"
    moved = [name for name, value in zip(("theta", "d", "a", "alpha"), case, strict=True) if value]
    if len(moved) > 1:
        return ""
    return f"with {moved[0]} alone it is wrong already (the others 0). Which motion does {moved[0]} stand for?"


TASK = task_of(
    dh_matrix,
    helpers=(shift, turn_z, turn_x),
    cases=_rows,
    leans_on=("rot_z",),
    symptom=_symptom,
)
