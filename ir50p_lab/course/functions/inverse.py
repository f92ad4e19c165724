"""The functions of 02: all poses that reach a place, and the one the arm may take."""

import numpy as np

from ir50p_lab import modelling
from ir50p_lab.course.functions.pose import _LENGTHS, arm_of, forward_kinematics, frames
from ir50p_lab.course.functions.task import Slip, Task
from ir50p_lab.errors import UnreachableError

_EDGE = 1e-9  # m: rounding may put a stretched arm's own tip this far outside
_SAME = 1e-6  # rad: near the stretched arm rounding of the place leaves the elbow uncertain by 3e-8


# ---------------------------------------------------------------------------------------------- inverse_kinematics
def inverse_kinematics(p, l):
    """All poses that put the tip on p, (n, 3); n = 0 out of reach    (1.60)-(1.73 corrected)."""
    arm = arm_of(l)
    shoulder = np.array([0, 0, l[0]])
    from_shoulder = np.asarray(p, dtype=float) - shoulder
    r = np.linalg.norm(from_shoulder)
    longest, shortest = l[1] + l[2], abs(l[1] - l[2])
    if not shortest - _EDGE <= r <= longest + _EDGE:
        return np.empty((0, 3))
    if r > 0:
        p = shoulder + from_shoulder * np.clip(r, shortest, longest) / r
    try:
        return np.array(modelling.inverse_kinematics(arm, p).q)
    except UnreachableError:
        return np.empty((0, 3))


def _targets():
    rng = np.random.default_rng(7)
    cases = []
    for k, q in enumerate(rng.uniform([-3, -2, -2.8], [3, 2, 2.8], (14, 3))):
        l = _LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for k, q in enumerate(rng.uniform([-3, -2, 0], [3, 2, 0], (12, 3))):  # stretched: on the edge, but for rounding
        l = _LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for far in ((0.6, 0.3, 0.5), (-0.5, 0.4, 0.6), (0.02, 0.01, 0.3)):
        cases.append((np.array(far), _LENGTHS[0].copy()))
    return cases


def as_poses(value):
    """Poses as rows (n, 3); an empty answer of any shape is (0, 3)."""
    rows = np.asarray(value, dtype=float)
    if rows.size == 0:
        return np.empty((0, 3))
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError("not rows of three angles")
    return rows


def _apart(a, b):
    """Largest joint difference of each pose of a to each of b, whole turns left out."""
    return np.abs(np.angle(np.exp(1j * (a[:, None] - b[None])))).max(axis=2)


def same_poses(returned, expected):
    """Tell whether two lists hold the same poses, in any order; on the edge, where two coincide, one will do."""
    a, b = as_poses(returned), as_poses(expected)
    if len(a) == 0 or len(b) == 0:
        return len(a) == len(b)
    apart = _apart(a, b)
    return bool((apart.min(axis=0) < _SAME).all() and (apart.min(axis=1) < _SAME).all() and len(a) <= len(b))


def _law(p, l, *, up=None, q1=None, inner=False, slope=-1, swap=False, quotient=False, sides=(1, -1), bends=(-1, 1)):
    """Poses by the law of cosines with one step replaced: how students get it wrong."""
    x, y, z = p
    l1, l2, l3 = (l[0], l[2], l[1]) if swap else l
    up = z - l1 if up is None else up
    r = np.sqrt(x * x + y * y + up * up)
    if not abs(l2 - l3) - _EDGE <= r <= l2 + l3 + _EDGE:
        return np.empty((0, 3))
    cosine = np.clip((r * r - l2 * l2 - l3 * l3) / (2 * l2 * l3), -1, 1)
    bend = np.arccos(-cosine if inner else cosine)
    poses = []
    for side in sides:
        waist = np.arctan(y / x) if quotient else np.arctan2(side * y, side * x)
        for sign in bends:
            q3 = sign * bend
            out = side * np.hypot(x, y)
            q2 = np.arctan2(up, out) + slope * np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))
            poses.append([waist if q1 is None else q1, q2, q3])
    return np.array(poses)


def _poses_symptom(cases, returned, expected):
    far = [k for k, one in enumerate(expected) if len(one) == 0]
    answers = []
    for one in returned:
        try:
            answers.append(as_poses(one))
        except (TypeError, ValueError):
            shape = np.shape(one)
            if shape == (3,):
                return (
                    "it returns one pose, three numbers: all poses are asked for, one a row; how many arms does a "
                    "cosine leave you?"
                )
            columns = len(shape) == 2 and shape[0] == 3
            rows = "one pose a *row*, three angles each"
            return f"{rows}: yours stand in columns" if columns else f"{rows}: yours has the shape {shape}"
    for k in far:
        if len(answers[k]):
            if not np.isfinite(answers[k]).all():
                return "out of reach it returns nan: a root of less than nothing. No pose means no row"
            return "a place out of reach gets poses: no pose means no row, np.empty((0, 3))"
    for rows, (p, l) in zip(answers, cases, strict=True):
        for number, q in enumerate(rows):
            off = np.linalg.norm(forward_kinematics(q, l) - p)
            if not off < 1e-6:
                side = " behind the column" if p[0] < 0 else ""
                return (
                    f"not every pose reaches the place: pose {number + 1} of {len(rows)} puts the tip "
                    f"{1000 * off:.0f} mm beside the place{side}. Feed each row to your forward_kinematics"
                )
    edge = [k for k in range(14, 26) if len(answers[k]) == 0]
    if edge and all(len(answers[k]) for k in range(14)):
        return (
            f"{len(edge)} of 12 places on the very edge, where the arm is stretched, count as out of reach: there "
            "rounding makes r a hair too large; allow it 1e-9 m"
        )
    fewer = {len(one) for one in answers[:14]}
    if fewer == {1}:
        return "one pose a place: a cosine leaves two arms, and the waist may turn its back"
    if fewer == {2}:
        faces = [np.cos(one[:, 0] - np.arctan2(p[1], p[0])) for one, (p, _) in zip(answers[:14], cases, strict=False)]
        if max(np.ptp(np.sign(one)) for one in faces) > 0:
            return "two poses a place, one facing it and one with its back to it: the elbow has two ways in each"
        return "two poses a place: the waist may also turn its back, and the arm bends over"
    if 0 in fewer:
        return "a place within reach gets no pose"
    return "poses are missing: some places get fewer than they have"


INVERSE_KINEMATICS = Task(
    name="inverse_kinematics",
    notebook="02",
    signature=("p", "l"),
    asks="all poses (n, 3) rad that put the tip on p (m), one a row; no row if p is out of reach",
    right=inverse_kinematics,
    cases=_targets,
    leans_on=("forward_kinematics", "frames", "dh_matrix", "rot_z"),
    same=same_poses,
    loan="""def inverse_kinematics(p, l):
    x, y, z = p
    l1, l2, l3 = l
    up = z - l1
    r = np.sqrt(x**2 + y**2 + up**2)
    if r > l2 + l3 + 1e-9 or r < abs(l2 - l3) - 1e-9:
        return np.empty((0, 3))
    cosine = (r**2 - l2**2 - l3**2) / (2 * l2 * l3)
    bend = np.arccos(np.clip(cosine, -1, 1))
    poses = []
    for side in [1, -1]:
        q1 = np.arctan2(side * y, side * x)
        out = side * np.hypot(x, y)
        for q3 in [bend, -bend]:
            slope = np.arctan2(up, out)
            between = np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))
            poses.append([q1, slope - between, q3])
    return np.array(poses)""",
    slips=(
        Slip(lambda p, l: np.degrees(inverse_kinematics(p, l)), "the angles are in degrees: everything here is rad"),
        Slip(
            lambda p, l: _law(p, l, up=p[2]),
            "every pose misses by the height of the column: from where does the triangle measure its height?",
        ),
        Slip(
            lambda p, l: _law(p, l, up=p[2] + l[0]),
            "every pose misses by twice the height of the column: above the shoulder means less than above the table",
        ),
        Slip(
            lambda p, l: _law(p, l, inner=True),
            "the elbow has the angle *inside* the triangle: q3 is 0 when the arm "
            "is straight, and then that angle is half a turn",
        ),
        Slip(
            lambda p, l: _law(p, l, slope=1),
            "the tip misses with both elbows: the two angles of the shoulder go "
            "together the wrong way round. Which one bends the arm down when the elbow points up?",
        ),
        Slip(lambda p, l: _law(p, l, swap=True), "upper arm and forearm have changed their lengths"),
        Slip(
            lambda p, l: _law(p, l, quotient=True, sides=(1,)),
            "places behind the column are missed, the others are right: a quotient y/x is the same in front and behind",
        ),
        Slip(
            lambda p, l: _law(p, l, quotient=True),
            "places are missed, some in front and some behind the column: a "
            "quotient y/x cannot tell the two sides apart",
        ),
        Slip(
            lambda p, l: _law(p, l, sides=(1,), bends=(1,)),
            "one pose a place, its elbow below: a cosine leaves two arms, and the waist may turn its back",
        ),
        Slip(
            lambda p, l: _law(p, l, sides=(1,), bends=(-1,)),
            "one pose a place, its elbow above: a cosine leaves two arms, and the waist may turn its back",
        ),
        Slip(lambda p, l: inverse_kinematics(p, l)[:, ::-1], "the angles stand in the wrong order: q1, q2, q3"),
        Slip(
            lambda p, l: inverse_kinematics(p, l) * [-1, 1, 1], "the waist turns the wrong way: q1 has the wrong sign"
        ),
        Slip(
            lambda p, l: inverse_kinematics(p, l) * [1, -1, 1],
            "the shoulder turns the wrong way: q2 has the wrong sign",
        ),
        Slip(
            lambda p, l: inverse_kinematics(p, _LENGTHS[0]),
            "it has the lengths of one arm built in: use l, which changes from arm to arm",
        ),
    ),
    symptom=_poses_symptom,
    hints=(
        "First the pose with the elbow up, facing the place. Does your forward_kinematics bring it back to p?",
        "The angle between r and the upper arm: draw the perpendicular from the tip onto the line of the upper arm. "
        "Both sides of that small triangle are easy, and arctan2 knows the quadrant.",
    ),
)


# ----------------------------------------------------------------------------------------------------------- reach
def reach(p, l, q_now, limits):
    """The allowed pose that puts the tip on p with the smallest largest turn from q_now, (3,) or None."""
    return _chosen(p, l, q_now, limits)


def _chosen(p, l, q_now, limits, *, turn=None, allowed=None, last=False):
    turn = turn or (lambda q: np.abs(q - q_now).max())
    allowed = allowed or (lambda q: within(q, limits) and above_table(q, l))
    best = [q for q in inverse_kinematics(p, l) if allowed(q)]
    if not best:
        return None
    return best[-1] if last else min(best, key=turn)


def _in_degrees(q):
    return None if q is None else np.degrees(q)


def within(q, limits):
    """Tell whether every joint keeps its limits."""
    return bool((q >= limits[0]).all() and (q <= limits[1]).all())


def above_table(q, l, parts=(2, 3)):
    """Tell whether elbow and tip (frames 2 and 3) are not below the table."""
    heights = frames(q, l)[list(parts), 2, 3]
    return bool((heights >= -1e-9).all())


def _reach_cases():
    from ir50p_lab.modelling import IR50P

    rng = np.random.default_rng(21)
    limits = np.array([IR50P.q_min, IR50P.q_max])
    wide = np.array([[-3.1, -3.1, -3.1], [3.1, 3.1, 3.1]])
    l = _LENGTHS[0]
    cases = [(np.array([0.42, -0.15, 0.09]), l.copy(), np.array([0, 0.3, -0.6]), limits.copy())]
    while len(cases) < 60:
        bounds = limits if len(cases) % 2 else wide
        p = forward_kinematics(rng.uniform(*bounds), l)
        if p[2] > 0:
            cases.append((p, l.copy(), rng.uniform(*limits), bounds.copy()))
    near = np.array([0.5, -0.5, 1.5])  # the elbow is below the table, the tip above
    elbow_low = forward_kinematics(near, _LENGTHS[2])
    narrow = np.array([near - 0.1, near + 0.1])
    cases.append((elbow_low, _LENGTHS[2].copy(), near, narrow))
    cases.append((np.array([0.3, 0.2, -0.05]), l.copy(), np.zeros(3), wide.copy()))
    cases.append((np.array([0.9, 0, 0.2]), l.copy(), np.zeros(3), wide.copy()))
    return cases


def _same_pose(returned, expected):
    if returned is None or expected is None:
        return returned is None and expected is None
    returned = np.asarray(returned, dtype=float)
    return returned.shape == (3,) and bool(np.abs(returned - expected).max() < _SAME)


def _reach_symptom(cases, returned, expected):
    for (p, l, _, limits), one, right in zip(cases, returned, expected, strict=True):
        if one is None:
            if right is not None:
                return "it says None although there is an allowed pose"
            continue
        q = np.asarray(one, dtype=float)
        if q.shape != (3,):
            return f"it returns something of shape {q.shape}: one pose, three angles, or None"
        if right is None and np.linalg.norm(p - [0, 0, l[0]]) > l[1] + l[2]:
            return "a place out of reach gets a pose: no pose means None"
        if not within(q, limits):
            joint = int(np.argmax((q < limits[0]) | (q > limits[1])))
            return (
                f"it takes a pose that the arm may not: joint {joint + 1} would stand at {q[joint]:.2f} rad, "
                f"allowed are {limits[0][joint]:.2f} to {limits[1][joint]:.2f}"
            )
        if not above_table(q, l):
            part = "elbow" if frames(q, l)[2][2, 3] < -1e-9 else "tip"
            return f"it takes a pose whose {part} is below the table: elbow and tip have to stay above, z >= 0"
    return "the poses are allowed, but another allowed one turns its busiest joint less: compare the largest turns"


REACH = Task(
    name="reach",
    notebook="02",
    signature=("p", "l", "q_now", "limits"),
    asks="the allowed pose (3,) for p whose largest joint turn from q_now is smallest, elbow and tip above the table; "
    "None if there is none",
    right=reach,
    cases=_reach_cases,
    leans_on=("inverse_kinematics", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    same=_same_pose,
    loan="""def reach(p, l, q_now, limits):
    best = None
    smallest = np.inf
    for q in inverse_kinematics(p, l):
        allowed = np.all(q >= limits[0]) and np.all(q <= limits[1])
        heights = frames(q, l)[2:, 2, 3]
        clear = np.all(heights >= -1e-9)
        turn = np.max(np.abs(q - q_now))
        if allowed and clear and turn < smallest:
            best = q
            smallest = turn
    return best""",
    slips=(
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: np.abs(x - q).sum()),
            "it takes the pose with the smallest *sum* of turns; all joints move at once, so the busiest one counts",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: ((x - q) ** 2).sum()),
            "it takes the pose with the "
            "smallest *length* of the turn (the root of squares); all joints move at once, so the busiest one counts",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: -np.abs(x - q).max()),
            "it takes the allowed pose that is farthest away",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: np.abs(x).max()),
            "it takes the pose nearest to zero, not to where the arm is now",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: (x - q).max()),
            "a turn to the other side counts as less than none: its size is what takes time",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: abs(x[0] - q[0])), "only the waist's turn is compared"
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, turn=lambda x: 0), "it takes the first allowed pose, not the nearest"
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, last=True),
            "it takes the last allowed pose, not the nearest: is `smallest` kept up to date?",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, allowed=lambda x: True),
            "neither limits nor table are asked: what is nearest may be forbidden",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, allowed=lambda x: above_table(x, l)),
            "the limits are not asked: the nearest pose may be forbidden",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, allowed=lambda x: within(x, m)),
            "the table is not asked: an elbow or tip may end below z = 0",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, allowed=lambda x: within(x, m) and above_table(x, l, (3,))),
            "the tip stays above the table, the elbow does not: it counts, too",
        ),
        Slip(
            lambda p, l, q, m: _chosen(p, l, q, m, allowed=lambda x: within(x, m) and above_table(x, l, (2,))),
            "the elbow stays above the table, the tip does not: it counts, too",
        ),
        Slip(
            lambda p, l, q, m: _chosen(
                p, l, q, m, allowed=lambda x: bool((x >= m[0]).any() and (x <= m[1]).any()) and above_table(x, l)
            ),
            "one joint within its limits is enough for it: *every* joint has to keep them",
        ),
        Slip(lambda p, l, q, m: _in_degrees(_chosen(p, l, q, m)), "the angles are in degrees: everything here is rad"),
    ),
    symptom=_reach_symptom,
    hints=(
        "Go through the rows of your inverse_kinematics and strike out what is not allowed: limits, elbow, tip.",
        "Of those that are left: how far has each joint to turn, which of the three turns most, and in which row is "
        "that least?",
    ),
)

TASKS = (INVERSE_KINEMATICS, REACH)
