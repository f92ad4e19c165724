"""The four steps of Canny's edge detector, each to be looked at; the thesis names the first two (3.1.5)."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.processing.smoothing import convolve


@dataclass(frozen=True)
class CannySteps:
    """The result of each step, all (h, w).

    1 smoothed; 2 strength = |gx| + |gy|; 3 thin: strength where no neighbour across the edge is stronger, else 0;
    4 edges: bool, pixels that are strong, or connected to a strong one.
    """

    smoothed: np.ndarray
    strength: np.ndarray
    thin: np.ndarray
    edges: np.ndarray


def canny_steps(grey, low, high, *, kernel=None):
    """Canny's edges of a grey picture (h, w): CannySteps.

    Args: low, high: thresholds of the strength |gx| + |gy| with Sobel's kernels; kernel: of the smoothing, such as
    KERNEL_3_2, or None for a picture that is smooth already.
    Non-maximum suppression keeps strength where no neighbour across the edge is stronger, the gradient's direction
    rounded to one of four. Hysteresis keeps pixels above `high`, and those above `low` that a chain of such pixels
    connects to them. Both are those of cv2.Canny. Raises InputError for low > high.
    """
    import cv2

    if not 0 <= low <= high:
        raise InputError(f"thresholds low = {low}, high = {high}: give 0 <= low <= high")
    smoothed = np.asarray(grey) if kernel is None else np.rint(convolve(grey, kernel)).astype(np.uint8)
    along = ((1, 0), (0, 1))
    gx, gy = (cv2.Sobel(smoothed, cv2.CV_16S, *axis, borderType=cv2.BORDER_REPLICATE).astype(int) for axis in along)
    strength = np.abs(gx) + np.abs(gy)
    crests, edges = (cv2.Canny(smoothed, *thresholds) > 0 for thresholds in ((0, 0), (low, high)))
    return CannySteps(smoothed, strength, np.where(crests, strength, 0), edges)
