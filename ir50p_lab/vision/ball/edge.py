"""The outline of a ball to sub-pixel: along rays from its middle, where the colour changes most."""

from functools import cache

import cv2
import numpy as np

from ir50p_lab.jit import jit


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


@jit()
def contrast_axis(rgb, within, inner, outer):
    """The direction in RGB that tells ball from surroundings best (Fisher): weights (3,), step between them = 1.

    inner, outer: the first `inner` samples of a ray lie well inside, those from `outer` on well outside. Shading
    varies along the ball and counts little, a change of colour much.
    Returns: weights float32, the level half way between the means (in units of the step), distance of the means over
    their spread (0: nothing tells them apart).
    """
    n, m = within.shape
    count, mean, scatter = np.zeros(2), np.zeros((2, 3)), np.zeros((3, 3))
    for side in range(2):
        low, high = (0, inner) if side == 0 else (outer, m)
        square = np.zeros((3, 3))
        for i in range(n):
            for k in range(low, high):
                if within[i, k]:
                    count[side] += 1
                    for a in range(3):
                        mean[side, a] += rgb[i, k, a]
                        for b in range(a + 1):
                            square[a, b] += float(rgb[i, k, a]) * rgb[i, k, b]
        if count[side] < 12:
            return np.zeros(3, np.float32), 0.0, 0.0
        for a in range(3):
            mean[side, a] /= count[side]
            for b in range(a + 1):
                scatter[a, b] += 0.5 * (square[a, b] / count[side] - mean[side, a] * mean[side, b])
    for a in range(3):
        scatter[a, a] += 64.0  # of noise and compression: eight levels
        for b in range(a):
            scatter[b, a] = scatter[a, b]
    d = mean[0] - mean[1]
    # the 3 x 3 system scatter w = d by cross products (Cramer)
    p, q, r = np.cross(scatter[1], scatter[2]), np.cross(scatter[2], scatter[0]), np.cross(scatter[0], scatter[1])
    det = scatter[0, 0] * p[0] + scatter[0, 1] * p[1] + scatter[0, 2] * p[2]
    w = (p * d[0] + q * d[1] + r * d[2]) / det
    apart = w[0] * d[0] + w[1] * d[1] + w[2] * d[2]  # squared Mahalanobis distance
    if not apart > 1e-6:
        return np.zeros(3, np.float32), 0.0, 0.0
    middle = 0.5 * np.sum(w * (mean[0] + mean[1])) / apart
    return (w / apart).astype(np.float32), middle, np.sqrt(apart)


@jit()
def find_edges(rho, rgb, within, weights, kernel, expected, width):
    """The strongest fall of contrast along each ray, near where it is expected, to a fraction of a sample.

    weights (3,): of `contrast_axis`; kernel: of `slope_kernel`; expected: index of the sample where the edge should
    be; width: in samples, how fast a peak loses weight away from it; both floats.
    Returns: distance (n,) of the edge, pixels; height (n,) of its step, in units of the ball's contrast.
    """
    n, m = within.shape
    at, height = np.zeros(n), np.zeros(n)
    half = len(kernel) // 2
    profile, slope = np.empty(m), np.empty(m)
    for i in range(n):
        for k in range(m):
            profile[k] = weights[0] * rgb[i, k, 0] + weights[1] * rgb[i, k, 1] + weights[2] * rgb[i, k, 2]
        best, peak = -np.inf, 0
        for k in range(m):
            total = 0.0
            for j in range(-half, half + 1):
                total += kernel[half + j] * profile[min(max(k + j, 0), m - 1)]
            slope[k] = total
        for k in range(1, m - 1):
            weighed = slope[k] / (1 + ((k - expected) / width) ** 2)
            if weighed > best:
                best, peak = weighed, k
        bend = slope[peak - 1] - 2 * slope[peak] + slope[peak + 1]
        shift = 0.5 * (slope[peak - 1] - slope[peak + 1]) / bend if bend < -1e-9 else 0.0
        at[i] = rho[i, 0] + (peak + min(max(shift, -0.5), 0.5)) * (rho[i, 1] - rho[i, 0])
        height[i] = 2 * slope[peak] if within[i, peak + 1] else 0.0
    return at, height
