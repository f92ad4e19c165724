"""The functions of 02: all poses that reach a place, and the one the arm may take."""

import numpy as np

from ir50p_lab.course.checking.task import Mistake, Task, mistakes, shown, table, text_of, wrong_one
from ir50p_lab.course.kinematics.functions.pose import _LENGTHS, forward_kinematics, frames

_SAME = 1e-5  # rad: near the stretched arm rounding of the place leaves the elbow uncertain by 3e-8, 2e-6 degrees


# ---------------------------------------------------------------------------------------------- inverse_kinematics
def inverse_kinematics(p, l):
    """All poses that put the tip on p, (n, 3); n = 0 out of reach    (1.60)-(1.73 corrected)."""
    x, y, z = p
    l1, l2, l3 = l
    height = z - l1
    r = np.sqrt(x**2 + y**2 + height**2)
    if r > l2 + l3 + 1e-9 or r < abs(l2 - l3) - 1e-9:
        return np.empty((0, 3))
    cosine = (r**2 - l2**2 - l3**2) / (2 * l2 * l3)
    bend = np.arccos(np.clip(cosine, -1, 1))
    poses = []
    for side in [1, -1]:
        waist = np.arctan2(side * y, side * x)
        distance_outwards = side * np.hypot(x, y)
        for elbow in [-bend, bend]:
            slope = np.arctan2(height, distance_outwards)
            angle_between = np.arctan2(l3 * np.sin(elbow), l2 + l3 * np.cos(elbow))
            turn = slope - angle_between
            shoulder = np.arctan2(np.sin(turn), np.cos(turn))
            poses.append([waist, shoulder, elbow])
    return np.array(poses)


def _targets():
    rng = np.random.default_rng(7)
    cases = []
    for k, q in enumerate(rng.uniform([-3, -2, -2.8], [3, 2, 2.8], (14, 3))):
        l = _LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for k, q in enumerate(rng.uniform([-3, -2, 0], [3, 2, 0], (12, 3))):  # stretched: on the edge, but for rounding
        l = _LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for direction in rng.normal(size=(3, 3)):
        for l in _LENGTHS[:2]:
            for r in (l[1] + l[2], abs(l[1] - l[2])):
                for step in (-1e-6, -0.5e-9, 0.5e-9, 1e-6):
                    p = np.array([0, 0, l[0]]) + (r + step) * direction / np.linalg.norm(direction)
                    cases.append((p, l.copy()))
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
    number = len(a) <= len(b) if _straight(b) else len(a) == len(b)
    return bool((apart.min(axis=0) < _SAME).all() and (apart.min(axis=1) < _SAME).all() and number)


def _straight(poses):
    """Tell whether the arm is stretched or folded flat, where its two elbows are one."""
    return np.abs(np.sin(poses[:, 2])).max() < 1e-2


def _poses_symptom(cases, returned, expected):
    answers = []
    for one in returned:
        if one is None:
            return "out of reach it returns None: no pose means no row, an empty array"
        try:
            answers.append(as_poses(one))
        except (TypeError, ValueError):
            return _no_rows(np.shape(one))
    if undefined := [k for k, rows in enumerate(answers) if not np.isfinite(rows).all()]:
        edge = all(len(expected[k]) for k in undefined)
        where = "on the very edge, by a rounding error of the place" if edge else "out of reach"
        return f"it returns nan {where}: a root of less than nothing, an arccos of more than 1"
    directions = np.exp(1j * np.concatenate(answers))[..., None]
    if len(np.unique(directions)) > 1 and np.isclose(directions, np.exp(1j * np.arange(-6, 7))).any(axis=-1).all():
        return "its angles are whole numbers: an array of integers cuts off what is put into it"
    says = next(filter(None, map(_missing_pose, answers, cases, expected)), "")
    far = [k for k, one in enumerate(expected) if len(one) == 0 and len(answers[k])]
    if says or far:
        return says or "a place out of reach gets poses: no pose means no row, an empty array"
    refused = [k for k in range(len(cases)) if len(expected[k]) and not len(answers[k])]
    inside = [k for k, one in enumerate(expected) if len(one) and not _straight(one)]
    if says := _fewer(*([many[k] for k in inside] for many in (answers, cases, expected))):
        return says
    if refused:
        return (
            f"{len(refused)} places on the very edge, where the arm is stretched, count as out of reach: there "
            "rounding makes r a hair too large; allow r 1e-9 m"
        )
    return ""


def _whole_turns(poses):
    """Which angle is a whole turn too far: right in the picture, but limits would strike it out."""
    for number, q in enumerate(as_poses(poses)):
        for angle, name in zip(q, ("waist", "shoulder", "elbow"), strict=True):
            if abs(angle) > np.pi + 1e-9:
                same = np.angle(np.exp(1j * angle))
                return (
                    f"the {name} of pose {number + 1} is {angle:.1f} rad: the same pose is {same:.1f} rad; a whole "
                    "turn is 2 pi, and every angle belongs between -pi and pi, where the limits are"
                )
    return ""


_WHERE = (  # some of the poses: in words, and what tells them in the solution
    ("", "True"),
    (" in the poses with their back to the place", "side < 0"),
    (" where x < 0", "x < 0"),
    (" where y < 0", "y < 0"),
    (" wherever it is beyond a quarter turn", "abs(waist) > np.pi / 2"),
    (" with the elbow up", "elbow < 0"),
    (" with the elbow down", "elbow > 0"),
)


def _mistakes():
    """The mistakes of the table; where a sentence leaves room for it, made in some of the poses only, too."""
    for says, changes in table("inverse_kinematics", __file__):
        for words, where in _WHERE if "{}" in says else ():
            pose, bent = changes[0].split("  ->  ")
            some = f"{pose} -> {bent} if {where} else {pose}"
            yield Mistake(wrong_one(inverse_kinematics, [some]), says.format(words))
        if "{}" not in says:
            yield Mistake(wrong_one(inverse_kinematics, changes), says)


def _no_rows(shape):
    if shape == (3,):
        return (
            "it returns one pose, three numbers: all poses are asked for, one a row; how many arms does a cosine "
            "leave you?"
        )
    columns = len(shape) == 2 and shape[0] == 3
    return "one pose a *row*, three angles each: yours " + ("stand in columns" if columns else f"has the shape {shape}")


def _missing_pose(rows, case, right):
    """What is wrong in the first pose that does not reach the place."""
    p, l = case
    for number, q in enumerate(rows):
        off = np.linalg.norm(forward_kinematics(q, l) - p)
        if off < 1e-5 or not len(right):
            continue
        back = "its back to" if np.cos(q[0] - np.arctan2(p[1], p[0])) < 0 else "facing"
        says = f"pose {number + 1} of {len(rows)}, {back} the place, puts the tip {1000 * off:.0f} mm beside it"
        wrong = np.abs(np.angle(np.exp(1j * (q - right)))) > _SAME
        most = wrong[np.argmin(wrong.sum(axis=1))]
        names = [f"the {name}" for name, is_wrong in zip(("waist", "shoulder", "elbow"), most, strict=True) if is_wrong]
        return f"{says}; what is wrong: {' and '.join(names)}"
    return ""


def _fewer(answers, cases, expected):
    """Which poses of a place within reach are left out."""
    bends = [np.abs(one[:, 2]).max() for one in expected]
    if refused := [bend for bend, one in zip(bends, answers, strict=True) if not len(one)]:
        if min(refused) > max([2.0, *(bend for bend, one in zip(bends, answers, strict=True) if len(one))]):
            return (
                f"places get no pose where the elbow bends by {min(refused):.1f} rad or more: too near the shoulder, "
                "or are limits asked? Those come later, in `reach`"
            )
        return "a place within reach gets no pose"
    single = [np.unique(np.round(one, 6), axis=0) for one in answers]
    if any(len(one) < len(other) for one, other in zip(single, answers, strict=True)):
        return "the same pose comes twice: are the rows copies of one list, or is one branch written down again?"
    counts = {len(one) for one in single}
    if counts == {1}:
        return "one pose a place: a cosine leaves two arms, and the waist may turn its back"
    if counts == {2}:
        waists = [one[:, 0] - np.arctan2(p[1], p[0]) for one, (p, _) in zip(single, cases, strict=False)]
        if all((np.cos(waist) < 0).all() for waist in waists):
            return "two poses a place, all with their back to it: is the list emptied in each round, or one side lost?"
        if any(np.ptp(np.sign(np.cos(waist))) > 0 for waist in waists):
            return "two poses a place, one facing it and one with its back to it: the elbow has two ways in each"
        return "two poses a place, all on one side: the waist may also turn its back, and the arm bends over"
    if counts == {3}:
        return "three poses a place: two elbows facing it, two with the back to it"
    if counts <= {4}:
        return ""
    return "some places get fewer poses than others: are some struck out? Limits come later, in `reach`"


_BY_THE_TRIANGLE = """def inverse_kinematics(p, l):
    x, y, z = p
    l1, l2, l3 = l
    waist = np.arctan2(y, x)
    out = np.hypot(x, y)
    up = z - l1
    r = np.hypot(out, up)
    if r > l2 + l3 + 1e-9 or r < abs(l2 - l3) - 1e-9:
        return np.empty((0, 3))
    cosine = (l2**2 + l3**2 - r**2) / (2 * l2 * l3)
    bend = np.pi - np.arccos(np.clip(cosine, -1, 1))
    poses = []
    for q3 in [-bend, bend]:
        beta = np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))
        poses.append([waist, np.arctan2(up, out) - beta, q3])
        poses.append([waist + np.pi, np.arctan2(up, -out) - beta, q3])
    poses = np.array(poses)
    return np.arctan2(np.sin(poses), np.cos(poses))"""


INVERSE_KINEMATICS = Task(
    name="inverse_kinematics",
    asks="all poses (n, 3) rad that put the tip on p (m), one a row; no row if p is out of reach",
    right=inverse_kinematics,
    cases=_targets,
    leans_on=("forward_kinematics", "frames", "dh_matrix", "rot_z"),
    same=same_poses,
    loan=text_of(inverse_kinematics),
    parts=("q1", "q2", "q3"),
    routes=(_BY_THE_TRIANGLE,),
    slips=tuple(_mistakes()),
    symptom=_poses_symptom,
    form=_whole_turns,
    hints=(
        "First the pose with the elbow up, facing the place. Does your forward_kinematics bring it back to p?",
        "The angle between r and the upper arm: draw the perpendicular from the tip onto the line of the upper arm. "
        "Both sides of that small triangle are easy, and arctan2 knows the quadrant.",
    ),
)  # fmt: skip


# ----------------------------------------------------------------------------------------------------------- reach
def reach(p, l, q_now, limits):
    """The allowed pose that puts the tip on p with the smallest largest turn from q_now, (3,) or None."""
    best = None
    smallest = np.inf
    for pose in inverse_kinematics(p, l):
        within_limits = np.all(pose >= limits[0]) and np.all(pose <= limits[1])
        heights = frames(pose, l)[2:, 2, 3]
        above_table = np.all(heights >= -1e-9)
        turn = np.max(np.abs(pose - q_now))
        if within_limits and above_table and turn < smallest:
            best = pose
            smallest = turn
    return best


def within(q, limits):
    """Tell whether every joint keeps its limits."""
    return bool((q >= limits[0]).all() and (q <= limits[1]).all())


def above_table(q, l):
    """Tell whether elbow and tip (frames 2 and 3) are not below the table."""
    return bool((frames(q, l)[2:, 2, 3] >= -1e-9).all())


def allowed(q, l, limits):
    """Tell whether a pose keeps the limits and stays above the table."""
    return within(q, limits) and above_table(q, l)


def _reach_cases():
    from ir50p_lab.modelling import IR50P

    rng = np.random.default_rng(21)
    limits = np.array([IR50P.q_min, IR50P.q_max])
    wide = np.array([[-3.1, -3.1, -3.1], [3.1, 3.1, 3.1]])
    l = _LENGTHS[0]
    cases = [(np.array([0.42, -0.15, 0.09]), l.copy(), np.array([0, 0.3, -0.6]), limits.copy())]
    while len(cases) < 40:
        bounds = limits if len(cases) % 2 else wide
        p = forward_kinematics(rng.uniform(*bounds), l)
        if p[2] > 0:
            cases.append((p, l.copy(), rng.uniform(*limits), bounds.copy()))
    for joint in range(3):  # the nearest pose breaks one limit alone
        for side, step in ((0, 0.05), (1, -0.05)):
            for q in rng.uniform([-2, 0.2, -1.5], [2, 1, 1.5], (3, 3)):
                bounds = wide.copy()
                bounds[side, joint] = q[joint] + step
                cases.append((forward_kinematics(q, l), l.copy(), q, bounds))
    near = np.array([0.5, -0.5, 1.5])  # the elbow is below the table, the tip above
    elbow_low = forward_kinematics(near, _LENGTHS[2])
    narrow = np.array([near - 0.1, near + 0.1])
    cases.append((elbow_low, _LENGTHS[2].copy(), near, narrow))
    cases.append((np.array([0.3, 0.2, -0.05]), l.copy(), np.zeros(3), wide.copy()))
    cases.append((np.array([0.9, 0, 0.2]), l.copy(), np.zeros(3), wide.copy()))
    for q in rng.uniform([-1.5, 0.2, -1.5], [1.5, 1, -0.5], (3, 3)):  # the nearest pose breaks all limits
        p = forward_kinematics(q, l)
        farthest = max(inverse_kinematics(p, l), key=lambda pose, q=q: np.abs(pose - q).min())
        cases.append((p, l.copy(), q, np.array([farthest - 0.1, farthest + 0.1])))
    for q in rng.uniform([-1, 0.2, -2], [1, 1.2, -1], (8, 3)):  # on the table, but for rounding
        p = forward_kinematics(q, l)
        p[2] = 0.0
        cases.append((p, l.copy(), q, limits.copy()))
    ahead = np.array([[0, -3.1, -3.1], [3.1, 3.1, 3.1]])  # the waist stands exactly on its limit
    cases.append((np.array([0.42, 0, 0.2]), l.copy(), np.array([0, 0.3, -0.6]), ahead))
    return [case for case in cases if _has_one_best(*case)]


def _has_one_best(p, l, q_now, limits):
    """Tell whether no other allowed pose turns its busiest joint nearly as little, within 0.05 rad."""
    turns = sorted(np.abs(q - q_now).max() for q in inverse_kinematics(p, l) if allowed(q, l, limits))
    return len(turns) < 2 or turns[1] - turns[0] > 0.05


def _same_pose(returned, expected):
    if returned is None or expected is None:
        return returned is None and expected is None
    returned = np.asarray(returned, dtype=float)
    return returned.shape == (3,) and bool(np.abs(returned - expected).max() < _SAME)


def _reach_symptom(cases, returned, expected):
    there = [k for k, right in enumerate(expected) if right is not None]
    refused = [k for k in there if returned[k] is None]
    if refused and all(cases[k][0][2] == 0 for k in refused):
        return (
            f"places exactly on the table, z = 0, are refused ({len(refused)} here): they are allowed, and rounding "
            "may put the tip a hair below; allow it 1e-9 m"
        )
    if refused:
        return (
            f"it returns None for {len(refused)} of {len(there)} places that have an allowed pose: is too much struck "
            "out (limits in rad, low ones first), or is the choice not returned?"
        )
    if all(_same_pose(returned[k], expected[k]) for k in there):
        one = next(one for one, right in zip(returned, expected, strict=True) if one is not None and right is None)
        return f"where no pose is allowed it returns {shown(one)}: None is asked for"
    for (p, l, _, limits), one in zip(cases, returned, strict=True):
        if one is None:
            continue
        q = np.asarray(one, dtype=float)
        if q.shape != (3,):
            return f"it returns {shown(one)}: the pose itself is asked for, three angles"
        off = np.linalg.norm(forward_kinematics(q, l) - p)
        if not off < 1e-5:
            cut = ". It stands exactly on a limit: cut to the limits, a pose is another one"
            return (
                "it returns a pose that is none of those of your inverse_kinematics: its tip is "
                f"{1000 * off:.0f} mm beside the place{cut if np.isclose(q, limits).any() else ''}"
            )
        if not within(q, limits):
            joint = int(np.argmax((q < limits[0]) | (q > limits[1])))
            return (
                f"it takes a pose that the arm may not: joint {joint + 1} would stand at {q[joint]:.2f} rad, "
                f"allowed are {limits[0][joint]:.2f} to {limits[1][joint]:.2f}"
            )
        if not above_table(q, l):
            part = "elbow" if frames(q, l)[2][2, 3] < -1e-9 else "tip"
            return f"it takes a pose whose {part} is below the table: elbow and tip have to stay above, z >= 0"
    return (
        "the poses are allowed, but another allowed one turns its busiest joint less: compare the largest turns, "
        "and is the smallest so far kept up to date?"
    )


REACH = Task(
    name="reach",
    asks="the allowed pose (3,) for p whose largest joint turn from q_now is smallest, elbow and tip not below the "
    "table; None if there is none",
    right=reach,
    cases=_reach_cases,
    leans_on=("inverse_kinematics", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    same=_same_pose,
    loan=text_of(reach),
    parts=("q1", "q2", "q3"),
    slips=mistakes(reach),
    symptom=_reach_symptom,
    hints=(
        "Go through the rows of your inverse_kinematics and strike out what is not allowed: limits, elbow, tip.",
        "Of those that are left: how far has each joint to turn, which of the three turns most, and in which row is "
        "that least?",
    ),
)  # fmt: skip

TASKS = (INVERSE_KINEMATICS, REACH)
