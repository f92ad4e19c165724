"""Paths of the tip, a line and a circle, as references of the joints: inverse kinematics, one branch throughout."""

import math
from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.ik import BRANCHES, inverse_kinematics, reachability
from ir50p_lab.signals.fourier import limits_of, refuse_below_table
from ir50p_lab.signals.reference import Reference

_STEP = 1e-4  # s, of the differences that give speed and acceleration
_SAMPLES = 400  # points of a path at which it is checked


@dataclass(frozen=True, eq=False)
class CartesianPath(Reference):
    """A path of the tip as joint reference, from rest to rest; made by `cartesian_line` and `cartesian_circle`.

    point: function of the share of the way, (n,) -> (n, 3) m. start, duration: s; before and after the motion it rests.
    branch: of the four solutions, kept throughout; q_grid: (n, 3) rad, at even shares of the way, without whole turns.
    """

    arm: Arm
    point: object
    start: float
    branch: str
    q_grid: np.ndarray
    duration: float = field(kw_only=True)

    def _rows(self, t):
        before, q, after = (self._pose(t + k * _STEP) for k in (-1, 0, 1))
        return np.stack([q, (after - before) / (2 * _STEP), (after - 2 * q + before) / _STEP**2], axis=1)

    def _pose(self, t):
        share = self._share(t)
        q = inverse_kinematics(self.arm, self.point(share)).q[:, BRANCHES.index(self.branch)]
        near = self.q_grid[np.rint(share * (_SAMPLES - 1)).astype(int)]
        return q + 2 * np.pi * np.rint((near - q) / (2 * np.pi))

    def _share(self, t):
        """Share of the way at times (n,) s: a quintic from rest to rest."""
        x = np.clip((t - self.start) / (self.duration - self.start), 0.0, 1.0)
        return x**3 * (10 - 15 * x + 6 * x**2)

    def tip(self, t):
        """Where the tip shall be at one time t (3,) or at times (n,), (n, 3), in s; m."""
        p = self.point(self._share(np.atleast_1d(np.asarray(t, dtype=float))))
        return p if np.ndim(t) else p[0]

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
    start, end = vector3("start", start, unit="m"), vector3("end", end, unit="m")
    if (length := math.dist(start, end)) < 1e-6:
        raise InputError(f"start and end of the line are {length:.3g} m apart: give two different points (m)")
    return _path(arm, lambda share: start + np.outer(share, end - start), length, **options)


def cartesian_circle(arm, centre, radius, *, normal=(0.0, 0.0, 1.0), **options):
    """The tip once round a circle about `centre`, from rest to rest.

    It begins on the side of the x axis (of z if the normal is along x); seen against the normal it goes anticlockwise.

    Args:
        arm: Arm. centre: (3,) m; radius: m; normal: (3,) axis of the circle, of any length.
        speed: m/s, mean of the tip (default 0.05; half way it is nearly twice as fast).
        start_time: s; before it the arm rests at the first point.
        near: (3,) rad (default 0); of the branches that can go all of it ('front/up', 'front/down', 'back/up',
            'back/down'), the one is taken that begins nearest to this pose.
        max_joint_speed, table, margin: as in `fourier`.

    Returns: CartesianPath, a Reference with `.tip(t)`, `.q_start`, `.branch`.
    Raises: UnreachableError if a point is out of reach, outside the joint limits on every branch, or under the table;
    if a joint would have to be faster than max_joint_speed: then the path passes near a singular pose, or the speed is
    too high. It says where or by how much, and what to do. InputError on a wrong shape or a number that is not finite
    or out of range.
    """
    centre, normal = vector3("centre", centre, unit="m"), vector3("normal", normal, unit="1")
    radius, size = number("radius", radius, "> 0", unit="m"), np.linalg.norm(normal)
    if not size > 1e-9:
        raise InputError(f"normal = {normal}: it has no direction; for a level circle give (0, 0, 1)")
    beside = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 * size else (0.0, 0.0, 1.0)
    second = np.cross(normal, beside)
    second *= radius / np.linalg.norm(second)
    first = np.cross(second, normal / size)

    def point(share):
        angle = 2 * math.pi * share
        return centre + np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)

    return _path(arm, point, 2 * math.pi * radius, **options)


def _path(arm, point, length, *, speed=0.05, start_time=0.0, near=(0.0, 0.0, 0.0), **bounds):
    low, high, fastest, table = limits_of(arm, **bounds)
    near, speed = vector3("near", near), number("speed", speed, "> 0", unit="m/s")
    start = number("start_time", start_time, unit="s")
    p = point(np.linspace(0, 1, _SAMPLES))
    if (outside := reachability(arm, p) > 0).any():
        raise UnreachableError(f"the path is out of reach from {np.round(p[outside.argmax()], 3)} m on: move it nearer")
    solutions = np.unwrap(inverse_kinematics(arm, p).q, axis=0)  # (n, 4, 3), each branch without jumps
    solutions += 2 * np.pi * np.rint((near - solutions[0]) / (2 * np.pi))
    over = np.maximum(low - solutions, solutions - high).max(axis=(0, 2))  # rad past the limits, of each branch
    if (over > 0).all():
        past = ", ".join(f"{branch} {x:.2f}" for branch, x in zip(BRANCHES, over, strict=True))
        raise UnreachableError(f"the path leaves the joint limits on every branch (rad: {past}): move or shorten it")
    branch = int(np.where(over <= 0, np.abs(solutions[0] - near).max(axis=1), np.inf).argmin())
    q = solutions[:, branch]
    refuse_below_table(arm.l, q, table, lambda i: f"{i / (_SAMPLES - 1):.0%} of the way")
    path = CartesianPath(arm, point, start, BRANCHES[branch], q, duration=start + length / speed)
    rates = np.abs(path.sample(np.linspace(start, path.duration, _SAMPLES))[:, 1]).max(axis=0)
    joint = int((rates / fastest).argmax())
    if rates[joint] > fastest[joint]:
        said = f"joint {joint + 1} would turn at {rates[joint]:.3g} rad/s, it may {fastest[joint]:.3g}"
        remedy = f"give a speed of at most {0.999 * speed * fastest[joint] / rates[joint]:.3g} m/s"
        raise UnreachableError(f"{said}: {remedy}, or lead the path away from the singular pose")
    return path
