"""Hue, saturation, value: by the definition, and in the scales of the thesis, OpenCV and MATLAB (3.1.3)."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice
from ir50p_lab.vision.checks import coordinates

HUE_SCALES = {"degrees": 360.0, "OpenCV": 180.0, "8 bit": 255.0, "MATLAB": 1.0}
"""A full turn of hue in each scale: OpenCV halves degrees to fit a byte, MATLAB has 0..1, 3.1.3 'scaled to 8 bit'."""


def rgb_to_hsv(rgb):
    """Hue (degrees, 0 <= h < 360), saturation and value (0..1) of colours (..., 3) of bytes: (..., 3) float.

    V is the largest of r, g, b; S = (V - smallest)/V; the hue is the angle on the colour circle, red 0, green 120,
    blue 240, in between by the middle one. Grey has no hue: 0 by convention. Raises InputError for another shape, and
    for numbers that are no bytes.
    """
    from matplotlib.colors import rgb_to_hsv as hsv_of

    rgb = coordinates("rgb", rgb, 3, "0..255")
    if rgb.min(initial=0) < 0 or rgb.max(initial=0) > 255:
        raise InputError("rgb holds a number outside 0..255")
    return hsv_of(rgb / 255) * (360, 1, 1)


def hue_in(scale, hue_deg):
    """A hue, hue_deg in degrees, in another scale: one of HUE_SCALES. Raises InputError for an unknown one."""
    return np.asarray(hue_deg, dtype=float) / 360.0 * HUE_SCALES[choice("scale", scale, tuple(HUE_SCALES))]


def hue_distance(a_deg, b_deg):
    """How far two hues are apart on the circle, degrees 0..180: 350 and 10 are 20 apart, not 340."""
    return np.abs((np.asarray(a_deg, dtype=float) - b_deg + 180) % 360 - 180)


def threshold(values, T):
    """1 where values >= T, else 0, as (3.1) has it: uint8 of the same shape."""
    return (np.asarray(values) >= T).astype(np.uint8)
