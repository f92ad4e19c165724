"""Paths of the tip in space, straight or round, as references for the joints: through the IK, from rest to rest."""

import math
from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.differential import jacobian, singularity
from ir50p_lab.modelling.ik import BRANCHES, inverse_kinematics, reachability
from ir50p_lab.signals.fourier import limits_of, refuse_below_table
from ir50p_lab.signals.path_shapes import Circle, Line
from ir50p_lab.signals.reference import Reference, pose
from ir50p_lab.signals.speed_profile import SpeedProfile, fastest

_GRID = 801  # points, on a circle per turn, at which a path is examined
_STEP = 1e-5  # s, of the difference that gives Jvd, right to ten digits
_SINGULAR = 1e-3  # smallest singular value of Jv over the reach, below which no joint speed is finite in practice


@dataclass(frozen=True)
class CartesianPath(Reference):
    """A path of the tip as joint reference; made by `cartesian_line` and `cartesian_circle`.

        p = p(s(t)),  v = p' sd,  a = p'' sd^2 + p' sdd
        q = IK(p),  qd = Jv^-1 v,  qdd = Jv^-1 (a - Jvd qd)

    arm: Arm; shape: the path by its length s in m; profile: s(t), from rest to rest; branch: the one of the four
    solutions that is kept throughout; margin: rad kept from the joint limits. Before and after the motion it rests.
    """

    arm: Arm
    shape: object
    profile: SpeedProfile
    branch: str
    q_grid: np.ndarray = field(repr=False, compare=False)  # (n, 3) rad at equal distances, without jumps of a turn
    duration: float

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
        s, _, _ = self.profile(np.asarray(t, dtype=float))
        return self.shape(s)[0]

    @property
    def q_start(self):
        """Pose in which the path begins, (3,) rad: move there first, for instance with `quintic`."""
        return self.q_grid[0].copy()


def cartesian_line(arm, start, end, **options):
    """The tip on a straight line from `start` to `end`, from rest to rest.

    Args: arm: Arm; start, end: (3,) m, base coordinates; options: see `cartesian_circle`.
    Returns: CartesianPath, a Reference with `.tip(t)`, `.q_start`, `.branch`.
    Raises: as `cartesian_circle`; InputError if start and end are the same point.
    """
    line = Line(pose("start", start, unit="m"), pose("end", end, unit="m"))
    if line.length < 1e-6:
        raise InputError(f"start and end of the line are {line.length:.3g} m apart: give two different points (m)")
    return _path(arm, line, _GRID, **options)


def cartesian_circle(arm, centre, radius, *, normal=(0.0, 0.0, 1.0), turns=1.0, phase=0.0, **options):
    """The tip on a circle about `centre`, from rest to rest.

    Args:
        arm: Arm. centre: (3,) m; radius: m.
        normal: (3,) axis of the circle, of any length; seen against it the tip goes anticlockwise.
        turns: any number but 0; negative: clockwise.
        phase: rad, where on the circle it begins; 0 lies on the side of the x axis (of z if the normal is along x).
        speed: m/s, on the path (default 0.09, the path speed in the manual of the ROB3i, the sister arm).
        acceleration: m/s^2, of the tip, tangential and centripetal together (default 0.3).
        start_time: s; before it the arm rests at the first point.
        near: (3,) rad (default 0); of the branches that can go all of it ('front/up', 'front/down', 'back/up',
            'back/down'), the one is taken that begins nearest to this pose.
        max_joint_speed: rad/s, one number or (3,). Default: half the no-load speed of the motors; without motors 2.
        table: height in m below which neither elbow nor tip may go (default 0); None: no table.
        margin: rad kept from the joint limits (default 0.03: at a limit the drive is cut).

    Returns: CartesianPath, a Reference with `.tip(t)`, `.q_start`, `.branch`.
    Raises: UnreachableError if a point is out of reach, outside the joint limits on every branch, or under the table;
    if a joint would have to be faster than max_joint_speed: then the path passes near a singular pose, or the speed is
    too high. It says where, by how much, and what to do. InputError on a wrong shape or a number that is not finite or
    out of range.
    """
    centre, normal = pose("centre", centre, unit="m"), pose("normal", normal, unit="1")
    if not math.hypot(*normal) > 1e-9:
        raise InputError(f"normal = {normal}: it has no direction; for a level circle give (0, 0, 1)")
    if not 0 < abs(number("turns", turns)) <= 100:
        raise InputError(f"turns = {turns}: give a number from -100 to 100, not 0")
    radius, phase = number("radius", radius, "> 0", unit="m"), number("phase", phase, unit="rad")
    return _path(arm, Circle(centre, radius, normal, turns, phase), _GRID * math.ceil(abs(turns)), **options)


def _path(
    arm,
    shape,
    n,
    *,
    speed=0.09,
    acceleration=0.3,
    start_time=0.0,
    near=(0.0, 0.0, 0.0),
    max_joint_speed=None,
    table=0.0,
    margin=0.03,
):
    near = vector3("near", near)
    speed = number("speed", speed, "> 0", unit="m/s")
    acceleration = number("acceleration", acceleration, "> 0", unit="m/s^2")
    start_time = number("start_time", start_time, unit="s")
    low, high, bound, table = limits_of(arm, max_joint_speed=max_joint_speed, table=table, margin=margin)
    p, tangent, _ = shape(np.linspace(0, shape.length, n))

    def place(i):
        """Where sample i is, in words."""
        return f"{100 * i / (n - 1):.0f} % of the way (tip at [{', '.join(f'{x:.3f}' for x in p[i])}] m)"

    _refuse_out_of_reach(arm, p, place)
    solutions = np.unwrap(inverse_kinematics(arm, p).q, axis=0)  # (n, 4, 3), each branch without jumps
    solutions = _nearest_turn(solutions, near, low, high)
    branch = _choose(solutions, near, low, high, place)
    q = solutions[:, branch]
    refuse_below_table(arm.l, q, table, place)
    _refuse_fast_joints(arm, q, tangent, speed, bound, place)
    profile = fastest(shape, speed, acceleration, start_time)
    return CartesianPath(arm, shape, profile, BRANCHES[branch], q_grid=q, duration=max(0.0, profile.end))


def _nearest_turn(solutions, near, low, high):
    """Shift each branch by whole turns: near to the pose `near`, or into the joint limits where only that fits."""

    def turns(towards, now):
        return 2 * np.pi * np.rint((towards - now) / (2 * np.pi))

    least, most = solutions.min(axis=0), solutions.max(axis=0)
    to_pose = turns(near, solutions[0])
    fits = (least + to_pose >= low) & (most + to_pose <= high)
    around = near - 2 * np.pi, near + 2 * np.pi  # in place of limits that are infinite
    middle = np.clip([low, high], *around).mean(axis=0)
    return solutions + np.where(fits, to_pose, turns(middle, (least + most) / 2))


def _choose(solutions, near, low, high, place):
    """Number of the branch that stays within the limits throughout and begins nearest to `near`."""
    over = np.maximum(low - solutions, solutions - high)  # (n, 4, 3) rad past the limits
    possible = (over <= 0).all(axis=(0, 2))
    if possible.any():
        distance = np.abs(solutions[0] - near).max(axis=1)
        return int(np.where(possible, distance, np.inf).argmin())
    reasons = []
    for k, branch in enumerate(BRANCHES):
        i, joint = np.unravel_index(over[:, k].argmax(), over[:, k].shape)
        angle, least, most = np.degrees([solutions[i, k, joint], low[joint], high[joint]])
        reasons.append(f"{branch}: q{joint + 1} = {angle:.1f} deg at {place(i)}, allowed {least:.0f}..{most:.0f}")
    raise UnreachableError(
        f"the path leaves the joint limits (less margin) on every branch ({' | '.join(reasons)}): move or shorten it"
    )


def _refuse_out_of_reach(arm, p, place):
    distance = reachability(arm, p)
    if not distance.any():
        return
    outside, worst = distance > 0, int(distance.argmax())
    _, l2, l3 = arm.l
    raise UnreachableError(
        f"{outside.mean():.0%} of the path is out of reach, first at {place(int(outside.argmax()))}; worst "
        f"{1e3 * distance[worst]:.3g} mm outside at {place(worst)}: "
        f"the arm reaches {abs(l2 - l3):.3g} to {l2 + l3:.3g} m from its shoulder at height {arm.l[0]:.3g} m"
    )


def _refuse_fast_joints(arm, q, tangent, speed, bound, place):
    """Joint speeds at full path speed throughout, the ends included: there a singular pose needs endless qdd."""
    found = singularity(arm, q)
    near = found.smallest < _SINGULAR * arm.reach
    rates = np.linalg.solve(np.where(near[:, None, None], np.eye(3), jacobian(arm, q)[:, :3]), tangent[..., None])
    rates = np.where(near[:, None], np.inf, np.abs(rates[..., 0])) * speed
    i, joint = np.unravel_index((rates / bound).argmax(), rates.shape)
    if rates[i, joint] <= bound[joint]:
        return
    advice = []
    if near[i] or found.smallest[i] < 0.3 * found.smallest.max():
        which = f"tip {1e3 * abs(found.shoulder[i]):.0f} mm from the axis of joint 1"
        if abs(found.elbow[i]) < abs(found.shoulder[i]) / arm.reach:
            which = f"elbow {'stretched' if np.cos(q[i, 2]) > 0 else 'folded'}, q3 = {np.degrees(q[i, 2]):.1f} deg"
        advice.append(f"it passes near a singular pose ({which}): lead the path further away")
    if not near[i]:
        advice.append(f"give a speed of at most {speed * bound[joint] / rates[i, joint]:.2g} m/s")
    raise UnreachableError(
        f"joint {joint + 1} would have to turn at {rates[i, joint]:.3g} rad/s at {place(i)}, its bound is "
        f"{bound[joint]:.3g} rad/s; {', or '.join(advice)}"
    )
