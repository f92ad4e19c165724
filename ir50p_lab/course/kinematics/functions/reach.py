"""reach: of all poses that reach a place the allowed one that is nearest."""

import numpy as np

from ir50p_lab.course.checking.task import shown, task_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.inverse_kinematics import SAME, inverse_kinematics


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


def _cases():
    from ir50p_lab.modelling import IR50P

    rng = np.random.default_rng(21)
    limits = np.array([IR50P.q_min, IR50P.q_max])
    wide = np.array([[-3.1, -3.1, -3.1], [3.1, 3.1, 3.1]])
    l = LENGTHS[0]
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
    elbow_low = forward_kinematics(near, LENGTHS[2])
    narrow = np.array([near - 0.1, near + 0.1])
    cases.append((elbow_low, LENGTHS[2].copy(), near, narrow))
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
    return returned.shape == (3,) and bool(np.abs(returned - expected).max() < SAME)


def _symptom(case, returned, expected):
    p, l, _, limits = case
    if expected is None:
        return f"where no pose is allowed it returns {shown(returned)}: None is asked for"
    if returned is None:
        edge = ": places exactly on the table, z = 0, are refused; rounding may put the tip a hair below, allow 1e-9 m"
        struck = ": is too much struck out (limits in rad, low ones first), or is the choice not returned?"
        return f"it returns None for a place that has an allowed pose{edge if p[2] == 0 else struck}"
    if np.shape(returned) != (3,):
        return f"it returns {shown(returned)}: the pose itself is asked for, three angles"
    q = np.asarray(returned, dtype=float)
    if not (off := np.linalg.norm(forward_kinematics(q, l) - p)) < 1e-5:
        cut = ". It stands exactly on a limit: cut to the limits, a pose is another one"
        return f"its pose puts the tip {1000 * off:.0f} mm beside the place{cut if np.isclose(q, limits).any() else ''}"
    if not within(q, limits):
        joint = int(np.argmax((q < limits[0]) | (q > limits[1])))
        return f"it takes a pose that the arm may not: joint {joint + 1} would stand at {q[joint]:.2f} rad"
    if not above_table(q, l):
        return "it takes a pose whose elbow or tip is below the table: both have to stay above, z >= 0"
    return "the pose is allowed, but another allowed one turns its busiest joint less: compare the largest turns"


TASK = task_of(
    reach,
    "the allowed pose (3,) for p whose largest joint turn from q_now is smallest, elbow and tip not below the table; "
    "None if there is none",
    cases=_cases,
    leans_on=("inverse_kinematics", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    same=_same_pose,
    parts=("q1", "q2", "q3"),
    symptom=_symptom,
    hints=(
        "Go through the rows of your inverse_kinematics and strike out what is not allowed: limits, elbow, tip.",
        "Of those that are left: how far has each joint to turn, which of the three turns most, and in which row is "
        "that least?",
    ),
)
