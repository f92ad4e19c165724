"""reach: of all poses that reach a place, the nearest one that is allowed."""

from itertools import product

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.inverse_kinematics import SAME, inverse_kinematics


def reach(p, l, q_now, limits):
    """Return the allowed pose that puts the tip on p with the smallest largest turn from q_now, (3,), or None."""
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
    """Return True if every joint keeps its limits."""
    return bool((q >= limits[0]).all() and (q <= limits[1]).all())


def above_table(q, l):
    """Return True if neither elbow nor tip (frames 2 and 3) is below the table."""
    return bool((frames(q, l)[2:, 2, 3] >= -1e-9).all())


def allowed(q, l, limits):
    """Return True if a pose keeps the limits and stays above the table."""
    return within(q, limits) and above_table(q, l)


def _cases():
    from ir50p_lab.modelling import IR50P

    rng = np.random.default_rng(21)
    limits, wide = np.array([IR50P.q_min, IR50P.q_max]), np.array([[-3.1] * 3, [3.1] * 3])
    ahead = np.array([[0, -3.1, -3.1], [3.1, 3.1, 3.1]])
    l, start, near = LENGTHS[0], np.array([0, 0.3, -0.6]), np.array([0.5, -0.5, 1.5])
    cases = [
        (np.array([0.42, -0.15, 0.09]), l, start, limits),
        (np.array([0.42, 0, 0.2]), l, start, ahead),  # the waist stands exactly on its limit
        (np.array([0.3, 0.2, -0.05]), l, np.zeros(3), wide),  # below the table
        (np.array([0.9, 0, 0.2]), l, np.zeros(3), wide),  # out of reach
        (forward_kinematics(near, LENGTHS[2]), LENGTHS[2], near, np.array([near - 0.1, near + 0.1])),  # elbow too low
    ]
    for bounds in (limits, wide) * 40:
        p = forward_kinematics(rng.uniform(*bounds), l)
        if p[2] > 0:
            cases.append((p, l, rng.uniform(*limits), bounds))
    poses = rng.uniform([-2, 0.2, -1.5], [2, 1, 1.5], (3, 3))
    for side, joint, q in product((0, 1), range(3), poses):  # the nearest pose breaks one limit alone
        bounds = wide.copy()
        bounds[side, joint] = q[joint] + (0.05, -0.05)[side]
        cases.append((forward_kinematics(q, l), l, q, bounds))
    for q in poses:  # the nearest pose breaks all limits
        p = forward_kinematics(q, l)
        farthest = max(inverse_kinematics(p, l), key=lambda pose, q=q: np.abs(pose - q).min())
        cases.append((p, l, q, np.array([farthest - 0.1, farthest + 0.1])))
    for q in rng.uniform([-1, 0.2, -2], [1, 1.2, -1], (8, 3)):  # on the table, but for rounding
        cases.append((forward_kinematics(q, l) * [1, 1, 0], l, q, limits))
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


_SAYS = sentences("reach", __file__)


def _symptom(case, returned, expected):
    p, l, _, limits = case
    if expected is None:
        return _SAYS["none is allowed"]
    if returned is None:
        return _SAYS["on the table" if p[2] == 0 else "too much struck out"]
    if np.shape(returned) != (3,):
        return _SAYS["no pose"]
    q = np.asarray(returned, dtype=float)
    if not np.allclose(forward_kinematics(q, l), p, atol=1e-5):
        return _SAYS["cut to its limits" if np.isclose(q, limits).any() else "beside the place"]
    if not within(q, limits):
        joint = int(np.argmax((q < limits[0]) | (q > limits[1])))
        return _SAYS["limits"].format(joint + 1, q[joint])
    return _SAYS["another turns less" if above_table(q, l) else "table"]


TASK = task_of(
    reach,
    cases=_cases,
    leans_on=("inverse_kinematics", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    compare=_same_pose,
    entry_names=("q1", "q2", "q3"),
    symptom=_symptom,
)
