"""Is it a ball? Nine numbers about an outline and its colours are weighed by a logistic regression.

Its weights were fitted to rendered scenes with red balls and similar things; no photograph was among them. The number
that counts most against a ball is given as the reason.
"""

import cv2
import numpy as np

from ir50p_lab.vision.ball.rays import ANGLES, cast

_BIAS = 5.32  # log odds of a ball if all numbers are 0
_AGAINST = (  # how much log odds 1 of each number takes away, and the reason given if it takes most
    (-2.3, "it is small"),
    (4.43, "{:.0%} of the circle shows no edge"),
    (2.23, "{:.0%} of the circle lies outside the picture"),
    (3.64, "{:.0%} of the disc has another colour"),
    (2.84, "its outline is not round"),
    (2.28, "its hue is off by {:.2f} of the tolerance"),
    (1.16, "the colour goes on beyond {:.0%} of the circle"),
    (-1.55, "its rim differs from its middle"),
    (2.51, "it hardly stands out from its surroundings"),
)
_LEAST_SCORE = 0.65  # probability: if it is less, it is not a ball. Higher: fewer false alarms, more balls missed
_LEAST_FILL = 0.55  # share of the disc: if less has the colour, or is too light to tell, it has another colour
_GLARING = 242  # value, 0..255: of lighter pixels the hue tells little
_DISC = np.arange(1, 10) / 10  # radii: where samples along a ray are taken inside the outline
_BEYOND = np.array([1.06, 1.14])  # radii: and outside it
# It is a polygon if a wave around the outline leaves less than this share of its variance, and is higher, in radii.
_EXPLAINED, _CORNERS = 0.5, 0.01
_ENOUGH = 20  # rays: if fewer have an edge, corners are not counted
_GLOSS = 0.35  # share of the disc: if highlights cover more, they are another colour, white


def judge(image, outline, colour):
    """Return (score 0..1, the reason why it is not a ball, or "") for an Outline in an RGB picture (h, w, 3)."""
    r, on = outline.radius, outline.on
    hsv, loose, filled, fill, beyond = _colours(image, outline, colour)
    why = _other_shape(outline, filled)
    if not loose.any() or (loose | (hsv[..., 2] > _GLARING)).mean() < _LEAST_FILL:
        why = why or f"{1 - fill:.0%} of the disc has another colour"
    why = why or _other_paint(hsv[loose], colour)
    if why:
        return 0.0, why
    scatter = 1.48 * np.median(np.abs(outline.off[on])) if on.any() else np.inf  # px, as a standard deviation
    numbers = (
        np.log(r / 20),
        1 - on.mean(),
        1 - outline.seen,
        1 - fill,
        scatter / (0.3 + 0.01 * r),
        _hue_off(hsv, loose, colour),
        beyond,
        1 - min(np.median(outline.height[on]), 1.5) if on.any() else 1.0,
        np.log(5.5 / outline.contrast),
    )
    counts = [weight * number for (weight, _), number in zip(_AGAINST, numbers, strict=True)]
    score = float(1 / (1 + np.exp(sum(counts) - _BIAS)))
    worst = int(np.argmax(counts))
    return score, "" if score >= _LEAST_SCORE else _AGAINST[worst][1].format(numbers[worst])


def _colours(image, outline, colour):
    """HSV (rays, 9, 3) of the disc; where it has the colour, where colour or gloss; shares of disc and surroundings."""
    r, rim = outline.radius, 1.5  # px on both sides of the outline that are left out: colours mix there
    reach = np.concatenate([r * _DISC - rim * (_DISC > 0.85), r * _BEYOND + rim])
    hsv = colour.hsv_of(cast(image, outline.x, outline.y, reach)[0])
    disc = hsv[:, : len(_DISC)]
    loose = colour.loose_mask(disc) > 0
    gloss = (disc[..., 2] > 200) & (disc[..., 1] < 255 * colour.saturation)
    area = _DISC / _DISC.sum()
    shine = (gloss @ area).mean()
    fill = (loose @ area).mean() + shine * (shine < _GLOSS)
    goes_on = cv2.inRange(hsv[:, len(_DISC) :], *colour.bounds()) > 0
    return disc, loose, loose | gloss, fill, goes_on.all(axis=1).mean()


def _turned(hsv, colour):
    """Hues minus the middle hue of the colour, degrees -180..180."""
    return (2.0 * hsv[..., 0] - colour.centre + 180) % 360 - 180


def _hue_off(hsv, loose, colour):
    """Median distance of the disc's hue from the colour's, over its tolerance; glaring pixels are left out."""
    clear = loose & (hsv[..., 2] < _GLARING)
    chosen = clear if clear.mean() > 0.1 else loose
    return float(np.median(np.abs(_turned(hsv[chosen], colour))) / colour.tolerance)


def _other_paint(hsv, colour):
    """Return why colours (n, 3) HSV are not the one sought (nearly black; a red: skin or brown), "" if they may be."""
    saturation, value = np.percentile(hsv[:, 1], 80) / 255, np.percentile(hsv[:, 2], 90) / 255
    if value < 0.2:
        return f"nearly black: value {value:.2f}"
    if min(colour.hue, 360 - colour.hue) > 20:
        return ""
    orange = float(np.median(_turned(hsv, colour))) * (-1 if colour.swaps else 1)  # degrees from the red towards yellow
    if orange > 5 and saturation < 0.6 and value < 0.95:
        return f"skin, or another pale orange: saturation {saturation:.2f}"
    if (orange > 14 and value < 0.33) or (orange > 8 and saturation < 0.72 and value < 0.45):
        return f"brown: saturation {saturation:.2f} and value {value:.2f}"
    return ""


def _other_shape(outline, filled):
    """Return "a ring" or "a nut" if that is its shape, "" if it may be a ball. filled: (rays, 9), of colour or gloss.

    A polygon of n corners has its edge farther out n times around: one wave of n explains nearly all of `off`.
    """
    if filled[:, 6:].mean() > 0.8 and filled[:, 2:5].mean() < 0.4:
        return "a ring: its middle has another colour"
    angle, off = ANGLES[outline.on], outline.off[outline.on]
    if len(off) < _ENOUGH:
        return ""
    ellipse = np.column_stack(
        [np.ones(len(off)), np.cos(2 * angle), np.sin(2 * angle)]
    )  # a disc, or a ball in a corner
    off = off - ellipse @ np.linalg.lstsq(ellipse, off)[0]
    for corners in range(5, 11):
        A = np.column_stack([np.ones(len(off)), np.cos(corners * angle), np.sin(corners * angle)])
        wave, rest, *_ = np.linalg.lstsq(A, off)
        if rest.sum() < _EXPLAINED * off.var() * len(off) and np.hypot(*wave[1:]) > _CORNERS * outline.radius:
            return f"a nut, or something else of {corners} corners"
    return ""
