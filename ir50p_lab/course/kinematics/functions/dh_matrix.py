"""dh_matrix: one joint with its link, from four motions."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.course.kinematics.functions.rot_z import rot_z
from ir50p_lab.modelling.pose import homogeneous, rot_y


def shift(x, y, z):
    """Shift as a transform (4, 4)."""
    T = np.eye(4)
    T[:3, 3] = [x, y, z]
    return T


def turn_z(angle):
    """Turn about z as a transform (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = rot_z(angle)
    return T


def turn_x(angle):
    """Turn about x as a transform (4, 4)."""
    c = np.cos(angle)
    s = np.sin(angle)
    T = np.eye(4)
    T[1:3, 1:3] = [[c, -s], [s, c]]
    return T


def turn_y(angle):
    """Turn about y as a transform (4, 4): the axis that no motion needs."""
    return homogeneous(rot_y(angle), np.zeros(3))


def dh_matrix(theta, d, a, alpha):
    """One joint and its link, (4, 4)    (1.29)."""
    joint = turn_z(theta) @ shift(0, 0, d)
    link = shift(a, 0, 0) @ turn_x(alpha)
    return joint @ link


def _rows():
    rng = np.random.default_rng(11)
    rows = rng.uniform(-1.5, 1.5, (6, 4))
    return [tuple(map(float, row)) for row in [(0.4, 0, 0, 0), (0, 0.3, 0, 0), (0, 0, 0.2, 0), (0, 0, 0, 0.6), *rows]]


def _dh_symptom(cases, returned, expected):
    T = [np.asarray(one, dtype=float) for one in returned]
    if not all(np.allclose(one[3], [0, 0, 0, 1]) for one in T):
        return "its last row is not (0, 0, 0, 1): a transform needs that row, whatever the motion"
    for case, one, right in zip(cases, T, expected, strict=True):
        moved = [name for name, value in zip(("theta", "d", "a", "alpha"), case, strict=True) if value]
        if len(moved) == 1 and not np.allclose(one, right):
            return f"with {moved[0]} alone it is wrong already (the others 0). Which motion does {moved[0]} stand for?"
    return (
        "each motion alone is right, together they are not: their order. Each one happens in the frame that the "
        "motions before it have made"
    )


TASK = Task(
    name="dh_matrix",
    asks="the transform (4, 4) of one joint with its link: turn about z, shift along z, shift along x, turn about x",
    right=dh_matrix,
    cases=_rows,
    leans_on=("rot_z",),
    loan=text_of(shift, turn_z, turn_x, dh_matrix),
    slips=mistakes(dh_matrix),
    symptom=_dh_symptom,
    hints=(
        "Write four small matrices first, one a motion: your rot_z in a 4 x 4, two shifts, a turn about x.",
        "Motions in the moving frame are multiplied from the left to the right, in the order in which they happen.",
    ),
)  # fmt: skip
