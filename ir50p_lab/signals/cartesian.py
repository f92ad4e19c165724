"""Paths of the tip in space, straight or round, as references for the joints: through the IK, from rest to rest."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.differential import jacobian, singularity
from ir50p_lab.modelling.ik import BRANCHES, inverse_kinematics, reachability
from ir50p_lab.signals.fourier import heights, limits_of
from ir50p_lab.signals.path_shapes import Circle, Line
from ir50p_lab.signals.reference import Reference, pose, seconds
from ir50p_lab.signals.speed_profile import SpeedProfile, fastest

_STEP = 1e-5  # s, of the difference that gives Jvd, right to ten digits
_SINGULAR = 1e-3  # smallest singular value of Jv over the reach, below which no joint speed is finite in practice


@dataclass(frozen=True)
class CartesianPath(Reference):
    """A path of the tip as joint reference; made by `cartesian_line` and `cartesian_circle`.

        p = p(s(t)),  v = p' sd,  a = p'' sd^2 + p' sdd
        q = IK(p),  qd = Jv^-1 v,  qdd = Jv^-1 (a - Jvd qd)

    arm: Arm; shape: the path by its length s in m; profile: s(t), from rest to rest; branch: the one of the four
    solutions that is kept all the way; margin: rad kept from the joint limits. Before and after the motion it rests.
    """

    arm: Arm
    shape: object
    profile: SpeedProfile
    branch: str
    q_grid: np.ndarray = field(repr=False, compare=False)  # (n, 3) rad at equal distances, without jumps of a turn
    duration: float = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "duration", max(0.0, self.profile.end))

    def _rows(self, t):
        s, sd, sdd = self.profile(t)
        p, tangent, bend = self.shape(s)
        sd, sdd = sd[:, None], sdd[:, None]
        near = self.q_grid[np.rint(s / self.shape.length * (len(self.q_grid) - 1)).astype(int)]
        q = inverse_kinematics(self.arm, p).q[:, BRANCHES.index(self.branch)]
        q = q + 2 * np.pi * np.rint((near - q) / (2 * np.pi))
        qd = self._joint_rates(q, tangent * sd)
        ahead, behind = (jacobian(self.arm, q + step * qd)[:, :3] for step in (_STEP, -_STEP))
        Jvd = (ahead - behind) / (2 * _STEP)
        a = tangent * sdd + bend * sd**2 - (Jvd @ qd[..., None])[..., 0]
        return np.stack([q, qd, self._joint_rates(q, a)], axis=1)

    def _joint_rates(self, q, v):
        return np.linalg.solve(jacobian(self.arm, q)[:, :3], v[..., None])[..., 0]

    def tip(self, t):
        """Where the tip shall be at one time t (3,) or at times (n,), (n, 3), in s; m."""
        if np.ndim(t) == 0:
            return self.tip([seconds("t", t)])[0]
        return self.shape(self.profile(np.asarray(t, dtype=float))[0])[0]

    @property
    def points(self):
        """The path for a drawing, (n, 3) m, at equal distances."""
        return self.shape(np.linspace(0, self.shape.length, len(self.q_grid)))[0]

    @property
    def q_start(self):
        """Pose in which the path begins, (3,) rad: move there first, for instance with `quintic`."""
        return self.q_grid[0].copy()


def cartesian_line(arm, start, end, **options):
    """The tip on a straight line from `start` to `end`, from rest to rest.

    Args: arm: Arm; start, end: (3,) m, base coordinates; options: see `cartesian_circle`.
    Returns: CartesianPath, a Reference with `.tip(t)`, `.points`, `.q_start`, `.branch`.
    Raises: as `cartesian_circle`; InputError if start and end are the same point.
    """
    return _path(arm, Line(pose("start", start, unit="m"), pose("end", end, unit="m")), **options)


def cartesian_circle(arm, centre, radius, *, normal=(0.0, 0.0, 1.0), turns=1.0, phase=0.0, **options):
    """The tip on a circle about `centre`, from rest to rest.

    Args:
        arm: Arm. centre: (3,) m; radius: m.
        normal: (3,) axis of the circle, of any length; seen against it the tip goes anticlockwise.
        turns: any number but 0; negative: clockwise.
        phase: rad, where on the circle it begins; 0 lies on the side of the x axis (of z if the normal is along x).
        speed: m/s, on the way (default 0.09, the path speed in the manual of the ROB3i, the sister arm).
        acceleration: m/s^2, of the tip, tangential and centripetal together (default 0.3).
        start_time: s; before it the arm rests at the first point.
        near: (3,) rad; of the branches that can go all the way, the one is taken that begins nearest to this pose.
        branch: one of 'front/up', 'front/down', 'back/up', 'back/down' to choose it yourself.
        max_joint_speed: rad/s, one number or (3,). Default: half the no-load speed of the motors; without motors 2.
        table: height in m below which neither elbow nor tip may go (default 0); None: no table.
        margin: rad kept from the joint limits (default 0.03: at a limit the drive is cut).

    Returns: CartesianPath, a Reference with `.tip(t)`, `.points`, `.q_start`, `.branch`.
    Raises: UnreachableError, with .share (0..1 of the way), .point (3,) m and .distance (m, or rad past a joint limit),
    if a point is out of reach, outside the joint limits on every branch, or under the table; with .speeds (3,) rad/s
    if a joint would have to be faster than max_joint_speed: then the path passes near a singular pose, or the speed is
    too high. InputError on a wrong shape or a number that is not finite or out of range.
    """
    centre, normal = pose("centre", centre, unit="m"), pose("normal", normal, unit="1")
    return _path(arm, Circle(centre, radius, normal, turns, phase), **options)


def _path(
    arm,
    shape,
    *,
    speed=0.09,
    acceleration=0.3,
    start_time=0.0,
    near=None,
    branch=None,
    max_joint_speed=None,
    table=0.0,
    margin=0.03,
):
    near = vector3("near", (0.0, 0.0, 0.0) if near is None else near)
    if branch is not None and branch not in BRANCHES:
        raise InputError(f"branch = {branch!r}: choose one of {', '.join(BRANCHES)}")
    speed = number("speed", speed, "> 0", unit="m/s")
    acceleration = number("acceleration", acceleration, "> 0", unit="m/s^2")
    low, high, bound, table = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    s = np.linspace(0, shape.length, shape.grid)
    p, tangent, _ = shape(s)
    _refuse_out_of_reach(arm, p)
    _refuse_below("tip", p[:, 2], table, p)
    solutions = np.unwrap(inverse_kinematics(arm, p).q, axis=0)  # (n, 4, 3), each branch without jumps
    solutions = _nearest_turn(solutions, near, low, high)
    choice = _choose(arm, solutions, p, near, branch, margin)
    q = solutions[:, choice]
    if table is not None:
        _refuse_below("elbow", heights(arm.l, q)[0], table, p)
    _refuse_fast_joints(arm, q, p, tangent, speed, bound)
    profile = fastest(shape, speed, acceleration, seconds("start_time", start_time))
    return CartesianPath(arm=arm, shape=shape, profile=profile, branch=BRANCHES[choice], q_grid=q)


def _nearest_turn(solutions, near, low, high):
    """Shift each branch by whole turns: into the joint limits if it fits there, else near to the pose `near`."""
    turns = 2 * np.pi * np.rint((near - solutions[0]) / (2 * np.pi))
    best = solutions + turns
    for k in (-1, 0, 1):
        shifted = solutions + 2 * np.pi * k
        fits = ((shifted >= low) & (shifted <= high)).all(axis=0)
        worse = ~((best >= low) & (best <= high)).all(axis=0)
        best = np.where(fits & worse, shifted, best)
    return best


def _choose(arm, solutions, p, near, branch, margin):
    """Number of the branch that stays within the limits all the way and begins nearest to `near`."""
    over = np.maximum(np.array(arm.q_min) + margin - solutions, solutions - np.array(arm.q_max) + margin)
    over = np.maximum(over, 0.0)  # (n, 4, 3) rad past the limits
    possible = ~over.any(axis=(0, 2))
    if branch is not None:
        possible &= np.array(BRANCHES) == branch
    if possible.any():
        distance = np.abs(solutions[0] - near).max(axis=1)
        return int(np.where(possible, distance, np.inf).argmin())
    reasons, candidates = [], [BRANCHES.index(branch)] if branch else range(4)
    for k in candidates:
        i, joint = np.unravel_index(over[:, k].argmax(), over[:, k].shape)
        limits = np.degrees([arm.q_min[joint], arm.q_max[joint]])
        reasons.append(
            f"{BRANCHES[k]}: q{joint + 1} = {np.degrees(solutions[i, k, joint]):.1f} deg at {_percent(i, p)}, "
            f"limits {limits[0]:.0f}..{limits[1]:.0f}"
        )
    k = min(candidates, key=lambda k: over[:, k].max())
    i = int(over[:, k].max(axis=1).argmax())
    raise _unreachable(
        f"the path leaves the joint limits (less {margin:g} rad of margin) on "
        f"{'every branch' if branch is None else 'this branch'} ({' | '.join(reasons)}): move or shorten it",
        i,
        p,
        float(over[i, k].max()),
    )


def _refuse_out_of_reach(arm, p):
    distance = reachability(arm, p)
    if not distance.any():
        return
    outside = np.flatnonzero(distance > 0)
    worst = int(distance.argmax())
    _, l2, l3 = arm.l
    raise _unreachable(
        f"{len(outside) / len(p):.0%} of the path is out of reach, first at {_percent(outside[0], p)} of the way "
        f"({_text(p[outside[0]])}); worst {1e3 * distance[worst]:.3g} mm outside at {_percent(worst, p)}: "
        f"the arm reaches {abs(l2 - l3):.3g} to {l2 + l3:.3g} m from its shoulder at height {arm.l[0]:.3g} m",
        worst,
        p,
        float(distance[worst]),
    )


def _refuse_below(part, heights, table, p):
    if table is None:
        return
    i = int(heights.argmin())
    depth = table - heights[i]
    if depth > 1e-12:
        raise _unreachable(
            f"the {part} would be {1e3 * depth:.3g} mm under the table (height {table:g} m) at {_percent(i, p)} of the "
            f"way, tip at {_text(p[i])}: raise the path, or give the height of your table",
            i,
            p,
            float(depth),
        )


def _refuse_fast_joints(arm, q, p, tangent, speed, bound):
    """Joint speeds at full path speed all the way, the ends included: there a singular pose needs endless qdd."""
    smallest = singularity(arm, q).smallest
    near = smallest < _SINGULAR * arm.reach
    rates = np.linalg.solve(np.where(near[:, None, None], np.eye(3), jacobian(arm, q)[:, :3]), tangent[..., None])
    rates = np.where(near[:, None], np.inf, np.abs(rates[..., 0])) * speed
    excess = (rates / bound).max(axis=1)
    i = int(excess.argmax())
    if excess[i] <= 1:
        return
    joint = int((rates[i] / bound).argmax())
    why = "" if near[i] else f"give a speed of at most {speed / excess[i]:.2g} m/s"
    if near[i] or smallest[i] < 0.3 * smallest.max():
        away = f"it passes near a singular pose ({_which_singularity(arm, q[i])}): lead the path further away"
        why = f"{away}, or {why}" if why else away
    error = _unreachable(
        f"joint {joint + 1} would have to turn at {rates[i, joint]:.3g} rad/s at {_percent(i, p)} of the way "
        f"({_text(p[i])}), its bound is {bound[joint]:.3g} rad/s; {why}",
        i,
        p,
        0.0,
    )
    error.speeds = rates[i]
    raise error


def _which_singularity(arm, q):
    found = singularity(arm, q)
    elbow = f"elbow {'stretched' if np.cos(q[2]) > 0 else 'folded'}, q3 = {np.degrees(q[2]):.1f} deg"
    shoulder = f"tip {1e3 * abs(found.shoulder):.0f} mm from the axis of joint 1"
    return elbow if abs(found.elbow) < abs(found.shoulder) / arm.reach else shoulder


def _unreachable(message, i, p, distance):
    error = UnreachableError(message)
    error.share, error.point, error.distance = i / (len(p) - 1), p[i], distance
    return error


def _percent(i, p):
    return f"{100 * i / (len(p) - 1):.0f} %"


def _text(p):
    return f"[{', '.join(f'{x:.3f}' for x in p)}] m"
