"""Curves in space by their length: point, direction and curvature at every s in m."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Line:
    """Straight from `start` to `end`, (3,) m each."""

    start: tuple
    end: tuple

    @property
    def length(self):
        """Of the line, m."""
        return math.dist(self.start, self.end)

    def __call__(self, s):
        """Point, dp/ds and d2p/ds2 at s (...) m: three arrays (..., 3)."""
        direction = np.subtract(self.end, self.start) / self.length
        s = s[..., None]
        p = np.where(s >= self.length, self.end, self.start + s * direction)
        return p, np.broadcast_to(direction, p.shape), np.zeros_like(p)


@dataclass(frozen=True)
class Circle:
    """About `centre` (3,) m with `radius` m in the plane normal to `normal`, from angle `phase` rad for `turns`."""

    centre: tuple
    radius: float
    normal: tuple
    turns: float
    phase: float

    @property
    def length(self):
        """Of the path, m."""
        return 2 * math.pi * self.radius * abs(self.turns)

    def __call__(self, s):
        """Point, dp/ds and d2p/ds2 at s (...) m: three arrays (..., 3)."""
        normal = np.array(self.normal) / math.hypot(*self.normal)
        first = np.array([1.0, 0.0, 0.0]) if abs(normal[0]) < 0.99 else np.array([0.0, 0.0, 1.0])
        first = first - (first @ normal) * normal  # towards phase 0
        first /= np.linalg.norm(first)
        second = np.cross(normal, first)
        sense = math.copysign(1.0, self.turns)
        angle = (self.phase + sense * s / self.radius)[..., None]
        out = np.cos(angle) * first + np.sin(angle) * second
        along = sense * (np.cos(angle) * second - np.sin(angle) * first)
        return np.array(self.centre) + self.radius * out, along, -out / self.radius
