"""Where a ball might be: circles that fit the regions of its colour. Most are none; each is measured afterwards."""

from itertools import chain

import cv2
import numpy as np

_LONGER_SIDE = 640  # px of the copy that is searched
_STRICTNESS = (0.0, 0.45, 0.62)  # least saturations tried: a saturated ball stands out from wood under warm light
_REGIONS = 10  # of a mask, longest outline first
_ARCS = 3  # circles through parts of an outline that is not round
_INSCRIBED = 4  # circles drawn into its region
_ROUND = (0.07, 0.7)  # shares of the radius, px: an outline within the larger of both (rms) is one circle
_NEW = 0.25  # of a radius: a circle nearer than this to an earlier one, place and size together, is the same guess


def guess_circles(image, colour, least_radius):
    """Circles [(x, y, r)] px that regions of a Colour in an RGB picture (h, w, 3) may be: first the round regions."""
    scale = max(1, round(max(image.shape) / _LONGER_SIDE))
    small = image
    if scale > 1:
        small = cv2.resize(image, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_AREA)
    found = []
    for mask in _masks(small, colour):
        outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        for outline in sorted(outlines, key=len, reverse=True)[:_REGIONS]:
            if len(outline) >= max(8, 4 * least_radius / scale):
                found.append(_circles(outline, mask))
    different = []
    for x, y, r in chain.from_iterable(sorted(found, key=lambda circles: len(circles) > 1)):
        x, y, r = (x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5, (r + 0.5) * scale
        new = all(np.hypot(x - a, y - b) + abs(r - c) > _NEW * max(r, c) for a, b, c in different)
        if r > 0.7 * least_radius and new:
            different.append((x, y, r))
    return different


def _masks(image, colour):
    """Masks (h, w) of the colour: strict, stricter, as dim or glaring light shows it, and two halves of that."""
    hsv = colour.hsv_of(image)
    three, five = np.ones((3, 3), np.uint8), np.ones((5, 5), np.uint8)
    for saturation in _STRICTNESS:
        yield cv2.morphologyEx(cv2.inRange(hsv, *colour.bounds(saturation)), cv2.MORPH_OPEN, three)
    loose = colour.loose_mask(colour.hsv_of(cv2.GaussianBlur(image, (0, 0), 1.5)))
    yield cv2.morphologyEx(loose, cv2.MORPH_CLOSE, five)
    if loose.any():
        for channel in (1, 0):  # the more saturated part of it, and the part of higher hue: of red, the less orange
            level, _ = cv2.threshold(hsv[..., channel][loose > 0], 0, 255, cv2.THRESH_OTSU)
            part = cv2.inRange(hsv[..., channel], level + 1, 255) & loose
            yield cv2.morphologyEx(part, cv2.MORPH_OPEN, three)


def _circles(outline, mask):
    """Circles [(x, y, r)] of one outline (n, 1, 2): through all of it, else through arcs of it, and inscribed ones."""
    points = outline[:, 0].astype(float)
    x, y, r = _circle_through(points)
    off = np.hypot(points[:, 0] - x, points[:, 1] - y) - r
    if r < max(mask.shape) and np.sqrt(np.mean(off**2)) < max(_ROUND[0] * r, _ROUND[1]):
        return [(x, y, r)]
    left, top, width, height = cv2.boundingRect(outline)
    region = mask[top : top + height, left : left + width]
    region = cv2.morphologyEx(region, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    region = cv2.copyMakeBorder(region, 9, 9, 9, 9, cv2.BORDER_CONSTANT)
    inside, found = cv2.distanceTransform(region, cv2.DIST_L2, 5), []
    for _ in range(_INSCRIBED):
        _, r, _, middle = cv2.minMaxLoc(inside)
        if r < 2:
            break
        found.append((*middle, r))
        cv2.circle(inside, middle, int(1.2 * r), 0, -1)
    return _by_arcs(points, max(width, height)) + [(x + left - 9, y + top - 9, r) for x, y, r in found]


def _by_arcs(points, largest):
    """Circles [(x, y, r)] through three points of an outline (n, 2), chosen for how much of it lies on them.

    largest: px, radius of which more than a quarter would be seen.
    """
    found = []
    while len(points) >= 8 and len(found) < _ARCS:
        first, step = (part.ravel() for part in np.meshgrid(np.arange(0, 1, 1 / 24), (0.06, 0.12, 0.2, 0.33)))
        p, q, s = (points[((first + k * step) * len(points)).astype(int) % len(points)] for k in range(3))
        a, b = q - p, s - p
        area = 2 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        aa, bb = (a * a).sum(axis=1), (b * b).sum(axis=1)
        with np.errstate(all="ignore"):
            middle = np.column_stack([b[:, 1] * aa - a[:, 1] * bb, a[:, 0] * bb - b[:, 0] * aa]) / area[:, None]
        r = np.hypot(*middle.T)
        usable = np.isfinite(r) & (r > 3) & (r < largest)
        if not usable.any():
            break
        middle, r = (middle + p)[usable], r[usable]
        near = np.abs(np.hypot(*(points[:, None] - middle).transpose(2, 0, 1)) - r) < np.maximum(0.04 * r, 1.0)
        best = near.sum(axis=0).argmax()
        found.append((*middle[best], r[best]))
        points = points[~near[:, best]]
    return found


def _circle_through(points):
    """The circle (x, y, r) through points (n, 2), by linear least squares: x^2 + y^2 = a x + b y + c."""
    A = np.column_stack([points, np.ones(len(points))])
    (a, b, c), *_ = np.linalg.lstsq(A, (points**2).sum(axis=1))
    return a / 2, b / 2, np.sqrt(max(c + (a * a + b * b) / 4, 0.0))
