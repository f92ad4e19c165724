"""forward_kinematics: the place of the tip."""

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.kinematics.functions import some_arms
from ir50p_lab.course.kinematics.functions.frames import frames


def forward_kinematics(q, l):
    """Return the place of the tip, (3,) m    (1.31 corrected)."""
    T = frames(q, l)
    tip = T[3]
    return tip[:3, 3]


TASK = task_of(
    forward_kinematics,
    cases=lambda: some_arms(8, 5),
    leans_on=("frames", "dh_matrix", "rot_z"),
    entry_names=("x", "y", "z"),
)
