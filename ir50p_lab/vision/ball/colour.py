"""The colour of a thing as ranges of hue, saturation and value."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.image import check_image

# Overexposed red looks pink: from this value on (0..255), hues up to so many degrees beyond its range count as red.
_PINK, _CLIPPED = 24, 245


@dataclass(frozen=True)
class Colour:
    """A range of hues, and how strong the colour must be. Light and shade change the value, but hardly the hue.

    Args:
        hue: middle of the range, degrees 0..360; the range may cross the seam of the scale, 360 = 0.
        tolerance: half width of the range, degrees, 1..60.
        saturation: least saturation, 0..1: below it lie grey, white, and highlights. There is no upper bound, because
            the most saturated pixels are the surest (4.5.1 throws away those above 0.8).
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
        """Whether red and blue are exchanged before the hue is taken, so that the range does not cross the seam."""
        return min(self.hue, 360 - self.hue) < self.tolerance + 1

    @property
    def centre(self):
        """The hue in pictures of `hsv_of`, degrees."""
        return float((240.0 - self.hue) % 360.0 if self.swaps else self.hue)

    def bounds(self, saturation=None):
        """Return the lower and upper bound for cv2.inRange of `hsv_of(image)`.

        They are in OpenCV's scale, 0..179, 0..255, 0..255.

        saturation: a stricter least saturation, 0..1.
        """
        s = max(self.saturation, saturation or 0.0)
        low = (max(0, round((self.centre - self.tolerance) / 2)), round(255 * s), round(255 * self.value))
        return low, (min(179, round((self.centre + self.tolerance) / 2)), 255, 255)

    def loose_mask(self, hsv):
        """Return 255 where an HSV picture of `hsv_of` has the colour in dim or glaring light, darker or paler: (h, w).

        Too much light makes a red pink, because red is clipped and blue is not. A red with more green than blue (hue
        above 0) turns orange and yellow; of such a red only the part that is not overexposed is found.
        """
        low, high = replace(self, saturation=0.7 * self.saturation, value=0.4 * self.value).bounds()
        found = cv2.inRange(hsv, low, high)
        if self.swaps and self.hue > 180:
            pink = cv2.inRange(hsv, (high[0], low[1], _CLIPPED), (min(179, high[0] + _PINK // 2), 255, 255))
            found = cv2.bitwise_or(found, pink)
        return found

    def hsv_of(self, image):
        """Return the HSV of an RGB picture in OpenCV's scale, with red and blue exchanged for a colour at the seam."""
        return cv2.cvtColor(image, cv2.COLOR_BGR2HSV if self.swaps else cv2.COLOR_RGB2HSV)

    def mask(self, image, saturation=None):
        """Return (h, w) uint8: 255 where the picture (RGB uint8, (h, w, 3)) has this colour, else 0.

        saturation: a stricter least saturation, 0..1.
        """
        return cv2.inRange(self.hsv_of(check_image(image)), *self.bounds(saturation))


RED = Colour(hue=355.0, tolerance=20.0, name="red")  # 335 to 15 degrees: both ends of the scale
