"""The outline of a ball to sub-pixel: along rays from its middle, where the colour changes most."""

from functools import cache

import cv2
import numpy as np


@cache
def slope_kernel(sigma):
    """Derivative of a Gaussian, sigma in samples: (k,) float32; falling by 1 at once answers with a peak of 1/2."""
    taps = np.arange(-int(3 * sigma + 1), int(3 * sigma + 1) + 1)
    kernel = -taps * np.exp(-0.5 * (taps / sigma) ** 2)
    return (kernel / np.abs(kernel).sum()).astype(np.float32)


def cast(image, x, y, radii, relative, directions):
    """Sample the picture along rays from (x, y), one ray a row: at `relative` (m,) times `radii` (n,) or (1,) pixels.

    directions: cos and sin (n,) of the rays. Returns: distances rho (n, m) from (x, y), pixels; rgb (n, m, 3) uint8;
    within (n, m): the sample lies in the picture.
    """
    cos, sin = directions
    rho = np.multiply.outer(np.broadcast_to(radii, cos.shape), relative).astype(np.float32)
    px, py = rho * cos[:, None], rho * sin[:, None]
    px += np.float32(x)
    py += np.float32(y)
    height, width = image.shape[:2]
    rgb = cv2.remap(image, px, py, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    within = (px >= -0.5) & (px <= width - 0.5) & (py >= -0.5) & (py <= height - 0.5)
    return rho, rgb, within


@cache
def directions(n):
    """Unit vectors (cos (n,), sin (n,)) all around, float32."""
    angle = np.arange(n, dtype=np.float32) * np.float32(2 * np.pi / n)
    return np.cos(angle), np.sin(angle)


def contrast_axis(rgb, within, inner, outer):
    """The direction in RGB that tells ball from surroundings best (Fisher): weights (3,), step between them = 1.

    inner, outer: the first `inner` samples of a ray lie well inside, those from `outer` on well outside. Shading
    varies along the ball and counts little, a change of colour much.
    Returns: weights float32, the level half way between the means (in units of the step), distance of the means over
    their spread (0: nothing tells them apart).
    """
    parts = slice(inner), slice(outer, None)
    sides = [rgb[:, part].reshape(-1, 3).compress(within[:, part].ravel(), axis=0) for part in parts]
    if min(map(len, sides)) < 12:
        return np.zeros(3, np.float32), 0.0, 0.0
    scaled = cv2.COVAR_NORMAL | cv2.COVAR_ROWS | cv2.COVAR_SCALE
    (covariance, inside), (around, outside) = (cv2.calcCovarMatrix(side, None, scaled) for side in sides)
    scatter = 0.5 * (covariance + around) + 64.0 * np.eye(3)  # of noise and compression: eight levels
    step = (inside - outside)[0]
    w = np.linalg.solve(scatter, step)
    apart = float(w @ step)  # squared Mahalanobis distance
    if not apart > 1e-6:
        return np.zeros(3, np.float32), 0.0, 0.0
    w = (w / apart).astype(np.float32)
    return w, 0.5 * float(w @ (inside + outside)[0]), apart**0.5


def find_edges(rho, rgb, within, weights, kernel, expected, width):
    """The strongest fall of contrast along each ray, near where it is expected, to a fraction of a sample.

    weights (3,): of `contrast_axis`; kernel: of `slope_kernel`; expected: index of the sample where the edge should
    be; width: in samples, how fast a peak loses weight away from it.
    Returns: distance (n,) of the edge, pixels; height (n,) of its step, in units of the ball's contrast.
    """
    profile = cv2.transform(rgb.astype(np.float32), weights[None])
    slope = cv2.filter2D(profile, -1, kernel[None], borderType=cv2.BORDER_REPLICATE)
    near = 1 + ((np.arange(slope.shape[1]) - expected) / width) ** 2
    peak = 1 + np.argmax((slope / near)[:, 1:-1], axis=1)
    ray = np.arange(len(slope))
    before, top, after = slope[ray, peak - 1], slope[ray, peak], slope[ray, peak + 1]
    bend = before - 2 * top + after
    shift = np.where(bend < 0, np.clip(0.5 * (before - after) / np.minimum(bend, -1e-9), -0.5, 0.5), 0)
    at = rho[:, 0] + (peak + shift) * (rho[:, 1] - rho[:, 0])
    return at, 2 * top * within[ray, peak + 1]
