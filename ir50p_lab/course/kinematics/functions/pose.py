"""The functions of 00 and 01: turning about z, the DH matrix, the frames of the arm, its tip."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.modelling.pose import homogeneous, rot_y

_LENGTHS = np.array([[0.285, 0.2, 0.372], [0.3, 0.25, 0.15], [0.0, 1.0, 0.8]])


def some_arms(count, seed):
    """Cases (q, l): poses of three arms, the first at rest."""
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-2.0, 2.0, (count, 3))
    return [(q, _LENGTHS[k % 3].copy()) for k, q in enumerate([np.zeros(3), *poses])]


# ----------------------------------------------------------------------------------------------------------- rot_z
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


ROT_Z = Task(
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


# ------------------------------------------------------------------------------------------------------- dh_matrix
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


DH_MATRIX = Task(
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


# ---------------------------------------------------------------------------------------------------------- frames
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


FRAMES = Task(
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


# ---------------------------------------------------------------------------------------------- forward_kinematics
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


FORWARD_KINEMATICS = Task(
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

TASKS = (ROT_Z, DH_MATRIX, FRAMES, FORWARD_KINEMATICS)
