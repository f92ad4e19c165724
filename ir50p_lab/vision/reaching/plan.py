"""Can the arm reach it, in which pose, and on which trajectory: smooth, and clear of the table and of the ball."""

import contextlib
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from ir50p_lab.errors import UnreachableError
from ir50p_lab.inputs import vector3
from ir50p_lab.modelling.chain import forward_kinematics, frames
from ir50p_lab.modelling.ik import inverse_kinematics, reachability
from ir50p_lab.signals.quintic import Quintic, through

MARGIN = 0.03  # rad kept from the joint limits: at a limit the drive is cut
CLEAR = 0.08  # m that the tip keeps above the table on its path: over a ball of 60 mm
ALMOST = 1e-3  # m out of reach that does not matter: the nearest point will do
LIFT = 0.08  # m above the goal from which the last piece leads down
_HEIGHT = 0.09  # m of the tip over a ball on the table
_ANGLE = 0.52  # rad to both sides of x that the work area spans at most
_SPEED = 0.5  # rad/s of the fastest joint: joint 2 follows that against gravity
_PEAK = 1.875  # a quintic's largest speed over its mean


@dataclass(frozen=True)
class WorkArea:
    """Where balls may lie for this arm: a part of a ring on the table, r_min..r_max m, -angle..angle rad about x.

    It reaches 30 mm farther out than the arm does: who lays a ball there gets a refusal with the distance.
    """

    r_min: float
    r_max: float
    angle: float


def work_area(arm):
    """The area of this arm with the tip 90 mm above the table: from its inner to 30 mm past its outer edge.

    Raises UnreachableError if the arm reaches no point of that height.
    """
    radii = np.arange(0.02, sum(arm.l) + 0.01, 0.005)
    near = [r for r in radii if not _refusal(arm, np.array([r, 0.0, _HEIGHT]))]
    if not near:
        raise UnreachableError(f"no point at height {_HEIGHT} m is within reach of {arm.name}")
    return WorkArea(float(near[0]), float(near[-1] + 0.03), float(min(_ANGLE, arm.q_max[0], -arm.q_min[0])))


def reach_pose(arm, p, near=(0.0, 0.0, 0.0)):
    """Joint angles that put the tip on p, of those within the limits (less 0.03 rad) the nearest to `near`.

    Args: arm: Arm; p: (3,) m; near: (3,) rad. Returns: (3,) rad.
    Raises: UnreachableError, with .distance (m) and .nearest (3,) m, the nearest point that the arm does reach, if p
    is outside the workspace, outside the joint limits, or if the elbow would be under the table.
    """
    p = vector3("p", p, unit="m")
    if why := _refusal(arm, p):
        nearest = nearest_reachable(arm, p)
        distance = float(np.linalg.norm(nearest - p))
        error = UnreachableError(
            f"the arm cannot go to {np.round(p, 3).tolist()} m: {why}. It misses it by {1e3 * distance:.1f} mm; the "
            f"nearest point is {np.round(nearest, 3).tolist()} m"
        )
        error.distance, error.nearest = distance, nearest
        raise error
    solutions = inverse_kinematics(arm, p)
    distance = np.abs(solutions.q - near).max(axis=-1)
    return solutions.q[np.where(_allowed(arm, solutions.q), distance, np.inf).argmin()]


def within_reach(arm, p):
    """p (3,) m, or the nearest point that the arm reaches, if that is no farther than 1 mm.

    A ball is seen to some tenths of a millimetre: that must not decide between a reach and a refusal.
    Raises UnreachableError as `reach_pose`.
    """
    try:
        reach_pose(arm, p)
    except UnreachableError as error:
        if not 0 < error.distance <= ALMOST:
            raise
        return p + (error.nearest - p) * (1 + 1e-6 / error.distance)  # 1 um inside
    return p


def nearest_reachable(arm, p):
    """The point nearest to p (3,) m that the arm reaches within its limits and with its elbow above the table.

    Bounded least squares over the joints, from several starts.
    """
    from scipy.optimize import least_squares

    low, high = np.array(arm.q_min) + MARGIN, np.array(arm.q_max) - MARGIN
    p = np.array([p[0], p[1], max(p[2], 0.0)])  # from under the table the path leads up first
    heading, found = np.clip(np.arctan2(p[1], p[0]), low[0], high[0]), []
    for shares in product((0.1, 0.5, 0.9), repeat=2):
        start = [heading, *(low[1:] + shares * (high - low)[1:])]
        found.append(least_squares(lambda q: forward_kinematics(arm, q) - p, start, bounds=(low, high), xtol=1e-10))
    best = min(found, key=lambda one: (_elbow(arm, one.x) <= 0, one.cost))
    return forward_kinematics(arm, best.x)


def plan(arm, q, p, *, lift=LIFT):
    """The path of the tip from the pose q to the point p: over it, then down. Where that comes too low it rises first.

    All pieces are straight for the joints; the last one keeps the tip of the IR50P within 4 mm of a plumb line.

    Args: arm: Arm; q: (3,) rad, where it stands; p: (3,) m; lift: m above p where the last piece begins; 0 goes there
    directly.
    Returns: Plan, a Reference. Raises UnreachableError as `reach_pose`.
    """
    q = vector3("q", q)
    goal = reach_pose(arm, p, q)
    poses = _clear(arm, q, goal, min(CLEAR, p[2]))
    for share in (1.0, 0.5, 0.25) if lift > 0 else ():
        with contextlib.suppress(UnreachableError):
            above = reach_pose(arm, p + np.array([0.0, 0.0, share * lift]), goal)
            poses = [*_clear(arm, q, above, CLEAR), goal]
            break
    durations = [max(0.3, _PEAK * float(np.abs(b - a).max()) / _SPEED) for a, b in pairwise(poses)]
    pieces = through(poses, durations=durations)
    return Plan(pieces.times, pieces.points, pieces.duration, arm)


@dataclass(frozen=True)
class Plan(Quintic):
    """What `plan` returns: poses one after the other, with rest at each."""

    arm: object = None

    @property
    def goal(self):
        """Last pose, (3,) rad."""
        return np.array(self.points[-1])

    @property
    def tips(self):
        """The path of the tip for a drawing, (n, 3) m."""
        return forward_kinematics(self.arm, self.sample(np.linspace(0, self.duration, 200))[:, 0])

    @property
    def lowest(self):
        """Lowest height of tip and elbow on the path, m."""
        return _lowest(self.arm, self.sample(np.linspace(0, self.duration, 200))[:, 0])


def _clear(arm, q, goal, clear):
    """Poses from q to the goal: directly if that stays clear, else first up, then round, then down."""
    from ir50p_lab.bench.rest import rest_pose

    ends = _lowest(arm, np.array([q, goal]))
    if _lowest(arm, np.linspace(q, goal, 60)) >= min(clear, ends) - 1e-3:
        return [q, goal]
    high = rest_pose(arm)
    return [q, np.array([q[0], high[1], q[2]]), np.array([goal[0], high[1], goal[2]]), goal]


def _lowest(arm, q):
    return float(frames(arm, q)[:, 2:, 2, 3].min())


def _elbow(arm, q):
    return arm.l[0] + arm.l[1] * np.sin(q[..., 1])


def _allowed(arm, q):
    low, high = np.array(arm.q_min) + MARGIN, np.array(arm.q_max) - MARGIN
    return ((q >= low) & (q <= high)).all(axis=-1) & (_elbow(arm, q) > 0)


def _refusal(arm, p):
    """Why the arm cannot go there, or ''."""
    if p[2] < 0:
        return f"it lies {-1e3 * p[2]:.0f} mm under the table"
    if reachability(arm, p) > 0:
        return "it is out of reach of the stretched or folded arm"
    solutions = inverse_kinematics(arm, p)
    if _allowed(arm, solutions.q).any():
        return ""
    joints = solutions.q[solutions.within_limits.argmax()]
    low, high = np.degrees(arm.q_min), np.degrees(arm.q_max)
    out = [f"q{i + 1} = {np.degrees(a):.0f} deg, allowed {low[i]:.0f} to {high[i]:.0f}" for i, a in enumerate(joints)]
    return f"every pose is past a joint limit (or within 2 deg of it), {solutions.branches[0]}: {'; '.join(out)}"
