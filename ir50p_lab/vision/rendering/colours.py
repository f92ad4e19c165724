"""Between the numbers of the screen (sRGB, 0..255) and amounts of light (0..1)."""

import colorsys
import functools

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers

COLOURS = {  # paints, not light: measured from nothing, chosen to look like toy balls and tape
    "red": (200, 30, 40),
    "orange": (235, 110, 25),
    "yellow": (230, 200, 40),
    "green": (40, 140, 60),
    "blue": (35, 70, 170),
    "purple": (110, 45, 130),
    "pink": (235, 120, 150),
    "brown": (120, 65, 40),
    "skin": (215, 160, 130),
    "white": (235, 235, 230),
    "grey": (128, 128, 128),
    "black": (30, 30, 32),
}
_STEPS = 4096


def light_of(colour):
    """Linear (3,) of a colour name or (r, g, b) 0..255."""
    if isinstance(colour, str):
        if colour not in COLOURS:
            raise InputError(f"colour {colour!r} is not known: give (r, g, b) or one of {', '.join(COLOURS)}")
        colour = COLOURS[colour]
    rgb = numbers("colour", colour, unit="red, green, blue, 0..255")
    if rgb.shape != (3,) or not ((rgb >= 0) & (rgb <= 255)).all():
        raise InputError(f"colour {colour!r}: give (r, g, b), three numbers 0..255, or one of {', '.join(COLOURS)}")
    return to_linear(rgb / 255)


def is_red(colour):
    """Whether a paint, name or (r, g, b) 0..255, is what the detector of red balls has to find."""
    if isinstance(colour, str):
        return colour == "red"
    hue, saturation, value = colorsys.rgb_to_hsv(*(c / 255 for c in colour))
    return (hue * 360 <= 9 or hue * 360 >= 349) and saturation >= 0.7 and value >= 0.4


def to_linear(s):
    """Light 0..1 of sRGB values 0..1."""
    s = np.asarray(s, dtype=float)
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def to_srgb(light):
    """sRGB values 0..1 of light 0..1."""
    light = np.asarray(light, dtype=float)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)


def to_bytes(light):
    """uint8 of light (...), clipped at 0 and 1."""
    # square root first: equal steps of the table are then about equal steps of the result, also in the dark
    index = np.sqrt(np.clip(light, 0, 1)) * np.float32(_STEPS - 1) + np.float32(0.5)
    return _root_table()[index.astype(np.uint16)]


@functools.lru_cache(maxsize=1)
def _root_table():
    return np.rint(255 * to_srgb(np.linspace(0, 1, _STEPS) ** 2)).astype(np.uint8)
