"""Where a ball might be: arcs of circles in the outlines of regions that have its colour."""

import numpy as np

STRICTNESS = (0.0, 0.45, 0.62)  # least saturations tried: a saturated ball stands out from wood under warm light
_MUCH = 0.05  # of the picture: if more has the colour, the table may have it, and the mask is split further
_LARGEST = 10  # regions looked at in each mask
_ROUND = 0.07  # rms over radius of an outline that is a circle as a whole
_CIRCLES = 4  # of one outline: balls that touch share one


def guess_circles(image, colour, least_radius):
    """First guesses (n, 4): x, y, r in pixels of the picture, and the share of the circle that was an arc.

    A large picture is halved first: it costs a quarter, and noise goes. Returns also the number of regions of this
    colour, for a reason where nothing is found.
    """
    import cv2

    height, width = image.shape[:2]
    shrink = 1 if max(height, width) < 480 else 2
    small = image
    if shrink > 1:
        small = cv2.resize(image, (width // shrink, height // shrink), interpolation=cv2.INTER_AREA)
    sx, sy = width / small.shape[1], height / small.shape[0]
    least = max(1.5, 0.7 * least_radius / shrink)
    found, regions = [], 0
    for mask in masks(colour.hsv_of(small), colour):
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        large = [c[:, 0] for c in contours if len(c) >= max(8, 4 * least)]
        large = sorted(large, key=len, reverse=True)[:_LARGEST]
        regions = max(regions, len(large))
        irregular = False
        for contour in large:
            circles = circles_in(contour.astype(float), mask.shape, least)
            irregular = irregular or not circles or circles[0][3] < 0.9
            found += circles
        if irregular:
            found += _inscribed(mask, least)
    circles = np.array(found).reshape(-1, 4)
    circles[:, 0] = (circles[:, 0] + 0.5) * sx - 0.5
    circles[:, 1] = (circles[:, 1] + 0.5) * sy - 0.5
    circles[:, 2] = (circles[:, 2] + 0.5) * (sx + sy) / 2  # the outline runs through the centres of its last pixels
    return _different(circles), regions


def masks(hsv, colour):
    """Pictures (h, w) uint8, 255 where the colour is: from loose to strict, and parts of it if there is much of it."""
    import cv2

    kernel = np.ones((3, 3), np.uint8)
    loose = cv2.inRange(hsv, *colour.bounds())
    strict = [cv2.inRange(hsv, *colour.bounds(s)) for s in STRICTNESS[1:]]
    found = [cv2.morphologyEx(mask, cv2.MORPH_OPEN, kernel) for mask in (loose, *strict)]
    many = cv2.countNonZero(found[0])
    if many > _MUCH * loose.size:
        for channel in range(3):  # Otsu's threshold in hue, saturation and value of what has the colour
            values = hsv[:, :, channel]
            middle, _ = cv2.threshold(values[loose > 0], 0, 255, cv2.THRESH_OTSU)
            upper = cv2.bitwise_and(cv2.compare(values, middle, cv2.CMP_GT), loose)
            for part in (upper, cv2.subtract(loose, upper)):
                found.append(cv2.morphologyEx(part, cv2.MORPH_OPEN, kernel))
    return found


def _inscribed(mask, least_radius):
    """Circles that fit into the mask best, at most six: a ball with tape beside it is its widest part."""
    import cv2

    depth = cv2.distanceTransform(cv2.copyMakeBorder(mask, 1, 1, 1, 1, cv2.BORDER_REPLICATE), cv2.DIST_L2, 3)[
        1:-1, 1:-1
    ]
    top = cv2.dilate(depth, np.ones((7, 7), np.uint8))
    y, x = np.nonzero((depth >= top) & (depth > least_radius) & (depth < max(mask.shape)))
    order = np.argsort(-depth[y, x], kind="stable")[:30]
    found = []
    for i in order:
        r = float(depth[y[i], x[i]])
        if all(np.hypot(x[i] - c[0], y[i] - c[1]) > 0.7 * c[2] for c in found):
            found.append((float(x[i]), float(y[i]), r, 0.3))
        if len(found) == 6:
            break
    return found


def circles_in(points, shape, least_radius):
    """Circles (x, y, r, share) in a closed outline (n, 2), best first, in its own pixels.

    Three points some way apart on the outline make a circle; the one with most of its length along the outline wins,
    its points go, and the search goes on with the rest.
    """
    height, width = shape
    n = len(points)
    m = min(n, 48 + n // 4, 160)
    p = points[(np.arange(m) * n) // m]
    inside = ((p > 0.5) & (p < (width - 1.5, height - 1.5))).all(axis=1)  # the border of the picture is no outline
    if inside.sum() < 6:
        return []
    x, y, r = _kasa(p[inside])
    off = np.hypot(p[inside, 0] - x, p[inside, 1] - y) - r
    if r < max(height, width) and np.sqrt(np.mean(off**2)) < max(_ROUND * r, 0.5) and inside.mean() > 0.4:
        return [(x, y, r, 1.0)]
    left, found = inside.copy(), []
    for _ in range(_CIRCLES):
        if left.sum() < 6:
            break
        best = _best_circle(p, left, n / m, least_radius, 0.75 * max(height, width))
        if best is None:
            break
        x, y, r, share, used = best
        if share < 0.22:
            break
        found.append((x, y, r, min(share, 0.89)))
        left &= ~used
    return found


def _best_circle(p, usable, step, least_radius, most_radius):
    m = len(p)
    index = np.arange(m)
    apart = sorted({max(2, m // k) for k in (16, 9, 5, 3)} | ({4, 8, 16, 32} if m > 100 else set()))
    triples = [(index, (index + d) % m, (index + 2 * d) % m) for d in apart]
    i, j, k = (np.concatenate(part) for part in zip(*triples, strict=True))
    good = usable[i] & usable[j] & usable[k]
    A, B, C = p[i[good]], p[j[good]], p[k[good]]
    if not len(A):
        return None
    b, c = B - A, C - A
    cross = 2 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    # the outline runs around its region: where it bends the other way the circle is a bay, not a ball
    bent = cross < -1e-6 if _clockwise(p) else cross > 1e-6
    b, c, A, cross = b[bent], c[bent], A[bent], cross[bent]
    bb, cc = (b * b).sum(axis=1), (c * c).sum(axis=1)
    ux, uy = (c[:, 1] * bb - b[:, 1] * cc) / cross, (b[:, 0] * cc - c[:, 0] * bb) / cross
    r = np.hypot(ux, uy)
    fits = (r >= least_radius) & (r <= most_radius)
    if not fits.any():
        return None
    x, y, r = A[fits, 0] + ux[fits], A[fits, 1] + uy[fits], r[fits]
    far = np.hypot(p[:, 0] - x[:, None], p[:, 1] - y[:, None]) - r[:, None]
    near = (np.abs(far) < np.maximum(0.9, 0.06 * r)[:, None]) & usable
    share = np.minimum(near.sum(axis=1) * step / (5.6 * r), 1.0)  # a pixel chain is longer than it counts
    best = int(np.argmax(share * np.sqrt(r)))
    used = np.abs(far[best]) < max(1.5, 0.10 * r[best])
    points = p[near[best]]
    x, y, r = _kasa(points) if len(points) >= 5 else (x[best], y[best], r[best])
    return x, y, r, float(share[best]), used


def _clockwise(p):
    return np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) < 0


def _kasa(p):
    """Algebraic circle through points (n, 2): least squares of x^2 + y^2 = a x + b y + c."""
    mean = p.mean(axis=0)
    d = p - mean
    a, b, c = np.linalg.lstsq(np.column_stack([d, np.ones(len(d))]), (d * d).sum(axis=1), rcond=None)[0]
    return mean[0] + a / 2, mean[1] + b / 2, float(np.sqrt(max(c + (a * a + b * b) / 4, 1e-9)))


def _different(circles):
    """Drop circles that another, with a larger share, already tells."""
    kept = []
    for circle in circles[np.argsort(-circles[:, 3] * np.minimum(circles[:, 2], 20) ** 0.5, kind="stable")]:
        x, y, r, _ = circle
        if all(np.hypot(x - o[0], y - o[1]) + abs(r - o[2]) > 0.25 * max(r, o[2]) for o in kept):
            kept.append(circle)
    return np.array(kept).reshape(-1, 4)
