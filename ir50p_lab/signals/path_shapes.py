"""Curves in space by their length: point, direction and curvature at every s in m."""

import math
from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import InputError


@dataclass(frozen=True)
class Line:
    """Straight from `start` to `end`, (3,) m each."""

    start: tuple
    end: tuple
    length: float = field(init=False)

    def __post_init__(self):
        length = math.dist(self.start, self.end)
        if length < 1e-6:
            raise InputError(f"start and end of the line are {length:.3g} m apart: give two different points (m)")
        object.__setattr__(self, "length", length)

    @property
    def grid(self):
        """Number of points at which to examine it."""
        return 801

    def __call__(self, s):
        """Point, dp/ds and d2p/ds2 at s (n,) m: three arrays (n, 3)."""
        direction = np.subtract(self.end, self.start) / self.length
        p = np.array(self.start) + s[:, None] * direction
        p[s >= self.length] = self.end
        return p, np.broadcast_to(direction, p.shape), np.zeros_like(p)

    def distance(self, p):
        """Distance of points p (n, 3) from the line (its ends included), (n,) m."""
        direction = np.subtract(self.end, self.start) / self.length
        along = np.clip((p - np.array(self.start)) @ direction, 0, self.length)
        return np.linalg.norm(p - np.array(self.start) - along[:, None] * direction, axis=1)


@dataclass(frozen=True)
class Circle:
    """About `centre` (3,) m with `radius` m in the plane normal to `normal`, from angle `phase` rad for `turns`."""

    centre: tuple
    radius: float
    normal: tuple
    turns: float = 1.0
    phase: float = 0.0
    length: float = field(init=False)

    def __post_init__(self):
        for name, unit in (("radius", "m"), ("turns", ""), ("phase", "rad")):
            value = getattr(self, name)
            if not (np.isscalar(value) and not isinstance(value, str) and math.isfinite(value)):
                raise InputError(f"{name} = {value!r} {unit}: give one finite number")
        if self.radius < 1e-6:
            raise InputError(f"radius = {self.radius} m: it must be > 0")
        if self.turns == 0 or abs(self.turns) > 100:
            raise InputError(f"turns = {self.turns}: give a number from -100 to 100, not 0")
        if not math.hypot(*self.normal) > 1e-9:
            raise InputError(f"normal = {self.normal}: it has no direction; for a level circle give (0, 0, 1)")
        object.__setattr__(self, "length", 2 * math.pi * self.radius * abs(self.turns))

    @property
    def grid(self):
        """Number of points at which to examine it."""
        return 801 * math.ceil(abs(self.turns))

    @property
    def axes(self):
        """Unit vectors of the circle's plane, towards phase 0 and 90 deg, and its normal: rows of (3, 3)."""
        n = np.array(self.normal) / math.hypot(*self.normal)
        first = np.array([1.0, 0.0, 0.0]) if abs(n[0]) < 0.99 else np.array([0.0, 0.0, 1.0])
        first = first - (first @ n) * n
        first /= np.linalg.norm(first)
        return np.stack([first, np.cross(n, first), n])

    def __call__(self, s):
        """Point, dp/ds and d2p/ds2 at s (n,) m: three arrays (n, 3)."""
        way = math.copysign(1.0, self.turns)
        angle = (self.phase + way * s / self.radius)[:, None]
        e1, e2, _ = self.axes
        out = np.cos(angle) * e1 + np.sin(angle) * e2
        along = way * (np.cos(angle) * e2 - np.sin(angle) * e1)
        return np.array(self.centre) + self.radius * out, along, -out / self.radius

    def distance(self, p):
        """Distance of points p (n, 3) from the whole circle, (n,) m."""
        e1, e2, n = self.axes
        offset = p - np.array(self.centre)
        return np.hypot(np.hypot(offset @ e1, offset @ e2) - self.radius, offset @ n)
