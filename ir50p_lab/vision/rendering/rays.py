"""The rays of a picture: one through the middle of every pixel, or many through some of them."""

import functools
from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.pinhole import Pinhole


@dataclass(frozen=True, eq=False)
class Rays:
    """Directions (x, y, 1) in camera coordinates: x, y (n,), with the pixels px, py (n,) they go through.

    length2 = x^2 + y^2 + 1.
    """

    x: np.ndarray
    y: np.ndarray
    length2: np.ndarray
    px: np.ndarray
    py: np.ndarray

    def near(self, box):
        """Index of the rays whose pixel is in the box (x0, y0, x1, y1); None is everywhere."""
        if box is None:
            return slice(None)
        x0, y0, x1, y1 = box
        return np.flatnonzero((self.px >= x0) & (self.px <= x1) & (self.py >= y0) & (self.py <= y1))

    def at(self, index):
        """The rays of an index."""
        return Rays(self.x[index], self.y[index], self.length2[index], self.px[index], self.py[index])


def grid_rays(pinhole):
    """Rays through the middle of every pixel of the picture, row by row (kept for the next one of the same camera)."""
    return _grid(pinhole.K.tobytes(), pinhole.distortion.tobytes(), pinhole.size)


def rays_through(pinhole, px, py):
    """Rays through pixels px, py (n,), in parts of a pixel."""
    x, y = np.moveaxis(pinhole.undistort_points(np.stack([px, py], axis=-1)), -1, 0)
    return Rays(x, y, x * x + y * y + 1, px, py)


@functools.lru_cache(maxsize=8)
def _grid(K, distortion, size):
    pinhole = Pinhole(np.frombuffer(K).reshape(3, 3), np.frombuffer(distortion), size)
    py, px = (axis.ravel().astype(float) for axis in np.indices(size[::-1]))
    exact = rays_through(pinhole, px, py)
    x, y, px, py = (array.astype(np.float32) for array in (exact.x, exact.y, px, py))
    return Rays(x, y, x * x + y * y + 1, px, py)
