"""The functions of 00 and 01: turning about z, the DH matrix, the frames of the arm, its tip."""

from functools import lru_cache

import numpy as np

from ir50p_lab import modelling
from ir50p_lab.course.functions.task import Slip, Task
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.pose import homogeneous, rot_x, rot_y

_LENGTHS = np.array([[0.285, 0.2, 0.372], [0.3, 0.25, 0.15], [0.0, 1.0, 0.8]])


@lru_cache(maxsize=16)
def _arm(l):
    return Arm(l=l, m=(1, 1, 1), lc=(l[0] / 2, l[1] / 2, l[2] / 2))


def arm_of(l):
    """An arm with these lengths, for the course's own functions."""
    return _arm(tuple(float(x) for x in l))


def some_arms(count, seed):
    """Cases (q, l): poses of three arms, the first at rest."""
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-2.0, 2.0, (count, 3))
    return [(q, _LENGTHS[k % 3].copy()) for k, q in enumerate([np.zeros(3), *poses])]


def with_degrees(right):
    """The same function for someone who takes angles for degrees."""
    return lambda q, l: right(np.radians(q), l)


# ----------------------------------------------------------------------------------------------------------- rot_z
def rot_z(angle):
    """Turn about z by an angle (rad), (3, 3)    (1.4)."""
    return modelling.rot_z(angle)


def _angles():
    return [(float(x),) for x in (0.0, 0.5, np.pi / 2, -0.7, np.pi, 2.5, -3.0)]


def _rot_z_symptom(cases, returned, expected):
    R = [np.asarray(one, dtype=float) for one in returned]
    if all((one == np.round(one)).all() for one in R):
        return "it holds whole numbers only: cosine and sine were cut off (an array of integers?)"
    if not all(np.allclose(one[2], [0, 0, 1]) and np.allclose(one[:, 2], [0, 0, 1]) for one in R):
        return "a turn about z leaves z alone, yours does not: what has the third row, the third column to be?"
    lengths = [np.linalg.norm(one[:, :2], axis=0) for one in R]
    if not np.allclose(lengths, 1):
        k = int(np.argmax([np.abs(length - 1).max() for length in lengths]))
        column = int(np.argmax(np.abs(lengths[k] - 1)))
        return (
            f"it stretches: (1, 0, 0) and (0, 1, 0) should keep their length, yours becomes {lengths[k][column]:.3f} "
            f"long in column {column + 1}. Where do the two go?"
        )
    if all(np.linalg.det(one) < 0 for one in R):
        return "it mirrors: x and y axis change their order, as no turn can do. Which entry has the wrong sign?"
    if not np.allclose([one[:, 0] @ one[:, 1] for one in R], 0):
        return "its first two columns are not perpendicular: x and y axis stay a right angle when the waist turns"
    if not np.allclose(R[0], np.eye(3)):
        return "at angle 0 nothing should turn, yours turns: are sine and cosine in each other's places?"
    return ""


ROT_Z = Task(
    name="rot_z",
    notebook="00_start_here",
    signature=("angle",),
    asks="the matrix (3, 3) that turns a point about the z axis by `angle` rad, counter-clockwise seen from above",
    right=rot_z,
    cases=_angles,
    loan="""def rot_z(angle):
    c = np.cos(angle)
    s = np.sin(angle)
    return np.array([
        [c, -s, 0],
        [s, c, 0],
        [0, 0, 1],
    ])""",
    slips=(
        Slip(
            lambda a: rot_z(np.radians(a)),
            "it turns far too little, 1.6 degrees for a quarter turn: the angle comes "
            "in radians already, is it converted once more?",
        ),
        Slip(
            lambda a: rot_z(np.degrees(a)),
            "it turns far too much: cosine and sine take radians, and the angle is in "
            "radians already; is it made into degrees?",
        ),
        Slip(
            lambda a: rot_z(a).T,
            "it turns the wrong way round: a quarter turn takes (1, 0, 0) to (0, -1, 0), to the "
            "right. Which way is counter-clockwise seen from above?",
        ),
        Slip(lambda a: rot_x(a), "it turns about x: the axis that stays where it is has to be z"),
        Slip(lambda a: rot_y(a), "it turns about y: the axis that stays where it is has to be z"),
        Slip(lambda a: rot_x(a).T, "it turns about x, and backwards: the axis that stays where it is has to be z"),
        Slip(lambda a: rot_y(a).T, "it turns about y, and backwards: the axis that stays where it is has to be z"),
        Slip(
            lambda a: rot_z(a)[:2, :2],
            "it is 2 x 2, a turn in the plane: points of the arm have a height, too, which the turn leaves alone",
        ),
        Slip(lambda a: homogeneous(rot_z(a), np.zeros(3)), "it is 4 x 4: here only the turn is asked for, 3 x 3"),
        Slip(
            lambda a: rot_z(a) @ np.diag([1, 1, 0]),
            "it presses every point down to height 0: what becomes of z when the waist turns?",
        ),
        Slip(
            lambda a: rot_z(a) @ np.array([1.0, 0, 0]),
            "it returns one turned point, three numbers; asked for is the matrix, which turns any point",
        ),
    ),
    symptom=_rot_z_symptom,
    hints=(
        "Where does (1, 0, 0) go when the waist turns by the angle? Draw it from above. That is the first column.",
        "Where does (0, 1, 0) go? It stays a right angle ahead of the first. And (0, 0, 1)?",
    ),
)


# ------------------------------------------------------------------------------------------------------- dh_matrix
def dh_matrix(theta, d, a, alpha):
    """One joint and its link, (4, 4)    (1.29)."""
    return modelling.dh_matrix(theta, d, a, alpha)


def _rows():
    rng = np.random.default_rng(11)
    rows = rng.uniform(-1.5, 1.5, (6, 4))
    return [tuple(map(float, row)) for row in [(0.4, 0, 0, 0), (0, 0.3, 0, 0), (0, 0, 0.2, 0), (0, 0, 0, 0.6), *rows]]


def turn_z(angle):
    """Turn about z as a transform (4, 4)."""
    return homogeneous(modelling.rot_z(angle), np.zeros(3))


def turn_x(angle):
    """Turn about x as a transform (4, 4)."""
    return homogeneous(rot_x(angle), np.zeros(3))


def shift(x, y, z):
    """Shift as a transform (4, 4)."""
    return homogeneous(np.eye(3), np.array([x, y, z], dtype=float))


def _dh_symptom(cases, returned, expected):
    T = [np.asarray(one, dtype=float) for one in returned]
    if not all(np.allclose(one[3], [0, 0, 0, 1]) for one in T):
        return "its last row is not (0, 0, 0, 1): a transform needs that row, whatever the motion"
    names = ("theta", "d", "a", "alpha")
    alone = [not np.allclose(T[k], expected[k]) for k in range(4)]
    if any(alone):
        k = alone.index(True)
        return f"with {names[k]} alone it is wrong already (the others 0). Which motion does {names[k]} stand for?"
    return (
        "each motion alone is right, together they are not: their order. Each one happens in the frame that the "
        "motions before it have made"
    )


DH_MATRIX = Task(
    name="dh_matrix",
    notebook="01",
    signature=("theta", "d", "a", "alpha"),
    asks="the transform (4, 4) of one joint with its link: turn about z, shift along z, shift along x, turn about x",
    right=dh_matrix,
    cases=_rows,
    leans_on=("rot_z",),
    loan="""def shift(x, y, z):
    T = np.eye(4)
    T[:3, 3] = [x, y, z]
    return T


def turn_z(angle):
    T = np.eye(4)
    T[:3, :3] = rot_z(angle)
    return T


def turn_x(angle):
    c = np.cos(angle)
    s = np.sin(angle)
    T = np.eye(4)
    T[1:3, 1:3] = [[c, -s], [s, c]]
    return T


def dh_matrix(theta, d, a, alpha):
    joint = turn_z(theta) @ shift(0, 0, d)
    link = shift(a, 0, 0) @ turn_x(alpha)
    return joint @ link""",
    slips=(
        Slip(
            lambda t, d, a, f: dh_matrix(np.radians(t), d, a, np.radians(f)),
            "it hardly turns: theta and alpha come in radians already",
        ),
        Slip(lambda t, d, a, f: dh_matrix(t, d, a, np.radians(f)), "alpha hardly turns: it comes in radians already"),
        Slip(
            lambda t, d, a, f: dh_matrix(f, d, a, t),
            "theta and alpha have changed places: which of them does the motor turn?",
        ),
        Slip(
            lambda t, d, a, f: dh_matrix(t, a, d, f),
            "d and a have changed places: which shift is along z, the joint's own axis?",
        ),
        Slip(
            lambda t, d, a, f: dh_matrix(t, d, a, -f),
            "alpha turns the wrong way round; try alpha alone, with z going towards -y or +y",
        ),
        Slip(lambda t, d, a, f: dh_matrix(-t, d, a, f), "theta turns the wrong way round"),
        Slip(lambda t, d, a, f: dh_matrix(-t, d, a, -f), "both angles turn the wrong way round"),
        Slip(
            lambda t, d, a, f: turn_x(f) @ shift(a, 0, 0) @ turn_z(t) @ shift(0, 0, d),
            "the link's motions come before "
            "the joint's: walk from the base, first turn and lift at the joint, then go along the link",
        ),
        Slip(
            lambda t, d, a, f: shift(a, 0, 0) @ turn_z(t) @ shift(0, 0, d) @ turn_x(f),
            "the link sticks out before the joint has turned: a is along the x axis *after* theta",
        ),
        Slip(
            lambda t, d, a, f: shift(a, 0, d) @ turn_z(t) @ turn_x(f),
            "the link sticks out before the joint has turned: a is along the x axis *after* theta",
        ),
        Slip(
            lambda t, d, a, f: turn_x(t) @ shift(d, 0, 0) @ shift(0, 0, a) @ turn_z(f),
            "x and z have changed places: the joint turns about z, the link lies along x",
        ),
        Slip(lambda t, d, a, f: turn_z(t) @ shift(0, 0, d) @ turn_x(f), "the link has no length: a does nothing in it"),
        Slip(lambda t, d, a, f: turn_z(t) @ shift(a, 0, 0) @ turn_x(f), "nothing is lifted: d does nothing in it"),
        Slip(lambda t, d, a, f: turn_z(t) @ shift(a, 0, d), "the last motion is missing: alpha does nothing in it"),
        Slip(
            lambda t, d, a, f: dh_matrix(t, d, a, f).T,
            "rows and columns have changed places: the shift belongs into the last column",
        ),
        Slip(
            lambda t, d, a, f: np.linalg.inv(dh_matrix(t, d, a, f)),
            "it goes the way back, from the link's end to the joint: its inverse would be right",
        ),
        Slip(
            lambda t, d, a, f: turn_z(t) * shift(a, 0, d) * turn_x(f),
            "it multiplies entry by entry (`*`); motions one after the other are a matrix product (`@`)",
        ),
        Slip(
            lambda t, d, a, f: turn_z(t) * shift(0, 0, d) * shift(a, 0, 0) * turn_x(f),
            "it multiplies entry by entry (`*`); motions one after the other are a matrix product (`@`)",
        ),
        Slip(
            lambda t, d, a, f: dh_matrix(t, d, a, f)[:3, :3],
            "it returns the turn alone, 3 x 3: the shift belongs beside it, 4 x 4",
        ),
        Slip(lambda t, d, a, f: dh_matrix(t, d, a, f)[:3], "it returns three rows; a transform has a fourth"),
    ),
    symptom=_dh_symptom,
    hints=(
        "Write four small matrices first, one a motion: your rot_z in a 4 x 4, two shifts, a turn about x.",
        "Motions in the moving frame are multiplied from the left to the right, in the order in which they happen.",
    ),
)


# ---------------------------------------------------------------------------------------------------------- frames
def frames(q, l):
    """Transforms of frames 0 to 3 as seen from the base, (4, 4, 4)    (1.14)-(1.19)."""
    return np.array(modelling.frames(arm_of(l), q))


def _links(q, l):
    half = np.pi / 2
    return dh_matrix(q[0], l[0], 0, half), dh_matrix(q[1], 0, l[1], 0), dh_matrix(q[2], 0, l[2], -half)


def _chain(*links):
    out = [np.eye(4)]
    for link in links:
        out.append(out[-1] @ link)
    return np.array(out)


def _frames_with(q, l, alphas=(np.pi / 2, 0, -np.pi / 2)):
    return _chain(
        dh_matrix(q[0], l[0], 0, alphas[0]), dh_matrix(q[1], 0, l[1], alphas[1]), dh_matrix(q[2], 0, l[2], alphas[2])
    )


def _reversed_product(q, l):
    A1, A2, A3 = _links(q, l)
    return np.array([np.eye(4), A1, A2 @ A1, A3 @ A2 @ A1])


def _frames_symptom(cases, returned, expected):
    T, right = np.array(returned, dtype=float), np.array(expected)
    if not np.allclose(T[:, 0], np.eye(4)):
        return "the first of the four is the base itself, seen from itself: it never moves. Yours does"
    for k in (1, 2, 3):
        if not np.allclose(T[:, k], right[:, k]):
            where, turn = (
                np.allclose(T[:, k, :3, 3], right[:, k, :3, 3]),
                np.allclose(T[:, k, :3, :3], right[:, k, :3, :3]),
            )
            what = "its axes are wrong, its place is right" if where else "its axes are right, its place is wrong"
            what = what if where or turn else "place and axes are wrong"
            return f"frames 0 to {k - 1} are right, frame {k} is not: {what}. Look at row {k} of the arm's table"
    return ""


FRAMES = Task(
    name="frames",
    notebook="01",
    signature=("q", "l"),
    asks="the four transforms (4, 4, 4) of frames 0 (base) to 3 (tip), each as the base sees it",
    right=frames,
    cases=lambda: some_arms(7, 3),
    leans_on=("dh_matrix", "rot_z"),
    loan="""def frames(q, l):
    A1 = dh_matrix(q[0], l[0], 0, np.pi / 2)
    A2 = dh_matrix(q[1], 0, l[1], 0)
    A3 = dh_matrix(q[2], 0, l[2], -np.pi / 2)
    T0 = np.eye(4)
    T1 = T0 @ A1
    T2 = T1 @ A2
    T3 = T2 @ A3
    return np.array([T0, T1, T2, T3])""",
    slips=(
        Slip(with_degrees(frames), "the joints hardly turn: q comes in radians already"),
        Slip(
            lambda q, l: np.array([np.eye(4), *_links(q, l)]),
            "each link is seen from the link before it, not from the base: chain them",
        ),
        Slip(
            lambda q, l: np.array(_links(q, l)),
            "there are three, each seen from the link before it: the base comes "
            "first, and the others are seen from the base",
        ),
        Slip(lambda q, l: frames(q, l)[1:], "there are three: the base, which never moves, is one of the four"),
        Slip(lambda q, l: frames(q, l)[:3], "there are three: the tip's frame is missing"),
        Slip(lambda q, l: frames(q, l)[3], "it returns the tip's frame alone; all four are asked for"),
        Slip(_reversed_product, "the products are in the wrong order: the link nearest to the base stands on the left"),
        Slip(
            lambda q, l: _frames_with(q, l, (-np.pi / 2, 0, np.pi / 2)),
            "alpha has the wrong sign in rows 1 and 3: lifting the shoulder lowers the arm",
        ),
        Slip(
            lambda q, l: _frames_with(q, l, (-np.pi / 2, 0, -np.pi / 2)),
            "alpha of row 1 has the wrong sign: the "
            "shoulder's axis points to the other side, and lifting lowers the arm",
        ),
        Slip(
            lambda q, l: _frames_with(q, l, (np.pi / 2, 0, np.pi / 2)),
            "frame 3 stands on its head: the sign of alpha in row 3 (the thesis prints this one, too)",
        ),
        Slip(
            lambda q, l: _frames_with(q, l, (np.pi / 2, 0, 0)),
            "alpha of row 3 is missing: the place is right, the axes of frame 3 are not",
        ),
        Slip(
            lambda q, l: _frames_with(q, l, (90, 0, -90)),
            "alpha is given in degrees: 90 rad are fourteen turns and a bit",
        ),
        Slip(
            lambda q, l: _frames_with(q, l, (0, 0, 0)),
            "every alpha is 0: the shoulder turns about the vertical, as the waist does, and the arm stays flat",
        ),
        Slip(
            lambda q, l: _chain(dh_matrix(q[0], 0, l[0], np.pi / 2), *_links(q, l)[1:]),
            "the column lies on the floor: is its height a shift along z or along x?",
        ),
        Slip(
            lambda q, l: _chain(_links(q, l)[0], dh_matrix(q[1], l[1], 0, 0), dh_matrix(q[2], l[2], 0, -np.pi / 2)),
            "upper arm and forearm go sideways, along the joint's axis: which shift is along the link?",
        ),
        Slip(
            lambda q, l: _chain(_links(q, l)[0], _links(q, l)[1], dh_matrix(q[1] + q[2], 0, l[2], -np.pi / 2)),
            "the elbow turns by q2 once more: the chain carries q2 on by itself, row 3 has q3 alone",
        ),
        Slip(lambda q, l: frames(q, (l[0], l[2], l[1])), "upper arm and forearm have changed their lengths"),
        Slip(lambda q, l: frames(q, (0, l[1], l[2])), "the column has no height: l[0] is not used"),
        Slip(
            lambda q, l: frames(q, _LENGTHS[0]),
            "it has the lengths of one arm built in: use l, which changes from arm to arm",
        ),
        Slip(
            lambda q, l: np.array([np.zeros((4, 4)), *frames(q, l)[1:]]),
            "the first one is all zeros: the base seen from itself is the transform that does nothing",
        ),
    ),
    symptom=_frames_symptom,
    hints=(
        "One line a joint: dh_matrix with the row of the arm's table. Then chain them.",
        "T1 = T0 @ A1, T2 = T1 @ A2 ...: each new frame is seen through the one before it.",
    ),
)


# ---------------------------------------------------------------------------------------------- forward_kinematics
def forward_kinematics(q, l):
    """Place of the tip, (3,) m    (1.31 corrected)."""
    return modelling.forward_kinematics(arm_of(l), q)


def _tip(q, l, waist=None, lift2=None, lift3=None):
    a = q[1] if lift2 is None else lift2
    b = q[1] + q[2] if lift3 is None else lift3
    out, up = l[1] * np.cos(a) + l[2] * np.cos(b), l[0] + l[1] * np.sin(a) + l[2] * np.sin(b)
    w = q[0] if waist is None else waist
    return np.array([np.cos(w) * out, np.sin(w) * out, up])


def _printed_tip(q, l):
    x, y, z = forward_kinematics(q, l)
    return np.array([x, np.cos(q[0]) * np.hypot(x, y) * np.sign(x * np.cos(q[0]) or 1), z])


def _tip_symptom(cases, returned, expected):
    p, right = np.array(returned, dtype=float), np.array(expected)
    wrong = [name for k, name in enumerate("xyz") if not np.allclose(p[:, k], right[:, k], atol=1e-9)]
    flat = np.allclose(np.hypot(p[:, 0], p[:, 1]), np.hypot(right[:, 0], right[:, 1]))
    if wrong in (["x", "y"], ["x"], ["y"]) and flat:
        return (
            f"height and distance from the column are right, {' and '.join(wrong)} not: look from above, which way "
            "does the waist face?"
        )
    if 0 < len(wrong) < 3:
        return f"only {' and '.join(wrong)} {'is' if len(wrong) == 1 else 'are'} wrong"
    return ""


FORWARD_KINEMATICS = Task(
    name="forward_kinematics",
    notebook="01",
    signature=("q", "l"),
    asks="the place of the tip (3,), m",
    right=forward_kinematics,
    cases=lambda: some_arms(8, 5),
    leans_on=("frames", "dh_matrix", "rot_z"),
    loan="""def forward_kinematics(q, l):
    T = frames(q, l)
    tip = T[3]
    return tip[:3, 3]""",
    slips=(
        Slip(with_degrees(forward_kinematics), "the joints hardly turn: q comes in radians already"),
        Slip(lambda q, l: frames(q, l)[3], "it returns the whole transform; the place is one column of it"),
        Slip(
            lambda q, l: frames(q, l)[3][:, 3],
            "it returns four numbers: the 1 at the end belongs to the transform, not to the place",
        ),
        Slip(
            lambda q, l: frames(q, l)[3][3, :3],
            "it returns zeros, the last *row* of the transform: the place stands in a column",
        ),
        Slip(
            lambda q, l: frames(q, l)[3][3], "it returns the last *row* of the transform: the place stands in a column"
        ),
        Slip(
            lambda q, l: frames(q, l)[3][:3, 2], "it returns an axis of the tip's frame, not its place: one column off"
        ),
        Slip(lambda q, l: frames(q, l)[3][:3, 0], "it returns an axis of the tip's frame, not its place"),
        Slip(lambda q, l: frames(q, l)[2][:3, 3], "that is the elbow: one frame too early"),
        Slip(lambda q, l: frames(q, l)[1][:3, 3], "that is the shoulder: two frames too early"),
        Slip(
            lambda q, l: frames(q, l)[3][:3, 3] - [0, 0, l[0]],
            "every height is too low by l[0]: measured from the shoulder, not from the table",
        ),
        Slip(
            lambda q, l: _tip(q, l, lift3=q[2]),
            "the forearm is measured from the horizon: q3 is measured from the upper arm, which has its own slope",
        ),
        Slip(lambda q, l: _tip(q, l, waist=0.0), "the waist does nothing: the tip never leaves the plane of q1 = 0"),
        Slip(
            lambda q, l: _tip(q, l, lift3=q[1] - q[2]), "the elbow bends the wrong way: positive q3 lifts the forearm"
        ),
        Slip(lambda q, l: _tip(q, l) * [1, -1, 1], "y has the wrong sign: positive q1 is counter-clockwise from above"),
        Slip(lambda q, l: _tip(q, l)[[1, 0, 2]], "x and y have changed places"),
        Slip(_printed_tip, "only y is wrong, by a cosine where its partner belongs: this is the slip of the thesis"),
        Slip(
            lambda q, l: forward_kinematics(q, (l[0], l[2], l[1])), "upper arm and forearm have changed their lengths"
        ),
        Slip(
            lambda q, l: forward_kinematics(q, _LENGTHS[0]),
            "it has the lengths of one arm built in: use l, which changes from arm to arm",
        ),
        Slip(lambda q, l: 1000 * forward_kinematics(q, l), "it is in millimetres: lengths here are metres"),
    ),
    symptom=_tip_symptom,
    hints=(
        "You have the tip's frame already. What stands where in a transform?",
        "T[3] is 4 x 4; the place is a column.",
    ),
)

TASKS = (ROT_Z, DH_MATRIX, FRAMES, FORWARD_KINEMATICS)
