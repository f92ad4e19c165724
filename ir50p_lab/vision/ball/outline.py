"""The outline of a ball to a fraction of a pixel: edges along rays from its middle, and the cone of sight through them.

The lines of sight that touch a sphere form a round cone about the direction n of its centre, with half opening angle
alpha. For the unit direction d of each edge point

    d . n = cos(alpha),  so with m = n / cos(alpha):  d . m = 1,

which are linear equations in three unknowns, as for a circle, but with perspective and lens included exactly. The
picture shows an ellipse, stretched away from the axis, and the centre of the sphere is not seen in its middle.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.vision.ball.rays import RAYS, UNIT, cast

# Of each pass, in radii: how far inside and outside the circle edges are sought, and how near to it they are preferred.
_PASSES = ((0.6, 0.3), (0.45, 0.2), (0.3, 0.15))
_SAMPLES = 41  # samples along a ray
_EDGE = 0.3  # share of the contrast between ball and surroundings: a lower step is no edge
_NOISE = 64.0  # grey levels squared, added to the variances of colours: an even surface has no endless contrast
_LEAST_CONTRAST = 1.0  # if disc and surroundings differ by less (squared, in variances), no outline can be measured


@dataclass(frozen=True)
class Outline:
    """A measured outline, or the reason why there is none.

    x, y: middle, px; radius: of the circle of the same area, px; centre: (2,) px, where the sphere's centre is seen;
    off: (rays,) px by which the edge lies outside, inf where there is none; height: (rays,) of the edges, in units of
    the contrast; seen: share of the outline that is in the picture; contrast: of the disc against its surroundings, in
    standard deviations; why: the reason why there is no outline, else "".
    """

    x: float
    y: float
    radius: float
    why: str = ""
    centre: np.ndarray = None
    off: np.ndarray = None
    height: np.ndarray = None
    seen: float = 0.0
    contrast: float = 0.0

    @property
    def on(self):
        """Whether each of the rays (rays,) has its edge on the outline, within 5 % of the radius or 1.2 px."""
        return np.abs(self.off) < max(1.2, 0.05 * self.radius)


def measure(image, pinhole, circle):
    """Return the Outline near a circle (x, y, r) px in an RGB picture (h, w, 3) that a camera (Pinhole) took."""
    x, y, r = circle
    for half, width in _PASSES:
        rho = r * np.linspace(1 - half, 1 + half, _SAMPLES)
        rgb, within = cast(image, x, y, rho)
        contrast, profile = _contrast(rho, rgb, within, r)
        if profile is None:
            return Outline(x, y, r, "it looks like its surroundings")
        at, height = _edges(rho, profile, within, r, width * r)
        if (height > _EDGE).sum() < 10:
            return Outline(x, y, r, "no edge around it")
        points = (x, y) + at[:, None] * UNIT
        found = _fit(pinhole, points, at, height > _EDGE, r)
        if found is None or not 0.4 * r < found[2] < 2.5 * r:
            return Outline(x, y, r, "its edges lie on no circle")
        x, y, r, centre, off = found
    return Outline(x, y, r, "", centre, off, height, float(within[:, _SAMPLES // 2].mean()), contrast)


def _contrast(rho, rgb, within, r):
    """(contrast of disc and surroundings in standard deviations, the colours as numbers (rays, m) or None).

    The numbers are the colours along Fisher's axis, on which both differ most; inside they are larger by 1 on average.
    """
    inner, outer = rho < 0.85 * r, rho > 1.12 * r
    inside, outside = (rgb[:, part][within[:, part]].astype(float) for part in (inner, outer))
    if min(len(inside), len(outside)) < 20:
        return 0.0, None
    step = inside.mean(axis=0) - outside.mean(axis=0)
    axis = np.linalg.solve((np.cov(inside.T) + np.cov(outside.T)) / 2 + _NOISE * np.eye(3), step)
    squared = float(step @ axis)
    return np.sqrt(squared), None if squared < _LEAST_CONTRAST else rgb @ (axis / squared)


def _edges(rho, profile, within, r, width):
    """Distance (rays,) px and height (rays,) of the steepest fall of each profile (rays, m), near r by preference."""
    pace = rho[1] - rho[0]
    sigma = max(1.2, 0.025 * r) / pace  # samples; smoothing before the slope is taken
    kernel = cv2.getGaussianKernel(2 * int(3 * sigma) + 3, sigma).T
    slope = -np.gradient(cv2.filter2D(profile, -1, kernel, borderType=cv2.BORDER_REPLICATE), axis=1)
    peak = 1 + (slope / (1 + ((rho - r) / width) ** 2))[:, 1:-1].argmax(axis=1)
    rows = np.arange(RAYS)
    before, top, after = (slope[rows, peak + k] for k in (-1, 0, 1))
    bend = np.minimum(before - 2 * top + after, -1e-9)
    shift = np.clip((before - after) / (2 * bend), -0.5, 0.5)  # vertex of the parabola through the three
    height = top * np.sqrt(2 * np.pi) * sigma * within[rows, peak + 1]
    return rho[0] + (peak + shift) * pace, height


def _fit(pinhole, points, at, strong, r):
    """(x, y, radius, centre, off) of the cone through those edge points (rays, 2) that are `strong`, or None.

    The farther a point is off the last fit, the less it weighs (biweight). The first fit is a circle whose radius is
    the median of the distances `at` (rays,) px.
    """
    xy = pinhole.undistort_or_nan(points)
    strong = strong & np.isfinite(xy).all(axis=1)
    d = np.column_stack([np.nan_to_num(xy), np.ones(RAYS)])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    off, scale = np.where(strong, at - np.median(at[strong]), np.inf), max(0.2 * r, 2.0)
    for _ in range(8):
        weight = np.maximum(1 - (off / scale) ** 2, 0.0)
        m, *_ = np.linalg.lstsq(d * weight[:, None], weight)
        length = np.linalg.norm(m)
        if (weight > 0).sum() < 8 or length <= 1:
            return None
        n, cosine = m / length, 1 / length
        apart = n[2] ** 2 - (1 - cosine**2)  # cos^2 of the centre's angle to the axis, less sin^2(alpha)
        if apart <= 0:
            return None
        alpha = np.arccos(cosine)
        radius = pinhole.fx * np.sin(alpha) * np.sqrt(cosine) / apart**0.75
        off = np.where(strong, radius * (np.arccos(np.clip(d @ n, -1, 1)) / alpha - 1), np.inf)
        scale = max(0.6 * scale, 0.8)
    middle, centre = pinhole.to_pixels(pinhole.distort(np.array([n[:2] * n[2] / apart, n[:2] / n[2]])))
    return *middle, radius, centre, off
