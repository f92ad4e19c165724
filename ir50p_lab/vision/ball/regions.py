"""Where a ball might be: arcs of circles in the outlines of regions that have its colour."""

from math import sqrt

import cv2
import numpy as np

from ir50p_lab.jit import jit
from ir50p_lab.vision.ball.edge import cast, contrast_axis, directions
from ir50p_lab.vision.ball.fit import fit_circle

STRICTNESS = (0.0, 0.45, 0.62)  # least saturations tried: a saturated ball stands out from wood under warm light
_LARGEST, _LARGEST_CLOSER = 10, 5  # regions looked at in each mask
_ROUND = 0.07  # rms over radius of an outline that is a circle as a whole
_MARGIN = 8  # pixels of the coarse picture around what has the colour
_SMALL, _VERY_LARGE = 40_000, 400_000  # pixels of a part that is searched at full size, too; at a quarter of it only
_RAYS, _INSIDE = 32, 4  # samples that tell how a guess stands out: directions, and rings inside
_RINGS = np.array([0.5, 0.65, 0.8, 0.9, 1.1, 1.2, 1.35, 1.5])  # of the radius
_LEAST_APART = 0.9  # standard deviations from its surroundings: balls were found from guesses of 1.06 on
_LEAST_SHARE = 0.22  # of a circle that an arc must be
_LARGE = 20.0  # pixels: a larger circle is no better: two long, nearly straight lines look like one
_CIRCLES = 4  # of one outline: balls that touch share one


def coarse(image, colour):
    """The picture, at half its size if it is large, and its `colour.hsv_of`: it costs a quarter, and noise goes."""
    small = _smaller(image, 1 if max(image.shape) < 480 else 2)
    return small, colour.hsv_of(small)


def guess_circles(image, seen, colour, least_radius):
    """First guesses (n, 3): x, y, r in pixels of the picture, best first. seen: of `coarse`."""
    small, hsv = seen
    masks = [_opened(cv2.inRange(hsv, *colour.bounds(s))) for s in STRICTNESS]
    circles = _circles_of(masks, least_radius * max(small.shape) / max(image.shape), _LARGEST)
    return _different(image, _unscaled(circles, image, small), directions(_RAYS))


def guess_closer(image, seen, colour, least_radius):
    """Further guesses, as `guess_circles`, where those led to no ball: smoothed at two or three scales, looser colour.

    Noise breaks up the colour of a dark ball, highlights and glare punch holes; one before a thing of nearly its colour
    shows only when the two are told apart. Searched is the part of the picture that has pixels of the colour; a large
    part is not searched at full size, and a very large one only at a quarter of it: noise looks round in places, and it
    takes ten times as long.
    """
    small, hsv = seen
    left, above, width, height = cv2.boundingRect(colour.loose_mask(hsv))
    # whole twos: an odd size takes OpenCV ten times as long to halve
    x, y = corner = [max(one - _MARGIN, 0) // 2 * 2 for one in (left, above)]
    right, below = ((one + _MARGIN + 1) // 2 * 2 for one in (left + width, above + height))
    part, shrink = small[y:below, x:right], round(max(image.shape) / max(small.shape))
    full = image[shrink * y : shrink * below, shrink * x : shrink * right]
    scales = (part, shrink, 1.5), (_smaller(part, 2), 2 * shrink, 1.2), (full, 1, 1.2)
    pixels = full.shape[0] * full.shape[1]
    found = [np.empty((0, 3))]
    for copy, scale, sigma in scales[pixels > _VERY_LARGE : 3 if pixels < _SMALL and shrink > 1 else 2]:
        gauss = cv2.getGaussianKernel(7, sigma)
        hsv = colour.hsv_of(cv2.sepFilter2D(copy, -1, gauss, gauss))  # a third of the time of GaussianBlur
        mask = colour.loose_mask(hsv)
        if mask.any():
            closed = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
            circles = _circles_of([closed, *_halves(hsv, mask, colour)], least_radius / scale, _LARGEST_CLOSER)
            found.append(_unscaled(circles, part, copy) + np.array([*corner, 0]))
    return _different(image, _unscaled(np.concatenate(found), image, small), directions(_RAYS))


def _smaller(image, shrink):
    size = max(image.shape[1] // shrink, 1), max(image.shape[0] // shrink, 1)
    return image if shrink == 1 else cv2.resize(image, size, interpolation=cv2.INTER_AREA)


def _unscaled(circles, image, small):
    """Circles of the small copy in pixels of the picture."""
    sx, sy = image.shape[1] / small.shape[1], image.shape[0] / small.shape[0]
    half = np.array([0.5, 0.5, 0.0])
    return (circles + half) * (sx, sy, (sx + sy) / 2) - half


def _circles_of(found_in, least_radius, most):
    """Circles (n, 3) in the outlines of masks, of each the `most` longest."""
    least = max(1.5, 0.7 * least_radius)
    found = [np.empty((0, 3))]
    for mask in found_in:
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        longest = [c[:, 0].astype(float) for c in sorted(contours, key=len, reverse=True)[:most]]
        found += [circles_in(points, mask.shape, least) for points in longest if len(points) >= max(8, 4 * least)]
    return np.concatenate(found) + np.array([0.0, 0.0, 0.5])  # an outline runs through the centres of its last pixels


def _opened(mask):
    return cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))


def _halves(hsv, mask, colour):
    """Parts of a mask on either side of Otsu's thresholds of hue, saturation and value in it.

    Of a red those that found balls: the less orange, the more saturated, the darker one.
    """
    found, inside, above, below = [], mask > 0, cv2.THRESH_BINARY, cv2.THRESH_BINARY_INV
    kinds = ((above,), (above,), (below,)) if colour.swaps else [(below, above)] * 3
    for plane, sides in zip(cv2.split(hsv), kinds, strict=True):
        middle, _ = cv2.threshold(plane[inside], 0, 255, cv2.THRESH_OTSU)
        found += [_opened(cv2.threshold(plane, middle, 255, side)[1] & mask) for side in sides]
    return found


@jit()
def circles_in(points, shape, least_radius):
    """Circles (k, 3), x, y, r, in a closed outline (n, 2), best first, in its own pixels.

    One through all points, if it fits. Else three points some way apart on the outline make a circle; the one with most
    of its length along the outline wins, its points go, and the search goes on with the rest.
    """
    n = len(points)
    m = min(n, 48 + n // 4, 160)
    p = points[(np.arange(m) * n) // m]
    px, py = p[:, 0].copy(), p[:, 1].copy()
    # the outline runs around its region: where it bends the other way the circle is a bay, not a ball
    turn = 1 if np.sum(px * np.roll(py, -1) - np.roll(px, -1) * py) < 0 else -1
    apart = np.maximum(2, m // np.array([16, 9, 5, 3]))
    apart = np.unique(np.append(apart, [4, 8, 16, 32]) if m > 100 else apart)
    along = turn * np.column_stack((np.roll(px, -1) - np.roll(px, 1), np.roll(py, -1) - np.roll(py, 1)))
    # the border of the picture is no outline
    usable = (px > 0.5) & (px < shape[1] - 1.5) & (py > 0.5) & (py < shape[0] - 1.5)
    found = np.empty((_CIRCLES, 3))
    if usable.sum() < 6:
        return found[:0]
    x, y, r = fit_circle(px[usable], py[usable])
    off = np.hypot(px[usable] - x, py[usable] - y) - r
    around = np.hypot(px[usable].mean() - x, py[usable].mean() - y) < 0.85 * r  # a stick that bends a little is not
    if around and usable.mean() > 0.4 and r < max(shape) and np.mean(off**2) < max(_ROUND * r, 0.5) ** 2:
        found[0] = x, y, r
        return found[:1]
    circles = circles_through_three(p, usable, apart, least_radius, 0.75 * max(shape), turn)
    for k in range(_CIRCLES):
        x, y, r = vote(p, along, usable, circles, n / m)
        if r == 0 or usable.sum() < 6:
            return found[:k]
        off = np.abs(np.hypot(px - x, py - y) - r)
        near = usable & (off < max(0.9, 0.06 * r))
        usable = usable & (off >= max(1.5, 0.10 * r))
        refined = fit_circle(px[near], py[near]) if near.sum() >= 5 else (x, y, 0.0)
        found[k] = refined if refined[2] > 0 else (x, y, r)
    return found


@jit(fastmath=("contract",))
def circles_through_three(p, usable, apart, least_radius, most_radius, turn):
    """Circles (n, 7) through points i, j = i + d, k = i + 2 d of an outline: x, y, r, most votes it can get, i, j, k.

    turn: 1 or -1, the way the outline runs around its region (see `circles_in`).
    """
    m, n = len(p), 0
    circles = np.empty((m * len(apart), 7))
    for d in apart:
        for i in range(m):
            j, k = i + d - m * (i + d >= m), i + 2 * d - m * (i + 2 * d >= m)  # % takes longer
            b0, b1, c0, c1 = p[j, 0] - p[i, 0], p[j, 1] - p[i, 1], p[k, 0] - p[i, 0], p[k, 1] - p[i, 1]
            cross = 2 * (b0 * c1 - b1 * c0)
            if not (turn * cross < -1e-6 and usable[i] and usable[j] and usable[k]):
                continue
            bb, cc = b0 * b0 + b1 * b1, c0 * c0 + c1 * c1
            ux, uy = (c1 * bb - b1 * cc) / cross, (b0 * cc - c0 * bb) / cross
            r = sqrt(ux * ux + uy * uy)
            if least_radius <= r <= most_radius:
                circles[n, :4] = p[i, 0] + ux, p[i, 1] + uy, r, sqrt(min(r, _LARGE))
                circles[n, 4:] = i, j, k
                n += 1
    return circles[:n]


@jit(fastmath=("contract", "reassoc"))  # reassoc: counts in many lanes at once
def vote(p, along, usable, circles, step):
    """The circle (x, y, r) that most of what is left of the outline runs along, else r = 0.

    along (n, 2): direction of the outline at its points, times its turn. Where it runs around the circle the other way,
    as on the far side of a stick, it does not count. The votes are kept in `circles`: later, when less of the outline
    is left, a circle can get no more.
    """
    left_x, left_y = p[:, 0][usable].astype(np.float32), p[:, 1][usable].astype(np.float32)
    along_x, along_y = along[:, 0][usable].astype(np.float32), along[:, 1][usable].astype(np.float32)
    best, bx, by, br = 0.0, 0.0, 0.0, 0.0
    for n in range(len(circles)):
        x, y, r = circles[n, 0], circles[n, 1], circles[n, 2]
        i, j, k = int(circles[n, 4]), int(circles[n, 5]), int(circles[n, 6])
        if not (circles[n, 3] > best and usable[i] and usable[j] and usable[k]):
            continue
        limit, near = max(0.9, 0.06 * r), np.float32(0)
        low, high = np.float32(max(r - limit, 0.0) ** 2), np.float32((r + limit) ** 2)
        for q in range(len(left_x)):
            dx, dy = left_x[q] - np.float32(x), left_y[q] - np.float32(y)
            square, around = dx * dx + dy * dy, dx * along_y[q] < dy * along_x[q]
            near += np.float32(1) if around & (low < square) & (square < high) else np.float32(0)
        share = min(near * step / (5.6 * r), 1.0)  # a pixel chain is longer than it counts
        circles[n, 3] = share * sqrt(min(r, _LARGE)) * (share >= _LEAST_SHARE)
        if circles[n, 3] > best:
            best, bx, by, br = circles[n, 3], x, y, r
    return bx, by, br


@jit()
def _different(image, circles, rays):
    """The circles (n, 3) that stand out from their surroundings, the most first, but for what a better one tells."""
    apart, new, count = np.empty(len(circles)), np.empty_like(circles), 0
    for k, (x, y, r) in enumerate(circles):
        _, rgb, within = cast(image, x, y, np.full(1, r), _RINGS, rays)
        apart[k] = contrast_axis(rgb, within, _INSIDE, _INSIDE)[2]  # in standard deviations
    for k in np.argsort(-apart, kind="mergesort"):
        x, y, r = circles[k]
        better_x, better_y, better_r = new[:count].T
        alike = np.hypot(x - better_x, y - better_y) + np.abs(r - better_r) <= 0.25 * np.maximum(r, better_r)
        if apart[k] > _LEAST_APART and not alike.any():
            new[count] = circles[k]
            count += 1
    return new[:count]
