"""The four steps of Canny's edge detector, each in a line or few; the thesis names the first two (3.1.5)."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.processing.smoothing import convolve


@dataclass(frozen=True)
class CannySteps:
    """What each step leaves, all (h, w).

    smoothed: 1; gx, gy, strength = |gx| + |gy|: 2; thin: strength where it is a crest across the edge, else 0: 3;
    edges: bool, what is strong, or hangs on something strong: 4.
    """

    smoothed: np.ndarray
    gx: np.ndarray
    gy: np.ndarray
    strength: np.ndarray
    thin: np.ndarray
    edges: np.ndarray


def canny_steps(grey, low, high, *, kernel=None):
    """Canny's edges of a grey picture (h, w): CannySteps.

    Args: low, high: thresholds of the strength |gx| + |gy| with Sobel's kernels; kernel: of the smoothing, such as
    KERNEL_3_2, or None for a picture that is smooth already.
    The same decisions as cv2.Canny(smoothed, low, high), pixel by pixel. Raises InputError for low > high.
    """
    if not 0 <= low <= high:
        raise InputError(f"thresholds low = {low}, high = {high}: give 0 <= low <= high")
    smoothed = np.asarray(grey) if kernel is None else np.rint(convolve(grey, kernel)).astype(np.uint8)
    gx, gy = gradient(smoothed)
    strength = np.abs(gx) + np.abs(gy)
    thin = crest(gx, gy, strength)
    return CannySteps(smoothed, gx, gy, strength, thin, hysteresis(thin, low, high))


def gradient(grey):
    """Derivatives (gx, gy) along x and y, int (h, w), by Sobel's kernels; the border is repeated."""
    from scipy import ndimage

    grey = np.asarray(grey).astype(int)
    return tuple(ndimage.sobel(grey, axis, mode="nearest") for axis in (1, 0))


def crest(gx, gy, strength):
    """Non-maximum suppression: strength where no neighbour across the edge is stronger, else 0.

    Across: the gradient's direction, rounded to one of four. Of two equal neighbours one stays.
    """
    wide = np.pad(strength, 1)
    ax, ay = np.abs(gx), np.abs(gy)
    # slopes below tan 22.5 degrees are level, above tan 67.5 upright; in integers, as OpenCV computes them
    level = (ay << 15) < ax * 13573
    upright = (ay << 15) > ax * 13573 + (ax << 16)

    def neighbour(dy, dx):
        return wide[1 + dy : wide.shape[0] - 1 + dy, 1 + dx : wide.shape[1] - 1 + dx]

    along = np.where((gx < 0) != (gy < 0), -1, 1)
    falling = np.where(along == 1, neighbour(-1, -1), neighbour(-1, 1))
    rising = np.where(along == 1, neighbour(1, 1), neighbour(1, -1))
    stays = np.where(
        level,
        (strength > neighbour(0, -1)) & (strength >= neighbour(0, 1)),
        np.where(
            upright,
            (strength > neighbour(-1, 0)) & (strength >= neighbour(1, 0)),
            (strength > falling) & (strength > rising),
        ),
    )
    return np.where(stays, strength, 0)


def hysteresis(thin, low, high):
    """True where thin > high, and where thin > low and a chain of such pixels leads to one of those."""
    from scipy import ndimage

    pieces, n = ndimage.label(thin > low, structure=np.ones((3, 3)))
    strong = np.zeros(n + 1, bool)
    strong[pieces[thin > high]] = True
    strong[0] = False
    return strong[pieces]
