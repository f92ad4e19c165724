"""The functions of 00 and 01: turning about z, the DH matrix, the frames of the arm, its tip."""

import numpy as np

from ir50p_lab import modelling
from ir50p_lab.course.functions.task import Mistake, Task
from ir50p_lab.modelling.pose import homogeneous, rot_x, rot_y

_TURNS = {"x": rot_x, "y": rot_y, "z": modelling.rot_z}
_LENGTHS = np.array([[0.285, 0.2, 0.372], [0.3, 0.25, 0.15], [0.0, 1.0, 0.8]])


def some_arms(count, seed):
    """Cases (q, l): poses of three arms, the first at rest."""
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-2.0, 2.0, (count, 3))
    return [(q, _LENGTHS[k % 3].copy()) for k, q in enumerate([np.zeros(3), *poses])]


# ----------------------------------------------------------------------------------------------------------- rot_z
def rot_z(angle):
    """Turn about z by an angle (rad), (3, 3)    (1.4)."""
    return modelling.rot_z(angle)


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
        Mistake(lambda a: rot_z(a).T,
                "it turns the wrong way round: a quarter turn takes (1, 0, 0) to (0, -1, 0), to the "
                "right. Which way is counter-clockwise seen from above?"),
        Mistake(lambda a: np.column_stack([rot_z(a)[:, 0], rot_z(a + 90)[:, 0], [0, 0, 1]]),
                "column 2 is turned on by 90, and here that is 90 rad: how many rad are a quarter turn?"),
    ),
    symptom=_rot_z_symptom,
    hints=(
        "Where does (1, 0, 0) go when the waist turns by the angle? Draw it from above. That is the first column.",
        "Where does (0, 1, 0) go? It stays a right angle ahead of the first. And (0, 0, 1)?",
    ),
)  # fmt: skip


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


def _other_motions():
    """Slips: one of the four motions goes along or about another axis."""
    turns = {axis: lambda angle, turn=turn: homogeneous(turn(angle), np.zeros(3)) for axis, turn in _TURNS.items()}
    shifts = {axis: lambda by, unit=unit: shift(*(by * unit)) for axis, unit in zip("xyz", np.eye(3), strict=True)}
    for k, (name, right, motions) in enumerate(
        (("theta", "z", turns), ("d", "z", shifts), ("a", "x", shifts), ("alpha", "x", turns))
    ):
        verb = "turns about" if motions is turns else "shifts along"
        for axis in "xyz".replace(right, ""):

            def wrong(*row, k=k, other=motions[axis]):
                steps = [turn_z(row[0]), shift(0, 0, row[1]), shift(row[2], 0, 0), turn_x(row[3])]
                steps[k] = other(row[k])
                return np.linalg.multi_dot(steps)

            yield Mistake(
                wrong, f"{name} {verb} {axis}: which axis is {'the joint' if right == 'z' else 'the link'}'s?"
            )


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
        Mistake(lambda t, d, a, f: dh_matrix(np.radians(t), d, a, np.radians(f)),
                "it hardly turns: theta and alpha come in radians already"),
        Mistake(lambda t, d, a, f: dh_matrix(-t, d, a, -f), "both angles turn the wrong way round"),
        Mistake(lambda t, d, a, f: turn_x(f) @ shift(a, 0, 0) @ turn_z(t) @ shift(0, 0, d),
                "the link's motions come before "
                "the joint's: walk from the base, first turn and lift at the joint, then go along the link"),
        Mistake(lambda t, d, a, f: shift(a, 0, d) @ turn_z(t) @ turn_x(f),
                "the link sticks out before the joint has turned: a is along the x axis *after* theta"),
        Mistake(lambda t, d, a, f: turn_z(t) @ shift(a, 0, 0) @ turn_x(f) @ shift(0, 0, d),
                "d comes after the tilt: the joint lifts along its own axis, before the link tilts it"),
        Mistake(lambda t, d, a, f: turn_z(t) @ shift(a, 0, d).T @ turn_x(f),
                "a shift stands in the bottom row: what a point is moved by belongs into the last column"),
        Mistake(lambda t, d, a, f: turn_x(t) @ shift(a, 0, d) @ turn_z(f),
                "theta turns about x and alpha about z: they have changed axes"),
        Mistake(lambda t, d, a, f: dh_matrix(t, d, a, t),
                "alpha does nothing in it, and theta turns twice, about z and about x"),
        Mistake(lambda t, d, a, f: shift(a, 0, 0) @ turn_x(f),
                "theta and d do nothing in it: is what they make left out of the product, or written over?"),
        Mistake(lambda t, d, a, f: dh_matrix(t, d, a, f) @ np.diag([1, 1, 1, 0]),
                "the 1 at the lower right is 0, and both shifts are lost with it: is a turn put into zeros?"),
        Mistake(lambda t, d, a, f: turn_z(t) @ (shift(0, 0, d) + shift(a, 0, 0)) @ turn_x(f),
                "two matrices are added: one motion after another is a product"),
        Mistake(lambda t, d, a, f: dh_matrix(t, 0, 2 * a, f), "d does nothing in it and a counts twice"),
        Mistake(lambda t, d, a, f: dh_matrix(t, 2 * d, 0, f), "a does nothing in it and d counts twice"),
        *_other_motions(),
    ),
    symptom=_dh_symptom,
    hints=(
        "Write four small matrices first, one a motion: your rot_z in a 4 x 4, two shifts, a turn about x.",
        "Motions in the moving frame are multiplied from the left to the right, in the order in which they happen.",
    ),
)  # fmt: skip


# ---------------------------------------------------------------------------------------------------------- frames
def frames(q, l):
    """Transforms of frames 0 to 3 as seen from the base, (4, 4, 4)    (1.14)-(1.19)."""
    return _chain(*_links(q, l))  # any lengths: a mistake may hand over others


def _links(q, l, alphas=(1, 0, -1), step=dh_matrix):
    a1, a2, a3 = np.pi / 2 * np.array(alphas)
    q1, q2, q3 = np.moveaxis(np.asarray(q), -1, 0)
    return step(q1, l[0], 0, a1), step(q2, 0, l[1], a2), step(q3, 0, l[2], a3)


def _lying(q, l):
    """The links with d and a exchanged."""
    return _links(q, l, step=lambda t, d, a, f: dh_matrix(t, a, d, f))


def _chain(*links):
    out = [np.broadcast_to(np.eye(4), links[0].shape)]
    for link in links:
        out.append(out[-1] @ link)
    return np.stack(out, axis=-3)


def _frames_symptom(cases, returned, expected):
    T, right = np.array(returned, dtype=float), np.array(expected)
    if np.allclose(T, T[:, :1]):
        return "all four are the same: is one array changed again and again, and put into the list each time?"
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
    notebook="01",
    signature=("q", "l"),
    asks="the four transforms (4, 4, 4) of frames 0 (base) to 3 (tip), each as the base sees it",
    right=frames,
    cases=lambda: some_arms(7, 3),
    leans_on=("dh_matrix", "rot_z"),
    routes=(_BY_TABLE,),
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
        Mistake(lambda q, l: np.array([np.eye(4), *_links(q, l)]),
                "each link is seen from the link before it, not from the base: chain them"),
        Mistake(lambda q, l: np.array(_links(q, l)),
                "there are three, each seen from the link before it: the base comes "
                "first, and the others are seen from the base"),
        Mistake(lambda q, l: np.array([*frames(q, l)[:3], _chain(*_links(q, l)[1:])[2]]),
                "frame 3 goes back two links only: the first is missing in it"),
        *(
            Mistake(lambda q, l, rows=rows: _chain(*((_lying if k in rows else _links)(q, l)[k] for k in range(3))),
                    f"d and a have changed places in {where}: in the table, or where it is read?")
            for where, rows in (("every row", range(3)), *((f"row {k + 1} alone", (k,)) for k in range(3)))
        ),
        *(
            Mistake(lambda q, l, alphas=alphas: _chain(*_links(q, l, alphas)), says)
            for says, alphas in (
                ("alpha has the wrong sign in rows 1 and 3: lifting the shoulder lowers the arm", (-1, 0, 1)),
                ("alpha of row 1 has the wrong sign: the shoulder's axis points to the other side", (-1, 0, -1)),
                ("frame 3 stands on its head: the sign of alpha in row 3 (the thesis prints this one, too)", (1, 0, 1)),
                ("alpha of row 3 is missing: the place is right, the axes of frame 3 are not", (1, 0, 0)),
                ("alpha of row 1 is missing: the shoulder turns about the vertical", (0, 0, -1)),
                ("every alpha is 0: the shoulder turns about the vertical, and the arm stays flat", (0, 0, 0)),
                ("alpha is given in degrees: 90 rad are fourteen turns and a bit", (180 / np.pi, 0, -180 / np.pi)),
            )
        ),
    ),
    symptom=_frames_symptom,
    hints=(
        "One line a joint: dh_matrix with the row of the arm's table. Then chain them.",
        "T1 = T0 @ A1, T2 = T1 @ A2 ...: each new frame is seen through the one before it.",
    ),
)  # fmt: skip


# ---------------------------------------------------------------------------------------------- forward_kinematics
def forward_kinematics(q, l):
    """Place of the tip, (3,) m    (1.31 corrected)."""
    return frames(q, l)[..., 3, :3, 3]  # not the compiled one: numba takes a second to come


_BY_SINE_AND_COSINE = """def forward_kinematics(q, l):
    q1, q2, q3 = q
    l1, l2, l3 = l
    outwards = l2 * np.cos(q2) + l3 * np.cos(q2 + q3)
    height = l1 + l2 * np.sin(q2) + l3 * np.sin(q2 + q3)
    return np.array([outwards * np.cos(q1), outwards * np.sin(q1), height])"""


FORWARD_KINEMATICS = Task(
    name="forward_kinematics",
    notebook="01",
    signature=("q", "l"),
    asks="the place of the tip (3,), m",
    right=forward_kinematics,
    cases=lambda: some_arms(8, 5),
    leans_on=("frames", "dh_matrix", "rot_z"),
    parts=("x", "y", "z"),
    routes=(_BY_SINE_AND_COSINE,),
    loan="""def forward_kinematics(q, l):
    T = frames(q, l)
    tip = T[3]
    return tip[:3, 3]""",
    slips=(
        Mistake(
            lambda q, l: np.zeros(3),
            "it returns zeros: the place of the base itself, or a *row* of the transform; the place stands in a column",
        ),
        Mistake(
            lambda q, l: np.linalg.inv(frames(q, l)[3])[:3, 3], "that is the base as the tip sees it: no inverse here"
        ),
        Mistake(lambda q, l: frames(q, l)[2, :3, 3], "it is the place of the elbow, not that of the tip"),
        *(
            Mistake(
                lambda q, l, k=k: np.linalg.solve(frames(q, l)[k], frames(q, l)[3])[:3, 3],
                f"it is the tip as frame {k} sees it, at the {where} of the arm: the base has to see it",
            )
            for k, where in ((2, "elbow"), (1, "shoulder"))
        ),
        Mistake(lambda q, l: forward_kinematics(q, l) - [0, 0, l[0]], "the height is counted from the shoulder"),
        Mistake(
            lambda q, l: np.linalg.multi_dot(frames(q, l))[:3, 3],
            "the frames are multiplied once more: each is seen from the base already",
        ),
        Mistake(
            lambda q, l: frames(q, l)[:, :3, 3].sum(axis=0),
            "the places of the frames are added up: each is counted from the base already",
        ),
        *(
            Mistake(
                lambda q, l, turn=turn: turn(frames(q, l)[3, :3, :3]) @ forward_kinematics(q, l),
                "the place is turned by the frame's axes once more: it is in those of the base already",
            )
            for turn in (np.asarray, np.transpose)
        ),
    ),
    hints=(
        "You have the tip's frame already. What stands where in a transform?",
        "T[3] is 4 x 4; the place is a column.",
    ),
)  # fmt: skip

TASKS = (ROT_Z, DH_MATRIX, FRAMES, FORWARD_KINEMATICS)
