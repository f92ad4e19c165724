"""Find balls of one colour in a picture: where, how large, how sure; or why there is none."""

import functools
from dataclasses import dataclass

import numpy as np
from numba.core import event

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.jit import jit
from ir50p_lab.vision.ball.classifier import score
from ir50p_lab.vision.ball.colour import RED, Colour
from ir50p_lab.vision.ball.evidence import objection
from ir50p_lab.vision.ball.features import median
from ir50p_lab.vision.ball.fit import view_of
from ir50p_lab.vision.ball.measure import NoBallError, measure, paint_of
from ir50p_lab.vision.ball.regions import guess_circles, guess_closer, halved
from ir50p_lab.vision.checks import check_picture_size
from ir50p_lab.vision.image import check_image
from ir50p_lab.vision.pinhole import as_pinhole

_GUESSES, _CLOSER = 14, 3  # guesses of which the colour is looked at; measured in the closer look, which takes longer

# Log odds that a ball needs, in the first look and in the closer one: above 0, as a false alarm is worse than a miss.
# The closer look comes where the first saw none, most often because there is none.
_LEAST_ODDS, _LEAST_ODDS_CLOSER = 1.0, 1.7
_SMALL, _MORE_SMALL = 8.0, 1.0  # of so few pixels of radius a box can look like a ball: it needs more
# share of the outline below which the end of a rod can, and what is missing costs, times its share
_CLEAR, _MORE_HIDDEN = 0.75, 4.0
_SURE, _BY_SUPPORT = 0.9975, 5.0  # score beyond which only the edge tells outlines apart; what its share counts
# The outline of a ball leaves a circle by less than a part of the radius (an octagon has 0.023 of it) and of a pixel.
_MOST_BUMPS = 0.010, 0.45
_MOST_HUE = 0.9  # of the disc, distance from the colour's hue over its tolerance
_COMPRESSED = 0.3  # overexposure from which on a hue is not to be trusted: tone curves bend before they clip
_LEAST_VALUE = 0.2
_REDS = 20  # degrees from red, 0, of the hues that skin and brown are mistaken for
_GLARE = 0.95  # value from which on a disc is overexposed, and its paint cannot be seen
_SKIN, _BROWN = (5.0, 0.6), (8.0, 0.72, 0.45)  # degrees towards orange; then least saturation, value
# Of a guess, which may be off, and its ball in glare or hidden by a thing of nearly its hue: part of the disc that must
# have the colour; by how much less its hue is off than noise makes of it, degrees; what its paint may be off
_LEAST_ALIKE, _NOISE, _PAINT_ERROR = 0.15, 2.0, (-1.0, 0.01, 0.02)
_ENOUGH = 0.1  # of the disc that is not overexposed: less tells nothing of the hue


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
    view, small = view_of(image.shape, camera), halved(image)
    measured, rejected = [], []
    looks = (guess_circles, _GUESSES, _LEAST_ODDS), (guess_closer, _CLOSER, _LEAST_ODDS_CLOSER)
    for guess, most, least_odds in looks:
        tries, outlines = 0, []
        for x, y, r in guess(image, small, colour, least_radius)[:_GUESSES].tolist():
            if any(np.hypot(x - o.x, y - o.y) + abs(r - o.r) < 0.3 * r for o in outlines):
                continue  # an earlier guess led to the same outline
            if tries == most:
                break
            try:
                check_colour(image, (x, y, r), colour)
                tries += 1
                found = measure(image, (x, y, r), view, colour, camera, least_radius)
            except NoBallError as why:
                rejected.append(((x, y, r), str(why)))
                continue
            outlines.append(found.outline)
            if why := rejection_reason(found, least_radius, colour):
                rejected.append((_place(found), why))
            else:
                measured.append(found)
        balls, objections = decide(measured, least_odds)
        if balls:
            break
    rejected = (*objections, *rejected)
    if balls:
        return Balls(balls, rejected=rejected)
    if not rejected:
        return Balls(reason=f"nothing {colour.name} and round is seen, of {least_radius:g} pixels or more in radius")
    (x, y, r), why = rejected[0]
    return Balls(reason=f"the likeliest thing, at ({x:.0f}, {y:.0f}) with radius {r:.0f}: {why}", rejected=rejected)


def decide(measured, least_odds=_LEAST_ODDS_CLOSER):
    """Balls best first, and what was rejected as ((x, y, r), why), best first; balls that touch excuse each other."""
    if not measured:
        return [], []
    scores = score(measured)
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
    return balls, [(_place(found), objection(found, _but(balls, found))) for _, found in objections]


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


def _place(found):
    return found.outline.x, found.outline.y, found.outline.r


def rejection_reason(found, least_radius, colour=RED):
    """Why a measured outline is no ball, whatever else speaks for it; "" if nothing of the kind."""
    r = found.outline.r
    if r < least_radius:
        return f"too small, radius {r:.1f} pixels"
    # along rays that show an edge: where there is none something in front may show its own hue
    if why := _other_colour(_hue(found.samples[found.edges[:, 0] > 0, :6]), found.paint, colour):
        return why
    part, pixels = _MOST_BUMPS
    rough = max(found.bumps, 0.6 * float(np.hypot(found.bumps, found.ragged)))  # noise alone makes edges scatter
    if rough * r > part * r + pixels:
        return f"not round: its outline leaves a circle by {rough:.1%} of the radius"
    return ""


def check_colour(image, guess, colour):
    """Refuse a guess if the square in its disc has another colour: measuring its outline takes ten times as long.

    Noise breaks up a thing whose hue is near the bounds of the colour's into many guesses. Raises NoBallError.
    """
    (height, width, _), (x, y, r) = image.shape, guess
    x, y = min(max(x, 0), width - 1), min(max(y, 0), height - 1)
    rows, columns = (slice(max(int(at - 0.7 * r), 0), int(at + 0.7 * r) + 2, 1 + int(r / 8)) for at in (y, x))
    hsv = colour.hsv_of(np.ascontiguousarray(image[rows, columns]))
    alike = colour.loose_mask(hsv) > 0
    part = np.count_nonzero(alike) / alike.size
    if part < _LEAST_ALIKE:
        raise NoBallError(f"hollow, or another colour: {part:.0%} of the disc have the colour")
    seen = paint_of(hsv[alike], colour.centre, colour.swaps)
    paint = [one + error for one, error in zip(seen, _PAINT_ERROR, strict=True)]
    if why := _other_colour(_hue_of_disc(hsv, colour.centre) / colour.tolerance, paint, colour):
        raise NoBallError(why)


@jit()
def _hue_of_disc(hsv, centre):
    """Distance of a disc's hue (h, w, 3) from a colour's, degrees: the least that noise and glare leave of it."""
    hue = np.abs((2.0 * hsv[:, :, 0] - centre + 180) % 360 - 180).ravel()
    clear = hue[hsv[:, :, 2].ravel() < 255 * _GLARE]
    purest = np.sort(hue)[int(_LEAST_ALIKE * hue.size)]
    return min(np.median(clear) - _NOISE, purest + _NOISE) if clear.size > _ENOUGH * hue.size else 0.0


def _other_colour(hue, paint, colour):
    """Why a disc is not of the colour sought: its hue, over the tolerance; nearly black; for reds skin or brown."""
    if hue > _MOST_HUE:
        return f"another colour: its hue is off by {hue:.2f} of the colour's tolerance, a ball's by at most {_MOST_HUE}"
    warm, saturation, value = paint
    if value < _LEAST_VALUE:
        return f"nearly black: value {value:.2f}, a colour has at least {_LEAST_VALUE}"
    if min(colour.hue, 360 - colour.hue) > _REDS:
        return ""
    if warm > _SKIN[0] and saturation < _SKIN[1] and value < _GLARE:
        return f"skin, or another pale orange: saturation {saturation:.2f}, a red as warm has at least {_SKIN[1]}"
    if warm > _BROWN[0] and saturation < _BROWN[1] and value < _BROWN[2]:
        return f"brown: saturation {saturation:.2f} and value {value:.2f}, a red as warm has more of one of them"
    return ""


def _hue(disc):
    """Distance from the colour's hue over its tolerance: of the disc, its darker half, or where it is not overexposed.

    The least of the three: a thing in front has another hue, and an overexposed red looks orange.
    """
    brightness, hue, overexposure, within = np.moveaxis(disc[:, :, [1, 2, 4, 5]], 2, 0)
    dark, clear = (brightness <= 0) & (within > 0), (overexposure < _COMPRESSED) & (within > 0)
    hues = [median(hue)]
    if dark.any():
        hues.append(median(hue[dark]))
    hues.append(median(hue[clear]) if clear.mean() >= _ENOUGH else 0.0)
    return float(min(hues))
