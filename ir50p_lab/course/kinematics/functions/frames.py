"""frames: the four frames of the arm, each as the base sees it."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions import some_arms
from ir50p_lab.course.kinematics.functions.dh_matrix import dh_matrix


def frames(q, l):
    """Return the transforms of frames 0 to 3 as seen from the base, (4, 4, 4)    (1.14)-(1.19)."""
    A1 = dh_matrix(q[0], l[0], 0, np.pi / 2)
    A2 = dh_matrix(q[1], 0, l[1], 0)
    A3 = dh_matrix(q[2], 0, l[2], -np.pi / 2)
    T0 = np.eye(4)
    T1 = T0 @ A1
    T2 = T1 @ A2
    T3 = T2 @ A3
    return np.array([T0, T1, T2, T3])


def _symptom(case, returned, expected):
    T = np.asarray(returned, dtype=float)
    if not np.allclose(T[0], np.eye(4)):
        return "the first of the four is the base itself, seen from itself: it does nothing. Yours does"
    if not np.allclose(np.linalg.det(T[:, :3, :3]), 1):
        return "not every turn in it keeps right angles and lengths: are the links multiplied with `@`?"
    links, right = (np.linalg.solve(one[:3], one[1:]) for one in (T, expected))
    bad = int(np.argmax(np.abs(links - right).max(axis=(1, 2)) > 1e-9))
    return (
        f"the step from frame {bad} to frame {bad + 1} is wrong. Compare row {bad + 1} of the arm's table, and how "
        "this frame is chained to the one before"
    )


TASK = task_of(
    frames,
    cases=lambda: some_arms(7, 3),
    leans_on=("dh_matrix", "rot_z"),
    symptom=_symptom,
)
