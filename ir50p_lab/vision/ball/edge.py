"""The outline of a ball to sub-pixel: along rays from its middle, where the colour changes most."""

from functools import cache

import numpy as np

from ir50p_lab.jit import jit


@cache
def slope_kernel(sigma):
    """Derivative of a Gaussian, sigma in samples: (k,) float32; falling by 1 at once answers with a peak of 1/2."""
    taps = np.arange(-int(3 * sigma + 1), int(3 * sigma + 1) + 1)
    kernel = -taps * np.exp(-0.5 * (taps / sigma) ** 2)
    return (kernel / np.abs(kernel).sum()).astype(np.float32)


@jit()
def cast(image, x, y, radii, relative, directions):
    """Sample the picture along rays from (x, y), one ray a row: at `relative` (m,) times `radii` (n,) or (1,) pixels.

    directions: cos and sin (n,) of the rays. Returns: distances rho (n, m) from (x, y), pixels; rgb (n, m, 3) uint8,
    bilinear, of the border outside the picture; within (n, m): the sample lies in the picture.
    """
    height, width, _ = image.shape
    n, m = len(directions[0]), len(relative)
    rho, rgb, within = np.empty((n, m)), np.empty((n, m, 3), np.uint8), np.empty((n, m), np.bool_)
    for i in range(n):
        radius, cos, sin = radii[i % len(radii)], directions[0][i], directions[1][i]
        for j in range(m):
            rho[i, j] = far = radius * relative[j]
            px, py = x + far * cos, y + far * sin
            within[i, j] = -0.5 <= px <= width - 0.5 and -0.5 <= py <= height - 0.5
            px, py = min(max(px, 0.0), width - 1.0), min(max(py, 0.0), height - 1.0)
            left, above = int(px), int(py)
            right, below = min(left + 1, width - 1), min(above + 1, height - 1)
            u, v = px - left, py - above
            for c in range(3):
                upper = image[above, left, c] * (1 - u) + image[above, right, c] * u
                lower = image[below, left, c] * (1 - u) + image[below, right, c] * u
                rgb[i, j, c] = int(upper * (1 - v) + lower * v + 0.5)
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
    sums = np.zeros((2, 4, 4), np.int64)  # in and around: of the products of 1, r, g, b with each other
    for i in range(len(within)):
        for j in range(within.shape[1]):
            if within[i, j] and not inner <= j < outer:
                one = (1, np.int64(rgb[i, j, 0]), np.int64(rgb[i, j, 1]), np.int64(rgb[i, j, 2]))
                for a in range(4):
                    for b in range(4):
                        sums[int(j >= outer), a, b] += one[a] * one[b]
    count, mean, scatter = sums[:, 0, 0], np.empty((2, 3)), 64.0 * np.eye(3)  # of noise, compression: eight levels
    for side in range(2):
        mean[side] = sums[side, 0, 1:] / max(count[side], 1)
        scatter += 0.5 * (sums[side, 1:, 1:] / max(count[side], 1) - np.outer(mean[side], mean[side]))
    step = mean[0] - mean[1]
    w = np.linalg.solve(scatter, step)
    apart = np.dot(w, step)  # squared Mahalanobis distance
    if count.min() < 12 or not apart > 1e-6:
        return np.zeros(3, np.float32), 0.0, 0.0
    w /= apart
    return w.astype(np.float32), 0.5 * np.dot(w, mean[0] + mean[1]), np.sqrt(apart)


@jit()
def find_edges(rho, rgb, within, weights, kernel, expected, width):
    """The strongest fall of contrast along each ray, near where it is expected, to a fraction of a sample.

    weights (3,): of `contrast_axis`; kernel: of `slope_kernel`; expected: index of the sample where the edge should
    be; width: in samples, how fast a peak loses weight away from it.
    Returns: distance (n,) of the edge, pixels; height (n,) of its step, in units of the ball's contrast.
    """
    n, m = within.shape
    half = len(kernel) // 2
    at, height = np.empty(n), np.empty(n)
    profile, slope = np.empty(m + 2 * half, np.float32), np.empty(m, np.float32)
    near = (1 + ((np.arange(m) - expected) / width) ** 2).astype(np.float32)
    for i in range(n):
        for j in range(m):
            profile[half + j] = rgb[i, j, 0] * weights[0] + rgb[i, j, 1] * weights[1] + rgb[i, j, 2] * weights[2]
        profile[:half], profile[half + m :] = profile[half], profile[half + m - 1]
        slope[:] = 0
        for k in range(len(kernel)):
            for j in range(m):
                slope[j] += kernel[k] * profile[k + j]
        peak = 1 + np.argmax(slope[1:-1] / near[1:-1])
        before, top, after = slope[peak - 1], slope[peak], slope[peak + 1]
        bend = before - 2 * top + after
        shift = min(max(0.5 * (before - after) / bend, -0.5), 0.5) if bend < 0 else 0.0
        at[i] = rho[i, 0] + (peak + shift) * (rho[i, 1] - rho[i, 0])
        height[i] = 2 * top * within[i, peak + 1]
    return at, height
