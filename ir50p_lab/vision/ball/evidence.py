"""What speaks against a ball, in words: first its colour; of the rest the classifier decides, and this says why."""

from math import log

import numpy as np

from ir50p_lab.jit import jit
from ir50p_lab.vision.ball.features import median

_WELL_APART = 5.5  # standard deviations between ball and surroundings, usual for a ball
_MOST_HUE = 0.9  # of the disc, distance from the colour's hue over its tolerance
_COMPRESSED = 0.3  # overexposure from which on a hue is not to be trusted: tone curves bend before they clip
_LEAST_VALUE = 0.2
_REDS = 20  # degrees from red, 0, of the hues that skin and brown are mistaken for
_GLARE = 0.95  # value from which on a disc is overexposed, and its paint cannot be seen
_SKIN, _BROWN = (5.0, 0.6), (8.0, 0.72, 0.45)  # degrees towards orange; then least saturation, value
_DARK_BROWN = 14.0, 0.33  # degrees; least value, however saturated
# Of a guess, which may be off, and its ball in glare or hidden by a thing of nearly its hue: part of the disc that must
# have the colour; by how much less its hue is off than noise makes of it, degrees; what its paint may be off
_LEAST_ALIKE, _NOISE, _PAINT_ERROR = 0.15, 2.0, (-1.0, 0.01, 0.02)
_ENOUGH = 0.1  # of the disc that is not overexposed: less tells nothing of the hue


class NoBallError(Exception):
    """Why there is no ball at a guess; then, if something else has an outline there, its circle (x, y, r)."""


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
    if why := other_hue(_hue_of_disc(hsv, colour.centre) / colour.tolerance) or other_paint(paint, colour):
        raise NoBallError(why)


@jit()
def _hue_of_disc(hsv, centre):
    """Distance of a disc's hue (h, w, 3) from a colour's, degrees: the least that noise and glare leave of it."""
    hue = np.abs((2.0 * hsv[:, :, 0] - centre + 180) % 360 - 180).ravel()
    clear = hue[hsv[:, :, 2].ravel() < 255 * _GLARE]
    purest = np.sort(hue)[int(_LEAST_ALIKE * hue.size)]
    return min(np.median(clear) - _NOISE, purest + _NOISE) if clear.size > _ENOUGH * hue.size else 0.0


def other_hue(hue):
    """Why a disc has not the hue sought, off by `hue` of the tolerance; "" if it may have."""
    if hue <= _MOST_HUE:
        return ""
    return f"another colour: its hue is off by {hue:.2f} of the colour's tolerance, a ball's by at most {_MOST_HUE}"


def other_paint(paint, colour):
    """Why a paint is not of the colour sought: nearly black; for reds skin or brown; "" if it may be."""
    warm, saturation, value = paint
    if value < _LEAST_VALUE:
        return f"nearly black: value {value:.2f}, a colour has at least {_LEAST_VALUE}"
    if min(colour.hue, 360 - colour.hue) > _REDS:
        return ""
    if warm > _SKIN[0] and saturation < _SKIN[1] and value < _GLARE:
        return f"skin, or another pale orange: saturation {saturation:.2f}, a red as warm has at least {_SKIN[1]}"
    dark = warm > _DARK_BROWN[0] and value < _DARK_BROWN[1]
    if dark or (warm > _BROWN[0] and saturation < _BROWN[1] and value < _BROWN[2]):
        return f"brown: saturation {saturation:.2f} and value {value:.2f}, a red as warm has more of one of them"
    return ""


def hue_of(disc):
    """Distance of the hue from the colour's over its tolerance: of the disc, its darker half, or what no glare hides.

    The least of the three, of samples (rays, radii, channels) of `look`: a thing in front has another hue, and an
    overexposed red looks orange.
    """
    brightness, hue, overexposure, within = np.moveaxis(disc[:, :, [1, 2, 4, 5]], 2, 0)
    dark, clear = (brightness <= 0) & (within > 0), (overexposure < _COMPRESSED) & (within > 0)
    hues = [median(hue)]
    if dark.any():
        hues.append(median(hue[dark]))
    hues.append(median(hue[clear]) if clear.mean() >= _ENOUGH else 0.0)
    return float(min(hues))


@jit()
def paint_of(hsv, centre, swaps):
    """Of HSV samples (n, 3) of the disc: hue from the colour's towards orange, degrees; saturation; value, 0..1.

    Saturation is that of the purest fifth, which gloss does not pale; value that of the lightest tenth: a ball has one,
    what is nearly black has none. centre, swaps: of the Colour.
    """
    off = (2.0 * hsv[:, 0] - centre + 180) % 360 - 180
    warm = np.median(-off if swaps else off)
    return warm, np.sort(hsv[:, 1])[int(0.8 * len(hsv))] / 255, np.sort(hsv[:, 2])[int(0.9 * len(hsv))] / 255


def objection(found, others=()):
    """The strongest objection to a Measured, as a text; others: Balls that may touch it.

    Each has a weight times something measured, about 1 where it alone makes a ball doubtful.
    """
    o = found.outline
    waves, pixels = found.bumps * o.r, 0.3 + 0.01 * o.r
    missing, outside, colourless = max(found.seen - found.support, 0.0), 1 - found.seen, 1 - found.fill
    goes_on = beyond(found, others)
    said = (
        (1.8 * missing, f"{missing:.0%} of the circle show no edge"),
        (4.3 * outside, f"{outside:.0%} of the circle lie outside the picture"),
        (5.6 * goes_on, f"the colour goes on beyond {goes_on:.0%} of the circle"),
        (5.5 * colourless, f"{colourless:.0%} of the disc have another colour"),
        (3.7 * waves / pixels, f"the outline is not round: waves of {waves:.2f} pixels on a radius of {o.r:.0f}"),
        (found.oval * o.r / (0.4 + 0.06 * o.r), "the outline is oval"),
        (2.35 * log(_WELL_APART / max(found.apart, 0.2)), "it hardly stands out from its surroundings"),
        (2.9 * min(-log(o.r / 20), 2.0), f"it is small, radius {o.r:.1f} pixels, and what is seen is not enough"),
    )
    weight, text = max(said, key=lambda one: one[0])
    return text if weight > 0.3 else "taken together, edge and shading are not those of a ball"


def beyond(found, others=()):
    """Share of the circle beyond which the colour goes on, and no other ball explains it."""
    here = found.beyond
    if others and here.any():
        angle = np.arange(len(here)) * (2 * np.pi / len(here))
        o = found.outline
        x, y = o.x + 1.1 * o.r * np.cos(angle), o.y + 1.1 * o.r * np.sin(angle)
        for other in others:
            here = here & (np.hypot(x - other.x, y - other.y) > 1.1 * other.radius + 1)
    return float(here.mean())
