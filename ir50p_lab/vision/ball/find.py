"""Find balls of one colour in a picture: where, how large, how sure; or why there is none."""

import functools
from dataclasses import dataclass

import numpy as np
from numba.core import event

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.vision.ball.classifier import score
from ir50p_lab.vision.ball.colour import RED, Colour
from ir50p_lab.vision.ball.evidence import NoBallError, check_colour, objection
from ir50p_lab.vision.ball.fit import view_of
from ir50p_lab.vision.ball.measure import measure
from ir50p_lab.vision.ball.regions import coarse, guess_circles, guess_closer
from ir50p_lab.vision.checks import check_picture_size
from ir50p_lab.vision.image import check_image
from ir50p_lab.vision.pinhole import as_pinhole

_GUESSES, _CLOSER = 14, 2  # guesses of which the colour is looked at; measured in the closer look, which takes longer

# Log odds that a ball needs, in the first look and in the closer one: above 0, as a false alarm is worse than a miss.
# The closer look comes where the first saw none, most often because there is none.
_LEAST_ODDS, _LEAST_ODDS_CLOSER = 1.0, 1.7
_SMALL, _MORE_SMALL = 8.0, 1.0  # of so few pixels of radius a box can look like a ball: it needs more
# share of the outline below which the end of a rod can, and what is missing costs, times its share
_CLEAR, _MORE_HIDDEN = 0.75, 4.0
_SURE, _BY_SUPPORT = 0.9975, 5.0  # score beyond which only the edge tells outlines apart; what its share counts


@dataclass(frozen=True)
class Ball:
    """A ball in a picture.

    x, y: where the centre of the sphere is seen, pixels; radius: pixels; score: 0..1, how sure; support: share of
    the outline that shows an edge, 1 if nothing hides it.
    """

    x: float
    y: float
    radius: float
    score: float
    support: float = 1.0

    def __repr__(self):
        return f"Ball(x={self.x:.2f}, y={self.y:.2f}, radius={self.radius:.2f}, score={self.score:.2f})"


class Balls(list):
    """The balls found, best first: a list of Ball.

    reason: why there is none ("" if there is one); rejected: ((x, y, radius), why) of what had the colour and was no
    ball.
    """

    def __init__(self, balls=(), *, reason="", rejected=()):
        super().__init__(balls)
        self.reason, self.rejected = reason, tuple(rejected)

    def __repr__(self):
        return super().__repr__() if self or not self.reason else f"Balls([], reason={self.reason!r})"


def says_that_it_compiles(function):
    """Decorator: a call that compiles says so, for it may take half a minute. Code that lies in the cache is not."""

    class Saying(event.RecordingListener):
        def on_start(self, compilation):
            if not self.buffer:
                print(f"{function.__name__} is compiled, once: up to 30 s...", flush=True)
            super().on_start(compilation)

    @functools.wraps(function)
    def wrapper(*args, **options):
        with event.install_listener("numba:compile", Saying()):
            return function(*args, **options)

    return wrapper


@says_that_it_compiles
def find_balls(image, colour=RED, *, camera=None, least_radius=6.0):
    """Find the balls of a colour, best first; a false alarm is worse than a miss.

    Regions of the colour give arcs of circles; around each the edge is measured along rays to sub-pixel, and an
    outline is fitted that is an ellipse, as perspective wants it. What has hardly an edge, is hollow or angular is no
    ball; of the rest a classifier decides, trained on rendered scenes, that looks at disc and surroundings; of what is
    small or half hidden it must be surer. If nothing is found, a closer look follows at several scales, for balls in
    the dark or in glare; it takes longer.

    Args:
        image: RGB, uint8, (height, width, 3).
        colour: Colour.
        camera: Pinhole or Calibration, if known: then the projected centre is exact, and distortion is allowed for.
            Without it a usual webcam is assumed, with its axis in the middle of the picture.
        least_radius: of the balls sought, pixels; smaller things are left out.

    Returns: Balls, a list of Ball with `.reason`.
    Raises ImageError for a bad picture, InputError for a bad colour, camera or radius, CalibrationError for a picture
    of another size than the camera's.
    """
    image = check_image(image)
    if not isinstance(colour, Colour):
        raise InputError(f"colour = {colour!r:.60}: give RED or another Colour (learn_colour makes one from a click)")
    least_radius = number("least_radius", least_radius, "> 0", unit="px")
    if camera is not None:
        camera = as_pinhole(camera)
        check_picture_size(camera, image.shape[1::-1])
    view, seen = view_of(image.shape, camera), coarse(image, colour)
    measured, scores, outlines, rejected = [], [], [], []
    looks = (guess_circles, _GUESSES, _LEAST_ODDS), (guess_closer, _CLOSER, _LEAST_ODDS_CLOSER)
    for guess, most, least_odds in looks:
        tries = 0
        for x, y, r in guess(image, seen, colour, least_radius)[:_GUESSES].tolist():
            if any(np.hypot(x - at_x, y - at_y) + abs(r - at_r) < 0.3 * r for at_x, at_y, at_r in outlines):
                continue  # an earlier guess led here
            if tries == most:
                break
            try:
                check_colour(image, (x, y, r), colour)
                tries += 1
                measured.append(measure(image, (x, y, r), view, colour, camera, least_radius))
                outlines.append(measured[-1].outline.circle)
            except NoBallError as error:
                why, *there = error.args
                rejected.append((*(there or [(x, y, r)]), why))
                outlines += there
        scores += score(measured[len(scores) :]).tolist()
        balls, objections = decide(measured, np.array(scores), least_odds)
        if balls:
            break
    rejected = (*objections, *rejected)
    if balls:
        return Balls(balls, rejected=rejected)
    if not rejected:
        return Balls(reason=f"nothing {colour.name} and round is seen, of {least_radius:g} pixels or more in radius")
    (x, y, r), why = rejected[0]
    return Balls(reason=f"the likeliest thing, at ({x:.0f}, {y:.0f}) with radius {r:.0f}: {why}", rejected=rejected)


def decide(measured, scores, least_odds=_LEAST_ODDS_CLOSER):
    """Balls best first, and what was rejected as ((x, y, r), why), best first; balls that touch excuse each other.

    measured: list of Measured; scores (n,): of `score`; least_odds: that a ball needs.
    """
    for _ in range(2):
        balls, objections = [], []
        for k in np.argsort(-_trust(scores, measured), kind="stable"):
            found, radius = measured[k], measured[k].outline.r
            if _part_of(balls, found):
                continue
            if scores[k] >= least_score(radius, found.support, least_odds):
                balls.append(Ball(*found.centre, radius, float(scores[k]), found.support))
            else:
                objections.append((scores[k], found))
        if not balls or not objections:
            break
        scores = score(measured, [_but(balls, m) for m in measured])
    balls.sort(key=lambda ball: -ball.score)
    objections = sorted((pair for pair in objections if not _part_of(balls, pair[1])), key=lambda pair: -pair[0])
    return balls, [(found.outline.circle, objection(found, _but(balls, found))) for _, found in objections]


def _part_of(balls, found):
    """Whether a Measured is one of these balls again, or a part of it."""
    o = found.outline
    return any(np.hypot(o.x - b.x, o.y - b.y) < 0.8 * max(o.r, b.radius) for b in balls)


def _trust(scores, measured):
    """How far each outline is to be trusted: of several sure ones around a ball the one with most edge is nearest."""
    surest = np.minimum(scores, _SURE)
    return np.log(surest / (1 - surest)) + _BY_SUPPORT * np.array([found.support for found in measured])


def least_score(radius, support, least_odds=_LEAST_ODDS_CLOSER):
    """Score that a ball of this radius (pixels) needs if it shows an edge on this share of its outline."""
    odds = least_odds + _MORE_SMALL * (radius <= _SMALL) + _MORE_HIDDEN * max(_CLEAR - support, 0)
    return 1 / (1 + np.exp(-odds))


def _but(balls, found):
    """The balls other than the one found."""
    return [b for b in balls if np.hypot(b.x - found.outline.x, b.y - found.outline.y) > 0.8 * b.radius]
