"""rot_z: a turn about z."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


# fmt: off
def rot_z(angle):
    """Return the turn about z by an angle (rad), (3, 3)    (1.4)."""
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
    cases=lambda: [(float(x),) for x in (0.0, 0.5, np.pi / 2, -0.7, np.pi, 2.5, -3.0)],
)
