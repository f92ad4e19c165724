"""inverse_kinematics: all poses that reach a place."""

from itertools import product

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics

SAME = 1e-5  # rad: near the stretched arm rounding of the place leaves the elbow uncertain by 3e-8, 2e-6 degrees


def inverse_kinematics(p, l):
    """Return all poses that put the tip on p, (n, 3); n = 0 if p is out of reach    (1.60)-(1.73 corrected)."""
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
    poses = rng.uniform([-3, -2, -2.8], [3, 2, 2.8], (26, 3))
    poses[14:, 2] = 0  # stretched: on the edge, but for rounding
    lengths = [LENGTHS[k % 2] for k in range(len(poses))]
    cases = [(forward_kinematics(q, l), l.copy()) for q, l in zip(poses, lengths, strict=True)]
    steps = (-1e-6, -5e-11, 5e-11, 1e-6)  # m, on both sides of both edges; 1e-9 may be allowed on r or on a cosine
    for direction, l, side, step in product(rng.normal(size=(3, 3)), LENGTHS[:2], (1, -1), steps):
        r = abs(l[1] + side * l[2]) + step
        cases.append((np.array([0, 0, l[0]]) + r * direction / np.linalg.norm(direction), l.copy()))
    far = ((0.6, 0.3, 0.5), (-0.5, 0.4, 0.6), (0.02, 0.01, 0.3))
    return cases + [(np.array(p), LENGTHS[0].copy()) for p in far]


def as_poses(value):
    """Return poses as rows (n, 3); an empty answer of any shape becomes (0, 3)."""
    rows = np.asarray(value, dtype=float)
    if rows.size == 0:
        return np.empty((0, 3))
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError("not rows of three angles")
    return rows


def same_poses(returned, expected):
    """Return True if two lists hold the same poses, in any order; at the edge, where two coincide, one is enough."""
    a, b = as_poses(returned), as_poses(expected)
    if len(a) == 0 or len(b) == 0:
        return len(a) == len(b)
    apart = np.abs(np.angle(np.exp(1j * (a[:, None] - b[None])))).max(axis=2)  # whole turns left out
    number = len(a) <= len(b) if _straight(b) else len(a) == len(b)
    return bool((apart.min(axis=0) < SAME).all() and (apart.min(axis=1) < SAME).all() and number)


def _straight(poses):
    """Tell whether the arm is stretched or folded flat, where its two elbows are one."""
    return np.abs(np.sin(poses[:, 2])).max() < 1e-2


_SAYS = sentences("inverse_kinematics", __file__)


def _symptom(case, returned, expected):
    p, l = case
    if returned is not None and np.isnan(returned).any():
        return _SAYS["nan"]
    if not len(expected):
        return _SAYS["out of reach"]
    if np.size(returned) and np.shape(returned)[1:] != (3,):
        return _SAYS["rows"].format(np.shape(returned))
    rows = as_poses(returned)
    if not len(rows):
        return _SAYS["on the edge" if _straight(expected) and np.cos(expected[0, 2]) > 0 else "within reach"]
    off = [np.linalg.norm(forward_kinematics(q, l) - p) for q in rows]
    if max(off) > 1e-5:
        return _SAYS["beside the place"].format(np.argmax(off) + 1, len(rows), 1000 * max(off))
    return _SAYS["number"].format(len(np.unique(rows.round(6), axis=0)), len(expected))


def _whole_turns(poses):
    """Which angle is a whole turn too far: right in the picture, but limits would strike it out."""
    rows = as_poses(poses)
    for number, joint in np.argwhere(np.abs(rows) > np.pi + 1e-9):
        angle = rows[number, joint]
        same = np.angle(np.exp(1j * angle))
        return _SAYS["whole turn"].format(("waist", "shoulder", "elbow")[joint], number + 1, angle, same)
    return ""


TASK = task_of(
    inverse_kinematics,
    cases=_targets,
    leans_on=("forward_kinematics", "frames", "dh_matrix", "rot_z"),
    compare=same_poses,
    entry_names=("q1", "q2", "q3"),
    symptom=_symptom,
    check_form=_whole_turns,
)
