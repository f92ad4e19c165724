"""Where a ball might be: circles that fit the regions of its colour. Most are none; each is measured afterwards.

Most of them are none; each is measured afterwards.
"""

import cv2
import numpy as np
from scipy.spatial.distance import cdist

_LONGER_SIDE = 640  # px: the picture is searched in a copy reduced to about this
_STRICTNESS = (0.0, 0.45, 0.62)  # least saturations tried: a saturated ball stands out from wood under warm light
_COVERED = 0.2  # share of the picture: if more has the colour, the table has it; what differs from that is looked for
_REGIONS = 10  # regions of a mask looked at, longest outline first
_ARCS = 3  # circles sought on one outline: balls that touch share one
# Circles go through three points of an outline: so many first points, and steps to the others as shares of its length.
_STARTS, _STEPS = 24, (0.06, 0.12, 0.2, 0.33)
_NEAR = (0.04, 1.0)  # radii, px: a point of the outline is on the circle if it is nearer than the larger of both
_NEW = 0.25  # radii: if a circle differs less from an earlier one, place and size added, it is the same guess


def guess_circles(image, colour, least_radius):
    """Return circles [(x, y, r)] px that may fit regions of a Colour in an RGB picture (h, w, 3).

    Those with the longest arcs come first. least_radius: px; those well below it are left out.
    """
    scale = max(1, round(max(image.shape) / _LONGER_SIDE))
    small = cv2.resize(image, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_AREA)
    found = []
    for mask in _masks(small, colour):
        outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        for outline in sorted(outlines, key=len, reverse=True)[:_REGIONS]:
            if len(outline) >= max(8, 4 * least_radius / scale):
                found += _circles(outline[:, 0].astype(float))
    different = []
    for _, *circle in sorted(found, reverse=True):
        x, y, r = (np.array(circle) + 0.5) * scale - (0.5, 0.5, 0)
        new = all(np.hypot(x - a, y - b) + abs(r - c) > _NEW * max(r, c) for a, b, c in different)
        if r > 0.7 * least_radius and new:
            different.append((x, y, r))
    return different


def _masks(image, colour):
    """Masks (h, w) of the colour: for three least saturations, a loose one for dim or glaring light, and if the table
    has the colour, too, what is left of that without the table.
    """
    hsv = colour.hsv_of(image)
    three, five = np.ones((3, 3), np.uint8), np.ones((5, 5), np.uint8)
    for saturation in _STRICTNESS:
        yield cv2.morphologyEx(cv2.inRange(hsv, *colour.bounds(saturation)), cv2.MORPH_OPEN, three)
    smooth = cv2.GaussianBlur(image, (0, 0), 1.5)
    loose = colour.loose_mask(colour.hsv_of(smooth))
    yield cv2.morphologyEx(loose, cv2.MORPH_CLOSE, five)
    if (loose > 0).mean() > _COVERED:
        yield cv2.morphologyEx(_other_than_most(smooth, loose), cv2.MORPH_OPEN, five)


def _other_than_most(image, mask):
    """255 where the hue of a mask's pixels (h, w) is far from that of most of them: a ball on a table of its colour.

    Otsu's threshold tells how far is far.
    """
    lab = cv2.cvtColor(image, cv2.COLOR_RGB2LAB)[..., 1:]
    off = np.linalg.norm(lab - np.median(lab[mask > 0], axis=0), axis=2)
    levels = np.uint8(np.minimum(4 * off, 255))  # quarters of a grey level: it needs whole numbers
    far, _ = cv2.threshold(levels[mask > 0], 0, 255, cv2.THRESH_OTSU)
    return np.uint8(255 * ((mask > 0) & (levels > far)))


def _circles(points):
    """Circles [(number of points on it, x, y, r)] through three points of an outline (n, 2), by most points on them."""
    first, step = (part.ravel() for part in np.meshgrid(np.arange(_STARTS) / _STARTS, _STEPS))
    largest = 2 * min(cv2.minAreaRect(np.float32(points))[1])  # px: of a larger circle the region has hardly a quarter
    found = []
    while len(points) >= 8 and len(found) < _ARCS:
        p, q, s = (points[((first + k * step) * len(points)).astype(int) % len(points)] for k in range(3))
        a, b = q - p, s - p
        twice = 2 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        aa, bb = (a * a).sum(axis=1), (b * b).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = np.column_stack([b[:, 1] * aa - a[:, 1] * bb, a[:, 0] * bb - b[:, 0] * aa]) / twice[:, None]
        r = np.hypot(*middle.T)
        usable = (r > 2) & (r < largest)
        if not usable.any():
            break
        middle, r = (p + middle)[usable], r[usable]
        off = cdist(points, middle) - r
        near = np.abs(off) < np.maximum(_NEAR[0] * r, _NEAR[1])  # (points, circles)
        best = near.sum(axis=0).argmax()
        found.append((near[:, best].sum(), *middle[best], r[best]))
        points = points[~near[:, best]]
    return found
