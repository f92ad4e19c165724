"""Between the numbers of the screen (sRGB, 0..255) and amounts of light (0..1)."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers

COLOURS = {  # paints, not light: measured from nothing, chosen to look like toy balls and tape
    "red": (200, 30, 40),
    "orange": (235, 110, 25),
    "yellow": (230, 200, 40),
    "green": (40, 140, 60),
    "blue": (35, 70, 170),
    "skin": (215, 160, 130),
    "white": (235, 235, 230),
    "grey": (128, 128, 128),
    "black": (30, 30, 32),
}


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


def to_linear(s):
    """Light 0..1 of sRGB values 0..1."""
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def to_srgb(light):
    """sRGB values 0..1 of light 0..1."""
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)


def to_bytes(light):
    """uint8 of light (...), clipped at 0 and 1."""
    return np.rint(255 * to_srgb(np.clip(light, 0, 1))).astype(np.uint8)
