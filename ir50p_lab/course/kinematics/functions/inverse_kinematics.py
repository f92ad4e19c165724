"""inverse_kinematics: all poses that reach a place."""

import numpy as np

from ir50p_lab.course.checking.task import Mistake, Task, table, text_of, wrong_one
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics

SAME = 1e-5  # rad: near the stretched arm rounding of the place leaves the elbow uncertain by 3e-8, 2e-6 degrees


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
        l = LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for k, q in enumerate(rng.uniform([-3, -2, 0], [3, 2, 0], (12, 3))):  # stretched: on the edge, but for rounding
        l = LENGTHS[k % 2].copy()
        cases.append((forward_kinematics(q, l), l))
    for direction in rng.normal(size=(3, 3)):
        for l in LENGTHS[:2]:
            for r in (l[1] + l[2], abs(l[1] - l[2])):
                for step in (-1e-6, -0.5e-9, 0.5e-9, 1e-6):
                    p = np.array([0, 0, l[0]]) + (r + step) * direction / np.linalg.norm(direction)
                    cases.append((p, l.copy()))
    for far in ((0.6, 0.3, 0.5), (-0.5, 0.4, 0.6), (0.02, 0.01, 0.3)):
        cases.append((np.array(far), LENGTHS[0].copy()))
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
    return bool((apart.min(axis=0) < SAME).all() and (apart.min(axis=1) < SAME).all() and number)


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
        wrong = np.abs(np.angle(np.exp(1j * (q - right)))) > SAME
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


TASK = Task(
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
