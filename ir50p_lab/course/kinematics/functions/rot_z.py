"""rot_z: a turn about z."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


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


TASK = task_of(
    rot_z,
    "the matrix (3, 3) that turns a point about the z axis by `angle` rad, counter-clockwise seen from above",
    cases=lambda: [(float(x),) for x in (0.0, 0.5, np.pi / 2, -0.7, np.pi, 2.5, -3.0)],
    hints=(
        "Where does (1, 0, 0) go when the waist turns by the angle? Draw it from above. That is the first column.",
        "Where does (0, 1, 0) go? It stays a right angle ahead of the first. And (0, 0, 1)?",
    ),
)
