"""Ranges of hue, saturation and value across the seam."""

import colorsys

import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv
from refusals import refused

from ir50p_lab.vision import RED, Colour


def every_colour():
    steps = np.arange(0, 256, 5, dtype=np.uint8)
    return np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, steps.size, 3)


@pytest.mark.parametrize("hue", [0, 5, 20, 40, 120, 200, 300, 340, 355, 360])
def test_mask_is_the_range_on_the_circle(hue):
    colour = Colour(hue=hue, tolerance=20, saturation=0.4, value=0.2)
    picture = every_colour()
    h, s, v = np.moveaxis(rgb_to_hsv(picture / 255), -1, 0)
    off = np.abs((360 * h - hue + 180) % 360 - 180)
    mask = colour.mask(picture) > 0
    assert mask[(off < 17) & (s > 0.42) & (v > 0.22)].all()
    assert not mask[(off > 23) | (s < 0.38) | (v < 0.18)].any()


def test_red_takes_both_ends_and_saturated_pixels():
    reds = np.array([[(200, 30, 40), (200, 45, 30), (255, 0, 0), (180, 20, 60)]], np.uint8)
    assert (RED.mask(reds) == 255).all()
    others = np.array([[(235, 110, 25), (215, 160, 130), (120, 120, 120), (40, 140, 60), (230, 200, 40)]], np.uint8)
    assert (RED.mask(others) == 0).all()


def test_bad_ranges():
    bad = {"hue": (-1, 361, np.nan), "tolerance": (0, 90), "saturation": (2,), "value": ("x",)}
    for name, values in bad.items():
        for value in values:
            refused(name, Colour, **{"hue": 10.0, name: value})


@pytest.mark.parametrize(
    ("hue", "pink", "taken"), [(355, 325, True), (340, 312, True), (10, 340, False), (5, 335, False)]
)
def test_only_a_red_with_more_blue_than_green_looks_pink_in_too_much_light(hue, pink, taken):
    colour = Colour(hue=hue, tolerance=20)
    pixel = np.uint8([[255 * np.array(colorsys.hsv_to_rgb(pink / 360, 0.45, 1.0))]])
    assert (colour.loose_mask(colour.hsv_of(pixel)) > 0).all() == taken
    assert not (colour.loose_mask(colour.hsv_of(pixel // 2)) > 0).any()  # a dim pink is no red
