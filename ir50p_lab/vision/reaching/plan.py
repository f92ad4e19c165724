"""Can the arm reach it, in which pose, and on which trajectory: smooth, and clear of the table and of the ball."""

import contextlib
from itertools import pairwise

import numpy as np

from ir50p_lab.errors import UnreachableError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.ik import inverse_kinematics
from ir50p_lab.signals.quintic import through

MARGIN = 0.03  # rad: poses stay so far from the joint limits, for at a limit the drive is cut
CLEAR = 0.08  # m: height over the table that the tip keeps on its path, to pass over a ball of 60 mm
LIFT = 0.08  # m: the last piece of the path begins so far above the goal
_PEAK = 1.875  # a quintic's largest speed over its mean


def reach_pose(arm, p, near=(0.0, 0.0, 0.0)):
    """Return joint angles (3,) rad that put the tip on p (3,) m: of those within the limits, the nearest to `near`.

    The angles keep 0.03 rad from the limits. Raises UnreachableError if p is outside the workspace (with .distance m
    and .nearest (3,) m), if every pose is past a joint limit, or if tip or elbow would be under the table.
    """
    p = vector3("p", p, unit="m")
    if p[2] < 0:
        raise UnreachableError(f"the arm cannot go to {p.round(3).tolist()} m: it lies under the table")
    q = inverse_kinematics(arm, p).q
    allowed = ((q >= np.array(arm.q_min) + MARGIN) & (q <= np.array(arm.q_max) - MARGIN)).all(axis=-1)
    allowed &= arm.l[0] + arm.l[1] * np.sin(q[..., 1]) > 0  # the elbow's height
    if not allowed.any():
        raise UnreachableError(
            f"the arm cannot go to {p.round(3).tolist()} m: each of its poses there, {np.degrees(q).round().tolist()} "
            "deg, is past a joint limit, nearer than 2 deg to one, or has its elbow under the table"
        )
    return q[np.where(allowed, np.abs(q - near).max(axis=-1), np.inf).argmin()]


def plan(arm, q, p, *, lift=LIFT, speed=0.5):
    """Plan the path of the tip from the pose q to the point p: first above it, then down. If too low, it rises first.

    All pieces are straight lines in joint angles; on the last the tip of the IR50P stays within 4 mm of a plumb line.

    Args: arm: Arm; q: (3,) rad, where it stands; p: (3,) m; lift: m above p where the last piece begins (with 0 it goes
    there directly); speed: rad/s, > 0, of the fastest joint. Joint 2 of the IR50P follows 0.5 rad/s against gravity.
    Returns: Quintic, a Reference through its `points`. Raises InputError on a bad speed, UnreachableError as
    `reach_pose` does.
    """
    speed = number("speed", speed, "> 0", unit="rad/s")
    goal = reach_pose(arm, p, q)
    poses = _clear(arm, q, goal, min(CLEAR, p[2]))
    for share in (1.0, 0.5, 0.25) if lift > 0 else ():
        with contextlib.suppress(UnreachableError):
            above = reach_pose(arm, p + np.array([0.0, 0.0, share * lift]), goal)
            poses = [*_clear(arm, q, above, CLEAR), goal]
            break
    return through(poses, durations=[max(0.3, _PEAK * float(np.abs(b - a).max()) / speed) for a, b in pairwise(poses)])


def _clear(arm, q, goal, clear):
    """Poses from q to the goal: directly if that stays clear, else first up, then round, then down."""
    from ir50p_lab.bench.rest import rest_pose

    def lowest(path):
        return float(frames(arm, path)[:, 2:, 2, 3].min())

    if lowest(np.linspace(q, goal, 60)) >= min(clear, lowest(np.array([q, goal]))) - 1e-3:
        return [q, goal]
    high = rest_pose(arm)
    return [q, np.array([q[0], high[1], q[2]]), np.array([goal[0], high[1], goal[2]]), goal]
