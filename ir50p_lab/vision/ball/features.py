"""What the classifier looks at: the disc and its surroundings along rays, in units for any ball, light and colour."""

import numpy as np

from ir50p_lab.vision.ball.edge import cast, directions

RAYS = 32
RADII = np.float32((0.1, 0.3, 0.5, 0.66, 0.78, 0.87, 0.94, 1.0, 1.06, 1.13, 1.22, 1.36, 1.6, 2.1))  # of the outline's
CHANNELS = 6  # contrast, brightness, hue, saturation, overexposure, and whether the sample lies in the picture
_BRIGHT, _WHITE = 210, 250  # of 255: from here on a channel is compressed, and then clipped


def look(image, outline, weights, middle, colour):
    """Samples (RAYS, len(RADII), CHANNELS) float32 around a fitted outline.

    weights (3,), middle: of the contrast between ball and surroundings, about 1/2 inside and -1/2 outside. Brightness
    is the logarithm over the disc's median; hue the distance from the colour's over its tolerance, 0 where there is
    hardly a colour; saturation is over the least the colour must have; overexposure is 1 where a channel is clipped: a
    red ball looks orange there. Samples outside the picture are 0.
    """
    unit = directions(RAYS)
    _, rgb, within = cast(image, outline.x, outline.y, outline.radii(*unit), RADII, unit)
    hsv = colour.hsv_of(rgb).astype(np.float32)
    value = np.log(hsv[:, :, 2] + 4)
    hue = np.abs((2 * hsv[:, :, 0] - np.float32(colour.centre) + 180) % 360 - 180) / np.float32(colour.tolerance)
    sure = np.minimum(hsv[:, :, 1] * hsv[:, :, 2] / 6000, 1)  # noise makes the hue of grey and of black
    seen = np.empty((RAYS, len(RADII), CHANNELS), np.float32)
    seen[:, :, 0] = np.minimum(np.maximum(rgb @ weights - np.float32(middle), -1.5), 1.5)
    seen[:, :, 1] = np.minimum(np.maximum(value - median(value[:, :6]), -1.5), 1.5)
    seen[:, :, 2] = np.minimum(hue, 3) * sure
    seen[:, :, 3] = np.minimum(hsv[:, :, 1] / np.float32(255 * max(colour.saturation, 0.05)), 3)
    seen[:, :, 4] = np.minimum(np.maximum((hsv[:, :, 2] - _BRIGHT) / (_WHITE - _BRIGHT), 0), 1)
    seen[:, :, 5] = 1
    return seen * within[:, :, None]


def median(values):
    """Median of an array: NumPy's own takes longer than all the rest of a look."""
    values = values.ravel()
    low, high = (len(values) - 1) // 2, len(values) // 2
    values = np.partition(values, (low, high))
    return (values[low] + values[high]) / 2
