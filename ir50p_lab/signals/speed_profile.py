"""How far along a path at which time: a smooth start, constant speed, a smooth stop."""

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class SpeedProfile:
    """From rest at s = 0 to rest at s = length: speed rises as 3 x^2 - 2 x^3, stays, and falls likewise.

    The tangential acceleration has no jumps; its largest value is 1.5 speed/ramp.
    length: m; speed: m/s; ramp: s, length of the start and of the stop; start: s.
    """

    length: float
    speed: float
    ramp: float
    start: float = 0.0
    end: float = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "end", self.start + self.length / self.speed + self.ramp)

    def __call__(self, t):
        """s, ds/dt and d2s/dt2 at times t (n,) s: three arrays (n,), m, m/s, m/s^2."""
        total = self.end - self.start
        since = np.clip(t - self.start, 0.0, total)
        left = total - since
        x = np.minimum(np.minimum(since, left) / self.ramp, 1.0)  # 0..1 within a ramp
        travelled = self.speed * self.ramp * (x**3 - x**4 / 2)  # integral of the ramp
        cruise = self.speed * (since - self.ramp / 2)
        s = np.where(since < self.ramp, travelled, np.where(left < self.ramp, self.length - travelled, cruise))
        sd = self.speed * (x * x * (3 - 2 * x))
        sdd = np.where(since < left, 1.0, -1.0) * self.speed / self.ramp * 6 * x * (1 - x)
        return s, sd, sdd


def fastest(shape, speed, acceleration, start):
    """The profile along `shape` that keeps `speed` (m/s) and `acceleration` (m/s^2, of the tip, all directions)."""
    speed = min(speed, float(np.sqrt(acceleration * shape.length / 1.5)))  # short way: ramps only
    ramp = 1.5 * speed / acceleration
    profile = SpeedProfile(shape.length, speed, ramp, start)
    t = np.linspace(profile.start, profile.end, 4001)
    s, sd, sdd = profile(t)
    _, tangent, bend = shape(s)
    largest = np.linalg.norm(tangent * sdd[:, None] + bend * sd[:, None] ** 2, axis=1).max()
    slower = float(np.sqrt(max(1.0, largest / acceleration)))  # on a curve the centripetal part comes on top
    return SpeedProfile(shape.length, speed / slower, ramp * slower, start)
