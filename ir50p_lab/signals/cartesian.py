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

_STEP = 1e-4  # s, of the differences


@dataclass(frozen=True)
class CartesianPath(Reference):
    """A path of the tip as joint reference, from rest to rest; made by `cartesian_line` and `cartesian_circle`.

    point: function of the share of the way (n,) -> (n, 3) m; start, duration: s; branch: of the four solutions, kept
    throughout; near: (3,) rad, the turn of each joint. Before and after the motion it rests.
    """

    arm: Arm
    point: object = field(compare=False)
    start: float
    branch: str
    near: tuple
    duration: float = field(kw_only=True)

    def _rows(self, t):
        before, q, after = (self._pose(t + k * _STEP) for k in (-1, 0, 1))
        return np.stack([q, (after - before) / (2 * _STEP), (after - 2 * q + before) / _STEP**2], axis=1)

    def _pose(self, t):
        q = inverse_kinematics(self.arm, self.tip(t)).q[:, BRANCHES.index(self.branch)]
        return q + 2 * np.pi * np.rint((np.array(self.near) - q) / (2 * np.pi))

    def tip(self, t):
        """Where the tip shall be at one time t (3,) or at times (n,), (n, 3), in s; m."""
        x = np.clip((np.asarray(t, dtype=float) - self.start) / (self.duration - self.start), 0.0, 1.0)
        p = self.point(np.atleast_1d(x**3 * (10 - 15 * x + 6 * x**2)))
        return p if np.ndim(t) else p[0]

    @property
    def q_start(self):
        """Pose in which the path begins, (3,) rad: move there first, for instance with `quintic`."""
        return self._pose(np.array([self.start]))[0]


def cartesian_line(arm, start, end, **options):
    """The tip on a straight line between two points (3,) m, from rest to rest; options as of `cartesian_circle`."""
    start, end = vector3("start", start, unit="m"), vector3("end", end, unit="m")
    if not (length := math.dist(start, end)) > 1e-6:
        raise InputError(f"start and end of the line are {length:.3g} m apart: give two different points (m)")
    return _path(arm, lambda x: start + np.outer(x, end - start), length, **options)


def cartesian_circle(arm, centre, radius, *, normal=(0.0, 0.0, 1.0), **options):
    """The tip once round a circle about `centre` (3,) m, from rest to rest.

    Args: radius: m; normal: (3,) axis of the circle; speed: m/s, mean (default 0.05); start_time: s, before it the arm
    rests; near: (3,) rad, of the branches that can go all of it the one that begins nearest is taken; max_joint_speed,
    table, margin: as in `fourier`.

    Returns: CartesianPath, a Reference with `.tip(t)`, `.q_start`, `.branch`.
    Raises: UnreachableError out of reach, outside the joint limits on every branch, under the table, or where a joint
    would have to be too fast: it says where. InputError on wrong shapes or numbers.
    """
    centre, normal = vector3("centre", centre, unit="m"), vector3("normal", normal)
    radius = number("radius", radius, "> 0", unit="m")
    first = np.cross([0, 1, 0] if abs(normal[0]) < 0.9 * np.linalg.norm(normal) else [0, 0, 1], normal)
    if not np.linalg.norm(first) > 0:
        first = np.cross([1, 0, 0], normal)
    first = first / np.linalg.norm(first)
    second = np.cross(normal / np.linalg.norm(normal), first)
    arc = 2 * math.pi
    return _path(
        arm,
        lambda x: centre + radius * (np.outer(np.cos(arc * x), first) + np.outer(np.sin(arc * x), second)),
        arc * radius,
        **options,
    )


def _path(arm, point, length, *, speed=0.05, start_time=0.0, near=(0.0, 0.0, 0.0), **bounds):
    low, high, fastest, table = limits_of(arm, **bounds)
    near, speed = vector3("near", near), number("speed", speed, "> 0", unit="m/s")
    p = point(np.linspace(0, 1, 400))
    if (outside := reachability(arm, p)).any():
        where = np.round(p[outside.argmax()], 3).tolist()
        raise UnreachableError(f"{np.mean(outside > 0):.0%} of the path is out of reach, worst at {where} m")
    solutions = np.unwrap(inverse_kinematics(arm, p).q, axis=0)  # (n, 4, 3)
    solutions += 2 * np.pi * np.rint((near - solutions[:1]) / (2 * np.pi))
    over = np.maximum(low - solutions, solutions - high).max(axis=(0, 2))
    if not (over <= 0).any():
        missing = ", ".join(f"{branch} {x:.2f}" for branch, x in zip(BRANCHES, over, strict=True))
        raise UnreachableError(f"the path leaves the joint limits on every branch (rad: {missing}): move or shorten it")
    branch = int(np.where(over <= 0, np.abs(solutions[0] - near).max(axis=1), np.inf).argmin())
    refuse_below_table(arm.l, solutions[:, branch], table, lambda i: f"{i / 4:.0f} % of the way")
    middle = tuple(solutions[:, branch].mean(axis=0).tolist())
    start = number("start_time", start_time, unit="s")
    path = CartesianPath(arm, point, start, BRANCHES[branch], middle, duration=start + length / speed)
    rates = np.abs(path.sample(np.linspace(start, path.duration, 400))[:, 1]).max(axis=0)
    if (rates > fastest).any():
        joint = int(np.argmax(rates / fastest))
        said = f"joint {joint + 1} would have to turn at {rates[joint]:.3g} rad/s, its bound is {fastest[joint]:.3g}"
        raise UnreachableError(f"{said}: give a lower speed, or lead the path away from the singular poses")
    return path
