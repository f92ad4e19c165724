"""The colour of a thing as ranges of hue, saturation and value: the default red, or learnt from a picture."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from ir50p_lab.errors import ImageError, InputError
from ir50p_lab.vision.arguments import coordinates
from ir50p_lab.vision.image import check_image

HALF_CIRCLE = 90  # OpenCV's hue is degrees/2: 0..179
# Overexposed red looks pink: from this value on (0..255), hues up to so many degrees beyond its range count as red.
_PINK, _CLIPPED = 24, 245
_PALE = 0.7  # times the saturation at the click: paler pixels of the same hue are another thing
_LEAST_TOLERANCE = 26.0  # degrees, for a colour learnt: with 14 every fifth ball is lost, and false alarms are no fewer
_LEAST_SATURATION, _MOST_SATURATION = 0.18, 0.55  # limits of the least saturation of a colour learnt


@dataclass(frozen=True)
class Colour:
    """A range of hues, and how strong the colour must be; light and shade change value, hardly hue.

    Args:
        hue: middle of the range, degrees 0..360; the range may cross the seam of the scale, 360 = 0.
        tolerance: half width of the range, degrees, 1..60.
        saturation: least saturation, 0..1: below it lie grey, white, and highlights. There is no upper bound: the
            most saturated pixels are the surest (4.5.1 throws away those above 0.8).
        value: least value, 0..1: in darker pixels the hue is noise.
        name: its name in messages.

    Raises InputError for a number out of range.
    """

    hue: float
    tolerance: float = 20.0
    saturation: float = 0.30
    value: float = 0.14
    name: str = "this colour"

    def __post_init__(self):
        for name, low, high in (("hue", 0, 360), ("tolerance", 1, 60), ("saturation", 0, 1), ("value", 0, 1)):
            number = getattr(self, name)
            if not isinstance(number, int | float | np.number) or not low <= number <= high:
                raise InputError(f"Colour: {name} = {number!r}; give a number from {low} to {high}")

    @property
    def swaps(self):
        """True if red and blue are exchanged before the hue is taken, so that the range does not cross the seam."""
        return min(self.hue, 360 - self.hue) < self.tolerance + 1

    @property
    def centre(self):
        """The hue in pictures of `hsv_of`, degrees."""
        return float((240.0 - self.hue) % 360.0 if self.swaps else self.hue)

    def bounds(self, saturation=None):
        """Lower and upper bound for cv2.inRange, in OpenCV's scale (0..179, 0..255, 0..255), of `hsv_of(image)`.

        saturation: a stricter least saturation, 0..1.
        """
        s = max(self.saturation, saturation or 0.0)
        low = (max(0, round((self.centre - self.tolerance) / 2)), round(255 * s), round(255 * self.value))
        return low, (min(179, round((self.centre + self.tolerance) / 2)), 255, 255)

    def loose_mask(self, hsv):
        """255 where an HSV picture of `hsv_of` has the colour as dim or glaring light shows it: darker, paler; (h, w).

        Too much light makes a red pink: red is clipped, blue is not. A red with more green than blue (hue above 0)
        turns orange and yellow: of such a red only what is not overexposed is found.
        """
        low, high = replace(self, saturation=0.7 * self.saturation, value=0.4 * self.value).bounds()
        found = cv2.inRange(hsv, low, high)
        if self.swaps and self.hue > 180:
            pink = cv2.inRange(hsv, (high[0], low[1], _CLIPPED), (min(179, high[0] + _PINK // 2), 255, 255))
            found = cv2.bitwise_or(found, pink)
        return found

    def hsv_of(self, image):
        """HSV of an RGB picture, in OpenCV's scale; with red and blue exchanged for a colour at the seam."""
        return cv2.cvtColor(image, cv2.COLOR_BGR2HSV if self.swaps else cv2.COLOR_RGB2HSV)

    def mask(self, image, saturation=None):
        """255 where the picture (RGB uint8, (h, w, 3)) has this colour, else 0: (h, w) uint8."""
        return cv2.inRange(self.hsv_of(check_image(image)), *self.bounds(saturation))


RED = Colour(hue=355.0, tolerance=20.0, name="red")  # 335 to 15 degrees: both ends of the scale


def learn_colour(image, xy):
    """Learn a Colour from a click: the pixels around it that are like it.

    A small disc around the pixel gives a first hue and saturation. Then all pixels within a twelfth of the picture's
    height are used whose hue is near and which are hardly paler: lit and shaded parts of the same thing. If a twentieth
    of its surroundings has the hue but is paler (an orange ball on wood), the least saturation is half way between.

    Args: image: RGB uint8 (h, w, 3); xy: (x, y) pixel of the click.
    Returns: Colour. Raises InputError for a place outside the picture, ImageError where the thing is grey, white or
    black: then its colour tells nothing.
    """
    image = check_image(image)
    height, width = image.shape[:2]
    x, y = coordinates("xy", xy, 2)
    if not (-0.5 <= x < width - 0.5 and -0.5 <= y < height - 0.5):
        raise InputError(f"({x:g}, {y:g}) lies outside the picture of {width}x{height} pixels")
    radius = height / 12
    rows, cols = np.mgrid[:height, :width]
    far = np.hypot(cols - x, rows - y)
    middle = image[far <= max(1.5, radius / 8)]
    seed = _colour_of(middle)
    near = image[far <= max(3.0, radius)]
    hsv = seed.hsv_of(near[None])[0].astype(float)
    low, high = replace(seed, saturation=_LEAST_SATURATION).bounds()
    alike = ((hsv >= low) & (hsv <= high)).all(axis=1)
    pale = hsv[:, 1] < _PALE * np.median(seed.hsv_of(middle[None])[0, :, 1])
    own = alike & ~pale
    if own.sum() < 8:
        return seed
    colour = _colour_of(near[own])
    ring = far[far <= max(3.0, radius)] > 0.75 * radius
    around = ring & alike & pale
    if around.sum() < max(8, ring.sum() / 20):
        return colour
    between = (np.percentile(hsv[around, 1], 90) + np.percentile(hsv[own, 1], 10)) / 510
    return replace(colour, saturation=max(colour.saturation, min(float(between), _MOST_SATURATION)))


def _colour_of(pixels):
    """Colour of pixels (n, 3): circular mean of the hue, weighted by chroma; ranges from their spread."""
    bgr = np.ascontiguousarray(pixels[None, :, ::-1])
    hue, saturation, value = cv2.cvtColor(bgr, cv2.COLOR_BGR2HSV)[0].astype(float).T
    chroma = saturation * value
    if np.median(saturation) < 40 or np.median(value) < 25:
        raise ImageError(
            f"the place is nearly grey, white or black (median saturation {np.median(saturation) / 255:.2f}, value "
            f"{np.median(value) / 255:.2f}): it has no hue to look for. Click a coloured place"
        )
    turn = np.sum(chroma * np.exp(1j * np.pi * hue / HALF_CIRCLE))
    mean = float(np.degrees(np.angle(turn)) % 360.0)
    off = (2 * hue - mean + 180.0) % 360.0 - 180.0
    keep = np.abs(off) < 45
    spread = float(np.percentile(np.abs(off[keep]), 90))
    least = float(np.percentile(saturation[keep], 10)) / 255
    return Colour(
        hue=mean % 360.0,
        tolerance=min(max(1.6 * spread, _LEAST_TOLERANCE), 30.0),
        saturation=min(max(0.55 * least, _LEAST_SATURATION), 0.40),
        name="the colour learnt",
    )
