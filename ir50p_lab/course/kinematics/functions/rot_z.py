"""rot_z: a turn about z."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of


# fmt: off
def rot_z(angle):
    """Turn about z by an angle (rad), (3, 3)    (1.4)."""
    c = np.cos(angle)
    s = np.sin(angle)
    return np.array([
        [c, -s, 0],
        [s, c, 0],
        [0, 0, 1],
    ])
# fmt: on


def _angles():
    return [(float(x),) for x in (0.0, 0.5, np.pi / 2, -0.7, np.pi, 2.5, -3.0)]


def _rot_z_symptom(cases, returned, expected):
    R = np.array(returned, dtype=float)
    if not (np.allclose(R[:, 2], [0, 0, 1]) and np.allclose(R[:, :, 2], [0, 0, 1])):
        kept = [axis for axis, e in zip("xy", np.eye(3), strict=False) if np.allclose(R @ e, e)]
        yours = f"leaves {kept[0]} alone" if len(kept) == 1 else "does not"
        return f"a turn about z leaves z alone, yours {yours}: what has the third row, the third column to be?"
    lengths = np.linalg.norm(R[:, :, :2], axis=1)
    if not np.allclose(lengths, 1):
        return f"it stretches: what was 1 long becomes up to {lengths.max():.2f} long. Where do x and y axis go?"
    if not np.allclose((R[:, :, 0] * R[:, :, 1]).sum(axis=1), 0):
        return "its first two columns are not perpendicular: x and y axis stay a right angle when the waist turns"
    return ""


TASK = Task(
    name="rot_z",
    asks="the matrix (3, 3) that turns a point about the z axis by `angle` rad, counter-clockwise seen from above",
    right=rot_z,
    cases=_angles,
    loan=text_of(rot_z),
    slips=mistakes(rot_z),
    symptom=_rot_z_symptom,
    hints=(
        "Where does (1, 0, 0) go when the waist turns by the angle? Draw it from above. That is the first column.",
        "Where does (0, 1, 0) go? It stays a right angle ahead of the first. And (0, 0, 1)?",
    ),
)  # fmt: skip
