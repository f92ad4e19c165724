"""jacobian: how fast a point of the arm moves and turns, per joint speed."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.frames import frames


def jacobian(T, link, point):
    """Velocity and turning of a point carried by a link, per joint speed, (6, 3)    (1.32)-(1.43 corrected)."""
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


def _jacobian_symptom(cases, returned, expected):
    J, right = np.array(returned, dtype=float), np.array(expected)
    if not J[:, 3:].any():
        return "the lower three rows are still zero: about which axis does each joint turn the link?"
    top, bottom = np.allclose(J[:, :3], right[:, :3]), np.allclose(J[:, 3:], right[:, 3:])
    if bottom and not top:
        return (
            "the lower three rows (turning) are right, the upper three (velocity) are not: axis x lever, and the lever "
            "goes from where to where?"
        )
    if top and not bottom:
        return (
            "the upper three rows (velocity) are right, the lower three (turning) are not: about which axis does each "
            "joint turn the link?"
        )
    wrong = [str(c + 1) for c in range(3) if not np.allclose(J[:, :, c], right[:, :, c])]
    return f"column {', '.join(wrong)} is wrong: one column a joint" if 0 < len(wrong) < 3 else ""


TASK = Task(
    name="jacobian",
    tolerance=1e-5,  # as for damped_step
    asks="the matrix (6, 3) of a point (base coordinates) carried by link 1, 2 or 3: velocity above, turning below, "
    "one column a joint, from the four frames T",
    right=jacobian,
    cases=_points,
    leans_on=("frames", "dh_matrix", "rot_z"),
    loan=text_of(jacobian),
    slips=mistakes(jacobian),
    symptom=_jacobian_symptom,
    hints=(
        "Joint 1 alone turns: how fast does a point move that is 0.5 m from the axis, and where to? Axis x lever.",
        "Joint k turns about the z axis of frame k - 1, and stands at its origin. Both are columns of T[k - 1].",
    ),
)  # fmt: skip
