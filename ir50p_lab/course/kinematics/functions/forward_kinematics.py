"""forward_kinematics: the place of the tip."""


from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.course.kinematics.functions import some_arms
from ir50p_lab.course.kinematics.functions.frames import frames


def forward_kinematics(q, l):
    """Place of the tip, (3,) m    (1.31 corrected)."""
    T = frames(q, l)
    tip = T[3]
    return tip[:3, 3]


_BY_SINE_AND_COSINE = """def forward_kinematics(q, l):
    q1, q2, q3 = q
    l1, l2, l3 = l
    outwards = l2 * np.cos(q2) + l3 * np.cos(q2 + q3)
    height = l1 + l2 * np.sin(q2) + l3 * np.sin(q2 + q3)
    return np.array([outwards * np.cos(q1), outwards * np.sin(q1), height])"""


TASK = Task(
    name="forward_kinematics",
    asks="the place of the tip (3,), m",
    right=forward_kinematics,
    cases=lambda: some_arms(8, 5),
    leans_on=("frames", "dh_matrix", "rot_z"),
    parts=("x", "y", "z"),
    routes=(_BY_SINE_AND_COSINE,),
    loan=text_of(forward_kinematics),
    slips=mistakes(forward_kinematics),
    hints=(
        "You have the tip's frame already. What stands where in a transform?",
        "T[3] is 4 x 4; the place is a column.",
    ),
)  # fmt: skip
