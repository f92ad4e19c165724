"""Functions of 02 and 03 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.calling import call_or_fail
from ir50p_lab.course.checking.task import Failed, notebook_tasks
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.kinematics.functions.reach import reach
from ir50p_lab.modelling import load_arm


def along(places, q_start):
    """Return the poses of a line, one (3,) rad for each place (3,) m, or None where there is none."""
    arm = load_arm()
    limits = np.clip([arm.q_min, arm.q_max], -np.pi, np.pi)
    q_now, way = q_start, []
    for p in places:
        pose = reach(p, np.array(arm.l), q_now, limits)
        way.append(pose)
        q_now = q_now if pose is None else pose
    return way


def pace(q, direction, l, fastest):
    """Return the greatest tip speed (m/s) along direction with no joint above fastest (rad/s); 0 if it cannot go there.

    At a singular pose it is that of the joint speeds of least length, which is safe but not always the greatest.
    """
    Jv = _of_tip(q, l)
    qd = np.linalg.lstsq(Jv, direction, rcond=1e-9)[0]
    if not np.allclose(Jv @ qd, direction, atol=1e-6):
        return 0.0
    return fastest / np.max(np.abs(qd))


def push(q, direction, l, strongest):
    """Return the greatest force (N) of the tip along direction, no joint above strongest (N m); or inf.

    It is inf if no joint has to give any torque.
    """
    torque = np.max(np.abs(_of_tip(q, l).T @ direction))
    return strongest / torque if torque > 1e-9 else np.inf


def _of_tip(q, l):
    T = frames(q, l)
    return jacobian(T, 3, T[3][:3, 3])[:3]


def _walked(function):
    """Try a loop along two lines; raises Failed where a place has no answer, or another one."""
    for ends in ([0.25, 0.30, 0.10], [0.15, -0.30, 0.30]), ([0.25, 0.20, 0.10], [0.45, -0.20, 0.30]):
        places, start = np.linspace(*ends, 21), np.array([0, 0.8, -0.8])
        way = call_or_fail(lambda places=places, start=start: list(function(places, start)))
        if len(way) != len(places):
            raise Failed(f"{len(way)} answers for {len(places)} places: each place has one, None too", "")
        for number, (pose, right) in enumerate(zip(way, along(places, start), strict=True), start=1):
            if (pose is None) != (right is None) or (pose is not None and not np.allclose(pose, right, atol=1e-6)):
                raise Failed(f"place {number} of {len(places)} has another pose: where does the arm stand by then?", "")
    return ""


def _ways():
    rng = np.random.default_rng(31)
    poses = rng.uniform([-1, 0.2, -1.8], [1, 1.2, -0.6], (6, 3))
    ways = rng.normal(size=(6, 3))
    lengths = rng.uniform(0.2, 0.4, (6, 3))
    return [(q, way / np.linalg.norm(way), l, 1.3) for q, way, l in zip(poses, ways, lengths, strict=True)]


def _pushes():
    stretched = np.zeros(3), np.array([1.0, 0, 0]), np.array([0.3, 0.2, 0.4]), 2.0  # nothing limits it
    return [*_ways(), stretched]


TASKS = notebook_tasks(
    __file__,
    along=(along, None, "a list: for each place its pose, or None", {"trial": _walked}),
    pace=(pace, _ways, "the greatest speed of the tip that way, m/s"),
    push=(push, _pushes, "the greatest force of the tip that way, N"),
)
