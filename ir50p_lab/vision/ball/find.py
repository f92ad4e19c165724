"""Find balls of one colour in a picture: where, how large, how sure; or why there is none.

Regions of the colour give circles; around each the edge is measured along rays, to sub-pixel, and a circle is fitted.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.vision.ball.colour import RED, Colour
from ir50p_lab.vision.checks import check_picture_size
from ir50p_lab.vision.image import check_image
from ir50p_lab.vision.pinhole import as_pinhole

_STRICTNESS = (0.0, 0.45, 0.62)  # least saturations tried: a saturated ball stands out from wood under warm light
_MOST = 40  # guesses looked at
_RAYS = 64
_ANGLES = np.arange(_RAYS) * (2 * np.pi / _RAYS)
_UNIT = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)])
_EDGE = 0.3  # least height of an edge, in units of the contrast between ball and surroundings
_F = 0.9  # focal length over the longer side of the picture, assumed where no camera is given


@dataclass(frozen=True)
class Ball:
    """A ball: x, y where the centre of the sphere is seen, px; radius px; score 0..1; support: outline with an edge."""

    x: float
    y: float
    radius: float
    score: float
    support: float = 1.0

    def __repr__(self):
        return f"Ball(x={self.x:.2f}, y={self.y:.2f}, radius={self.radius:.2f}, score={self.score:.2f})"


class Balls(list):
    """The balls found, best first; reason: why there is none; rejected: ((x, y, radius), why) of what was no ball."""

    def __init__(self, balls=(), *, reason="", rejected=()):
        super().__init__(balls)
        self.reason, self.rejected = reason, tuple(rejected)

    def __repr__(self):
        return super().__repr__() if self or not self.reason else f"Balls([], reason={self.reason!r})"


def find_balls(image, colour=RED, *, camera=None, least_radius=6.0):
    """Find the balls of a colour in an RGB picture (h, w, 3), best first: Balls.

    colour: Colour; camera: Pinhole or Calibration if known; least_radius: px. Raises ImageError for a bad picture.
    """
    image = check_image(image)
    if not isinstance(colour, Colour):
        raise InputError(f"colour = {colour!r:.60}: give RED or another Colour (learn_colour makes one from a click)")
    least_radius = number("least_radius", least_radius, "> 0", unit="px")
    if camera is not None:
        camera = as_pinhole(camera)
        check_picture_size(camera, image.shape[1::-1])
    balls, rejected = [], []
    for guess in _guesses(image, colour, least_radius)[:_MOST]:
        (x, y, r), why, score, support = _measured(image, guess, colour, least_radius)
        if why:
            rejected.append(((x, y, r), why))
        else:
            balls.append(Ball(x, y, r, score, support))
    kept = []
    for ball in sorted(balls, key=lambda one: -one.score):
        if all(np.hypot(ball.x - b.x, ball.y - b.y) > 0.8 * max(ball.radius, b.radius) for b in kept):
            kept.append(ball)
    rejected = [one for one in rejected if all(np.hypot(one[0][0] - b.x, one[0][1] - b.y) > b.radius for b in kept)]
    if kept:
        return Balls([_sphere(ball, image, camera) for ball in kept], rejected=rejected)
    if not rejected:
        return Balls(reason=f"nothing {colour.name} and round is seen, of {least_radius:g} pixels or more in radius")
    (x, y, r), why = rejected[0]
    return Balls(reason=f"the likeliest thing, at ({x:.0f}, {y:.0f}) with radius {r:.0f}: {why}", rejected=rejected)


def _sphere(ball, image, camera):
    """The ball with its centre moved from that of its outline: perspective draws a sphere out, away from the axis."""
    h, w = image.shape[:2]
    if camera is None:
        middle, f = np.array([(w - 1) / 2, (h - 1) / 2]), _F * max(w, h)
    else:
        middle, f = camera.K[:2, 2], camera.fx
    x, y = middle + (np.array([ball.x, ball.y]) - middle) * (1 - (ball.radius / f) ** 2)
    return Ball(float(x), float(y), ball.radius, ball.score, ball.support)


def _guesses(image, colour, least_radius):
    """Circles [(x, y, r)] that regions of the colour may be, the largest first."""
    scale = max(1, round(max(image.shape) / 640))
    small = image if scale == 1 else cv2.resize(image, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_AREA)
    hsv, found, square = colour.hsv_of(small), [], np.ones((3, 3), np.uint8)
    masks = [cv2.morphologyEx(cv2.inRange(hsv, *colour.bounds(s)), cv2.MORPH_OPEN, square) for s in _STRICTNESS]
    loose = colour.loose_mask(colour.hsv_of(cv2.GaussianBlur(small, (0, 0), 1.5)))  # in the dark, or in glare
    masks.append(cv2.morphologyEx(loose, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8)))
    if loose.any():  # the more saturated and the less orange part of it
        for plane, side in ((1, cv2.THRESH_BINARY), (0, cv2.THRESH_BINARY)):
            level, _ = cv2.threshold(hsv[..., plane][loose > 0], 0, 255, cv2.THRESH_OTSU)
            masks.append(
                cv2.morphologyEx(cv2.threshold(hsv[..., plane], level, 255, side)[1] & loose, cv2.MORPH_OPEN, square)
            )
    for mask in masks:
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        for contour in sorted(contours, key=len, reverse=True)[:10]:
            points = contour[:, 0].astype(float)
            if len(points) < max(8, 4 * least_radius / scale):
                continue
            found += _circles(points, mask, cv2.boundingRect(contour))
    circles, different = (np.array(found).reshape(-1, 3) + (0.5, 0.5, 0.5)) * scale - (0.5, 0.5, 0), []
    for x, y, r in circles[circles[:, 2] > 0.7 * least_radius]:
        if all(np.hypot(x - a, y - b) + abs(r - c) > 0.25 * max(r, c) for a, b, c in different):
            different.append((float(x), float(y), float(r)))
    return different


def _circles(points, mask, box):
    """Circles of one outline (n, 2): through all of it, and the largest that lie in its region."""
    x, y, r = fit_circle(*points.T)
    off = np.hypot(points[:, 0] - x, points[:, 1] - y) - r
    if r < max(mask.shape) and np.sqrt(np.mean(off**2)) < max(0.07 * r, 0.7):
        return [(x, y, r)]
    left, top, width, height = box
    part = cv2.morphologyEx(mask[top : top + height, left : left + width], cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    part = cv2.copyMakeBorder(part, 1, 1, 1, 1, cv2.BORDER_CONSTANT)
    inside, found = cv2.distanceTransform(part, cv2.DIST_L2, 5), []
    for _ in range(4):
        _, r, _, (x, y) = cv2.minMaxLoc(inside)
        if r < 2:
            break
        found.append((x + left - 1, y + top - 1, r))
        cv2.circle(inside, (x, y), int(1.2 * r), 0, -1)
    smooth = cv2.GaussianBlur(cv2.copyMakeBorder(part, 8, 8, 8, 8, cv2.BORDER_CONSTANT), (0, 0), 1)
    votes = cv2.HoughCircles(smooth, cv2.HOUGH_GRADIENT_ALT, 1.5, 6, None, 300, 0.5, 3, max(part.shape))
    if votes is not None:
        found += [(a + left - 9, b + top - 9, c) for a, b, c in votes[0, :4]]
    return found


def fit_circle(x, y, w=None):
    """The algebraic circle (x, y, r) through points, weighted."""
    w = np.ones(len(x)) if w is None else w
    A = np.column_stack([x, y, np.ones(len(x))]) * w[:, None]
    (a, b, c), *_ = np.linalg.lstsq(A, (x * x + y * y) * w, rcond=None)
    return a / 2, b / 2, np.sqrt(max(c + (a * a + b * b) / 4, 0.0))


def _measured(image, guess, colour, least_radius):
    """((x, y, r), why it is no ball or "", score, support)."""
    x, y, r = guess
    for half, width in ((0.6, 0.3), (0.45, 0.2), (0.3, 0.15)):
        rho, rgb, within = _rays(image, x, y, r, half)
        at, height, apart = _edges(rho, rgb, within, r, width * r)
        if at is None:
            return (x, y, r), "it looks like its surroundings", 0.0, 0.0
        ex, ey, good = x + at * _UNIT[0], y + at * _UNIT[1], height > _EDGE
        if good.sum() < 10:
            return (x, y, r), "no edge around it", 0.0, 0.0
        off, scale = np.where(good, at - np.median(at[good]), np.inf), max(0.2 * r, 2.0)
        for _ in range(5):
            w = np.where(np.abs(off) < scale, 1 - np.minimum(np.abs(off) / scale, 1) ** 2, 0.0)
            if (w > 0).sum() < 8:
                return (x, y, r), "its edges lie on no circle", 0.0, 0.0
            cx, cy, cr = fit_circle(ex, ey, w)
            off = np.where(good, np.hypot(ex - cx, ey - cy) - cr, np.inf)
            scale = max(0.6 * scale, 0.8)
        if not 0.4 * r < cr < 2.5 * r:
            return (x, y, r), "its edges lie on no circle", 0.0, 0.0
        x, y, r = float(cx), float(cy), float(cr)
    on = np.abs(off) < max(1.2, 0.05 * r)
    support, seen = float(on.mean()), float(within[:, within.shape[1] // 2].mean())
    rough = 1.48 * float(np.median(np.abs(off[on]))) if on.any() else np.inf
    if r < least_radius:
        return (x, y, r), f"too small, radius {r:.1f} pixels", 0.0, support
    fill, hue, paint, beyond = _colours(image, x, y, r, colour)
    numbers = [
        np.log(r / 20),
        1 - support,
        1 - seen,
        1 - fill,
        rough / (0.3 + 0.01 * r),
        hue,
        beyond,
        1 - min(float(np.median(height[on])), 1.5) if on.any() else 1.0,
        np.log(5.5 / apart),
    ]
    score = 1 / (1 + np.exp(-(_WEIGHTS[0] - np.dot(_WEIGHTS[1:], numbers))))
    why = _other_paint(paint, colour) or (_objection(numbers) if score < 0.65 else "")
    return (x, y, r), why, float(score), support


_WEIGHTS = np.array([5.32, -2.3, 4.43, 2.23, 3.64, 2.84, 2.28, 1.16, -1.55, 2.51])  # of a logistic regression
_SAID = (
    "it is small",
    "{:.0%} of the circle show no edge",
    "{:.0%} of the circle lie outside the picture",
    "{:.0%} of the disc have another colour",
    "its outline is not round",
    "its hue is off by {:.2f} of the tolerance",
    "the colour goes on beyond {:.0%} of the circle",
    "its edge is soft",
    "it hardly stands out from its surroundings",
)


def _objection(numbers):
    worst = int(np.argmax(_WEIGHTS[1:] * numbers))
    return _SAID[worst].format(numbers[worst])


def _rays(image, x, y, r, half, count=41):
    """Distances (m,), colours (rays, m, 3) float, and whether they lie in the picture, along rays from r(1 -+ half)."""
    rho = r * np.linspace(1 - half, 1 + half, count)
    px, py = x + rho * _UNIT[0][:, None], y + rho * _UNIT[1][:, None]
    rgb = cv2.remap(
        image, px.astype(np.float32), py.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    h, w = image.shape[:2]
    return rho, rgb.astype(float), (px >= -0.5) & (px <= w - 0.5) & (py >= -0.5) & (py <= h - 0.5)


def _edges(rho, rgb, within, r, width):
    """Distance (n,) and height (n,) of the strongest fall of contrast along each ray; None without contrast."""
    inner, outer = rho < 0.85 * r, rho > 1.12 * r
    inside, outside = rgb[:, inner][within[:, inner]], rgb[:, outer][within[:, outer]]
    if len(inside) < 20 or len(outside) < 20:
        return None, None, 0.0
    step = inside.mean(axis=0) - outside.mean(axis=0)
    axis = np.linalg.solve(0.5 * (np.cov(inside.T) + np.cov(outside.T)) + 64 * np.eye(3), step)
    if step @ axis < 1.0:
        return None, None, 0.0
    profile = rgb @ (axis / (step @ axis))
    pace = rho[1] - rho[0]
    sigma = max(1.2, 0.025 * r) / pace
    kernel = cv2.getGaussianKernel(2 * int(3 * sigma) + 3, sigma).ravel()
    slope = -np.gradient(cv2.sepFilter2D(profile, -1, kernel, np.ones(1), borderType=cv2.BORDER_REPLICATE), axis=1)
    weighed = slope / (1 + ((rho - r) / width) ** 2)
    peak = 1 + weighed[:, 1:-1].argmax(axis=1)
    rows = np.arange(len(slope))
    a, b, c = slope[rows, peak - 1], slope[rows, peak], slope[rows, peak + 1]
    bend = a - 2 * b + c
    shift = np.where(bend < 0, np.clip(0.5 * (a - c) / np.where(bend < 0, bend, -1), -0.5, 0.5), 0)
    height = b * np.sqrt(2 * np.pi) * sigma * within[rows, np.minimum(peak + 1, len(rho) - 1)]
    return rho[0] + (peak + shift) * pace, height, float(np.sqrt(step @ axis))


def _colours(image, x, y, r, colour):
    """Fill of the disc with the colour or highlights, hue over tolerance, paint, share beyond which the colour goes on."""
    relative = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.06, 1.14])
    rim = 1.5 / r
    reach = r * (relative + np.where(relative > 1, rim, 0) - np.where(relative > 0.85, rim, 0) * (relative < 1))
    px, py = x + reach * _UNIT[0][:, None], y + reach * _UNIT[1][:, None]
    rgb = cv2.remap(
        image, px.astype(np.float32), py.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    hsv = colour.hsv_of(rgb)
    alike = cv2.inRange(hsv, *colour.bounds()) > 0
    disc, loose = hsv[:, :9], colour.loose_mask(hsv[:, :9]) > 0
    bright = (disc[..., 2] > 200) & (disc[..., 1] < 255 * colour.saturation)
    area = relative[:9] / relative[:9].sum()
    highlights = bright @ area if (bright @ area).mean() < 0.35 else 0
    fill = float((loose @ area + highlights).mean())
    off = (2.0 * disc[..., 0] - colour.centre + 180) % 360 - 180
    clear = loose & (disc[..., 2] < 242)
    chosen = clear if clear.mean() > 0.1 else loose
    hue = float(np.median(np.abs(off[chosen])) / colour.tolerance) if chosen.any() else np.inf
    if not loose.any():
        return fill, hue, (0, 0, 0), 0.0
    warm = float(np.median(off[loose])) * (-1 if colour.swaps else 1)
    paint = warm, np.percentile(disc[loose][:, 1], 80) / 255, np.percentile(disc[loose][:, 2], 90) / 255
    return fill, hue, paint, float((alike[:, 9] & alike[:, 10]).mean())


def _other_paint(paint, colour):
    """Why a paint is not of the colour sought: nearly black; for reds skin or brown; "" if it may be."""
    warm, saturation, value = paint
    if value < 0.2:
        return f"nearly black: value {value:.2f}"
    if min(colour.hue, 360 - colour.hue) > 20:
        return ""
    if warm > 5 and saturation < 0.6 and value < 0.95:
        return f"skin, or another pale orange: saturation {saturation:.2f}"
    if (warm > 14 and value < 0.33) or (warm > 8 and saturation < 0.72 and value < 0.45):
        return f"brown: saturation {saturation:.2f} and value {value:.2f}"
    return ""
