"""The rays of a picture: one through the middle of every pixel, or many through some of them."""

import functools
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Rays:
    """Directions (x, y, 1) in camera coordinates: x, y (n,), and length2 = x^2 + y^2 + 1."""

    x: np.ndarray
    y: np.ndarray
    length2: np.ndarray

    def near(self, corners):
        """Index of the rays that pass through a sphere around points (n, 3)."""
        a, b, c = middle = corners.mean(axis=0)
        outside = middle @ middle - 1.01 * np.max(np.sum((corners - middle) ** 2, axis=1))
        if outside <= 0:  # the camera is within
            return slice(None)
        along = self.x * float(a) + self.y * float(b) + float(c)
        return np.flatnonzero((along > 0) & (along * along >= self.length2 * float(outside)))

    def at(self, index):
        """The rays of an index."""
        return Rays(self.x[index], self.y[index], self.length2[index])


@functools.lru_cache(maxsize=8)
def grid_rays(pinhole):
    """Rays through the middle of every pixel of the picture, row by row (kept for the next one of the same camera)."""
    py, px = (axis.ravel().astype(float) for axis in np.indices(pinhole.size[::-1]))
    exact = rays_through(pinhole, px, py)
    x, y = exact.x.astype(np.float32), exact.y.astype(np.float32)
    return Rays(x, y, x * x + y * y + 1)


def rays_through(pinhole, px, py):
    """Rays through pixels px, py (n,), in parts of a pixel."""
    x, y = np.moveaxis(pinhole.undistort_points(np.stack([px, py], axis=-1)), -1, 0)
    return Rays(x, y, x * x + y * y + 1)
