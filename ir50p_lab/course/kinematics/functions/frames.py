"""frames: the four frames of the arm, each as the base sees it."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.course.kinematics.functions import some_arms
from ir50p_lab.course.kinematics.functions.dh_matrix import dh_matrix


def frames(q, l):
    """Transforms of frames 0 to 3 as seen from the base, (4, 4, 4)    (1.14)-(1.19)."""
    A1 = dh_matrix(q[0], l[0], 0, np.pi / 2)
    A2 = dh_matrix(q[1], 0, l[1], 0)
    A3 = dh_matrix(q[2], 0, l[2], -np.pi / 2)
    T0 = np.eye(4)
    T1 = T0 @ A1
    T2 = T1 @ A2
    T3 = T2 @ A3
    return np.array([T0, T1, T2, T3])


def _frames_symptom(cases, returned, expected):
    T, right = np.array(returned, dtype=float), np.array(expected)
    if not np.allclose(T[:, 0], np.eye(4)):
        return "the first of the four is the base itself, seen from itself: it does nothing. Yours does"
    if np.allclose(np.linalg.det(T[:, :, :3, :3]), 1):
        links, right = np.linalg.inv(T[:, :3]) @ T[:, 1:], np.linalg.inv(right[:, :3]) @ right[:, 1:]
        bad = [k for k in range(3) if not np.allclose(links[:, k], right[:, k])]
        link, other = links[:, bad[0]], right[:, bad[0]]
        axes = "" if np.allclose(link[:, :3, :3], other[:, :3, :3]) else "axes"
        place = "" if np.allclose(link[:, :3, 3], other[:, :3, 3]) else "place"
        what = " and ".join(filter(None, (axes, place)))
        return (
            f"the step from frame {bad[0]} to frame {bad[0] + 1} has the wrong {what}"
            + (": the other two steps are right" if len(bad) == 1 else "")
            + f". Compare row {bad[0] + 1} of the arm's table, and how this frame is chained to the one before"
        )
    return "not every turn in it keeps right angles and lengths: are the links multiplied with `@`?"


_BY_TABLE = """def chain(q, table):
    T = [np.eye(4)]
    for k in range(len(q)):
        d, a, alpha = table[k]
        step = dh_matrix(q[k], d, a, alpha)
        T.append(T[-1] @ step)
    return np.array(T)


def frames(q, l):
    table = [[l[0], 0, np.pi / 2], [0, l[1], 0], [0, l[2], -np.pi / 2]]
    return chain(q, table)"""


TASK = Task(
    name="frames",
    asks="the four transforms (4, 4, 4) of frames 0 (base) to 3 (tip), each as the base sees it",
    right=frames,
    cases=lambda: some_arms(7, 3),
    leans_on=("dh_matrix", "rot_z"),
    routes=(_BY_TABLE,),
    loan=text_of(frames),
    slips=mistakes(frames),
    symptom=_frames_symptom,
    hints=(
        "One line a joint: dh_matrix with the row of the arm's table. Then chain them.",
        "T1 = T0 @ A1, T2 = T1 @ A2 ...: each new frame is seen through the one before it.",
    ),
)  # fmt: skip
