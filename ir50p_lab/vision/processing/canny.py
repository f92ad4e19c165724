"""The four steps of Canny's edge detector, each in a line or few; the thesis names the first two (3.1.5)."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.processing.smoothing import convolve


@dataclass(frozen=True)
class CannySteps:
    """What each step leaves, all (h, w).

    smoothed: 1; strength = |gx| + |gy|: 2; thin: strength where it is a crest across the edge, else 0: 3;
    edges: bool, what is strong, or hangs on something strong: 4.
    """

    smoothed: np.ndarray
    strength: np.ndarray
    thin: np.ndarray
    edges: np.ndarray


def canny_steps(grey, low, high, *, kernel=None):
    """Canny's edges of a grey picture (h, w): CannySteps.

    Args: low, high: thresholds of the strength |gx| + |gy| with Sobel's kernels; kernel: of the smoothing, such as
    KERNEL_3_2, or None for a picture that is smooth already.
    The same decisions as cv2.Canny(smoothed, low, high), pixel by pixel. Raises InputError for low > high.
    """
    from scipy import ndimage

    if not 0 <= low <= high:
        raise InputError(f"thresholds low = {low}, high = {high}: give 0 <= low <= high")
    smoothed = np.asarray(grey) if kernel is None else np.rint(convolve(grey, kernel)).astype(np.uint8)
    gx, gy = (ndimage.sobel(smoothed.astype(int), axis, mode="nearest") for axis in (1, 0))  # the border is repeated
    strength = np.abs(gx) + np.abs(gy)
    thin = crest(gx, gy, strength)
    return CannySteps(smoothed, strength, thin, hysteresis(thin, low, high))


def crest(gx, gy, strength):
    """Non-maximum suppression: strength where no neighbour across the edge is stronger, else 0.

    Across: the gradient's direction, rounded to one of four. Of two equal neighbours, left and right or above and
    below, one stays.
    """
    wide = np.pad(strength, 1)
    ax, ay = np.abs(gx), np.abs(gy)
    # slopes below tan 22.5 degrees are level, above tan 67.5 upright; in integers, as OpenCV computes them
    level = (ay << 15) < ax * 13573
    upright = (ay << 15) > ax * 13573 + (ax << 16)
    falling = (gx < 0) == (gy < 0)

    def neighbour(dy, dx):
        return wide[1 + dy : wide.shape[0] - 1 + dy, 1 + dx : wide.shape[1] - 1 + dx]

    def across(side):
        neighbours = [neighbour(0, side), neighbour(side, 0), neighbour(side, side)]
        return np.select([level, upright, falling], neighbours, neighbour(side, -side))

    before, after = across(-1), across(1)
    stays = (strength > before) & ((strength > after) | ((level | upright) & (strength == after)))
    return np.where(stays, strength, 0)


def hysteresis(thin, low, high):
    """True where thin > high, and where thin > low and a chain of such pixels leads to one of those."""
    from scipy import ndimage

    pieces, _ = ndimage.label(thin > low, structure=np.ones((3, 3)))
    return np.isin(pieces, pieces[thin > high])
