"""Find balls of one colour in a picture: where they are, how large and how sure; or why there is none."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.vision.arguments import check_picture_size
from ir50p_lab.vision.ball.colour import RED, Colour
from ir50p_lab.vision.ball.evidence import judge
from ir50p_lab.vision.ball.guesses import guess_circles
from ir50p_lab.vision.ball.outline import measure
from ir50p_lab.vision.image import check_image
from ir50p_lab.vision.pinhole import Pinhole, as_pinhole

_MOST = 40  # guesses measured at most, those with the longest arcs
_F = 0.9  # focal length over the longer side of the picture if no camera is given: webcams see some 58 deg across


@dataclass(frozen=True)
class Ball:
    """A ball. x, y: where the centre of the sphere is seen, px; radius: px; score: 0..1."""

    x: float
    y: float
    radius: float
    score: float

    def __repr__(self):
        return f"Ball(x={self.x:.2f}, y={self.y:.2f}, radius={self.radius:.2f}, score={self.score:.2f})"


class Balls(list):
    """The balls found, best first.

    reason: if there are none, why; rejected: ((x, y, radius), why) of others, the likeliest first.
    """

    def __init__(self, balls=(), *, reason="", rejected=()):
        super().__init__(balls)
        self.reason, self.rejected = reason, tuple(rejected)

    def __repr__(self):
        return super().__repr__() if self or not self.reason else f"Balls([], reason={self.reason!r})"


def find_balls(image, colour=RED, *, camera=None, least_radius=6.0):
    """Find the balls of a colour in an RGB picture (h, w, 3) uint8; return Balls, the best first.

    Regions of the colour give circles. Around each circle the edge is measured along rays, and the cone of sight is
    fitted to it: x, y is where the centre of the sphere is seen, not the middle of its outline. Nine numbers about
    outline and colours decide whether it is a ball; each circle that is refused has its reason. If there is no ball,
    red and blue are exchanged once: a ball that is seen then is no result, but the reason says that the picture may be
    BGR.

    Args:
        colour: Colour, default RED. camera: Pinhole or Calibration if known; otherwise one without distortion is
        assumed that sees 58 degrees across. least_radius: px, smaller balls are refused.

    Raises ImageError for what is not a colour picture, InputError for a bad argument, CalibrationError for a picture of
    another size than the camera's.
    """
    image = check_image(image)
    if not isinstance(colour, Colour):
        raise InputError(f"colour = {colour!r:.60}: give RED or another Colour(hue=..., tolerance=...), degrees")
    least_radius = number("least_radius", least_radius, "> 0", unit="px")
    size = image.shape[1::-1]
    pinhole = Pinhole.simple(_F * max(size), size) if camera is None else as_pinhole(camera)
    check_picture_size(pinhole, size)
    found = _find(image, colour, pinhole, least_radius)
    if not found and (seen := _find(np.ascontiguousarray(image[..., ::-1]), colour, pinhole, least_radius)):
        said = ". With red and blue exchanged a ball is at ({:.0f}, {:.0f}): is it BGR, from cv2.imread? Then give "
        found.reason += said.format(seen[0].x, seen[0].y) + "image[..., ::-1] or cv2.cvtColor(image, cv2.COLOR_BGR2RGB)"
    return found


def _find(image, colour, pinhole, least_radius):
    """The Balls of a Colour in an RGB picture (h, w, 3) of a camera."""
    balls, rejected = [], []
    for guess in guess_circles(image, colour, least_radius)[:_MOST]:
        outline = measure(image, pinhole, guess)
        score, why = (0.0, outline.why) if outline.why else judge(image, outline, colour)
        if outline.radius < least_radius:
            why = f"too small, radius {outline.radius:.1f} pixels"
        if why:
            circle = tuple(map(float, (outline.x, outline.y, outline.radius)))
            rejected.append((score, circle, why))
        else:
            balls.append(Ball(*map(float, (*outline.centre, outline.radius, score))))
    kept = []
    for ball in sorted(balls, key=lambda one: -one.score):
        if all(np.hypot(ball.x - b.x, ball.y - b.y) > 0.8 * max(ball.radius, b.radius) for b in kept):
            kept.append(ball)
    likeliest = sorted(rejected, key=lambda one: -one[0])
    rejected = [(c, why) for _, c, why in likeliest if all(np.hypot(c[0] - b.x, c[1] - b.y) > b.radius for b in kept)]
    return Balls(kept, reason="" if kept else _reason(rejected, colour, least_radius), rejected=rejected)


def _reason(rejected, colour, least_radius):
    """Why there is no ball: the reason of the likeliest circle refused, or that nothing has the colour."""
    if not rejected:
        return f"nothing {colour.name} and round is seen, of {least_radius:g} pixels or more in radius"
    (x, y, r), why = rejected[0]
    return f"the likeliest thing, at ({x:.0f}, {y:.0f}) with radius {r:.0f}: {why}"
