"""Ranges of hue, saturation and value across the seam; colours learnt from a click."""

import colorsys

import numpy as np
import pytest
from drawn_balls import add_ball, empty, photograph
from matplotlib.colors import rgb_to_hsv

from ir50p_lab.errors import ImageError, InputError
from ir50p_lab.vision import RED, Colour, learn_colour


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


def picture(colour=(0.03, 0.12, 0.5)):
    return photograph(add_ball(empty(), 700, (200, 200), 40, colour=colour))


@pytest.mark.parametrize("colour", [(0.6, 0.02, 0.03), (0.03, 0.12, 0.5), (0.05, 0.4, 0.08), (0.8, 0.5, 0.02)])
def test_learnt_colour_covers_the_ball_and_little_else(colour):
    shown = picture(colour)
    mask = learn_colour(shown, (205, 195)).mask(shown) > 0
    y, x = np.mgrid[: mask.shape[0], : mask.shape[1]]
    far = np.hypot(x - 200, y - 200)
    assert mask[far < 36].mean() > 0.97
    assert mask[far > 44].mean() < 0.02


def test_a_saturated_thing_on_a_paler_one_of_its_hue():
    """An orange ball on wood: the wood around it is not learnt with it, wherever on the ball the click falls."""
    light = np.empty((480, 640, 3))
    light[:] = (0.42, 0.25, 0.13)
    shown = photograph(add_ball(light, 700, (200, 200), 30, colour=(0.85, 0.25, 0.02)))
    y, x = np.mgrid[: shown.shape[0], : shown.shape[1]]
    far = np.hypot(x - 200, y - 200)
    for xy in (200, 200), (190, 190), (215, 210), (200, 222):
        mask = learn_colour(shown, xy).mask(shown) > 0
        assert mask[far < 27].mean() > 0.95
        assert mask[far > 36].mean() < 0.02
    wood = learn_colour(shown, (400, 300))  # there is no upper bound: the ball lies in the range of the wood
    assert (wood.mask(shown)[(far > 36) | (far < 20)] > 0).mean() > 0.98


def test_no_colour_there():
    with pytest.raises(ImageError, match="grey"):
        learn_colour(picture(), (600, 400))
    with pytest.raises(ImageError, match="one channel"):
        learn_colour(np.zeros((5, 5), np.uint8), (2, 2))


@pytest.mark.parametrize("xy", [(-3, 5), (640, 5), (5, 480), "here", (1,), None])
def test_click_outside(xy):
    with pytest.raises(InputError):
        learn_colour(picture(), xy)


@pytest.mark.parametrize(
    "bad",
    [
        {"hue": -1},
        {"hue": 361},
        {"hue": np.nan},
        {"tolerance": 0},
        {"tolerance": 90},
        {"saturation": 2},
        {"value": "x"},
    ],
)
def test_bad_ranges(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        Colour(**{"hue": 10.0, **bad})


@pytest.mark.parametrize("part", [0.9, 0.95])
def test_a_click_near_the_rim(part):
    """Half of what lies around such a click is the table: the colour learnt is the ball's all the same."""
    light = np.empty((480, 640, 3))
    light[:] = (0.42, 0.25, 0.13)
    shown = photograph(add_ball(light, 700, (200, 200), 30))
    for angle in np.arange(8) * np.pi / 4:
        click = 200 + 30 * part * np.cos(angle), 200 + 30 * part * np.sin(angle)
        mask = learn_colour(shown, click).mask(shown) > 0
        assert mask[190:211, 190:211].mean() > 0.95 and mask.mean() < 0.02


@pytest.mark.parametrize(
    ("hue", "pink", "taken"), [(355, 325, True), (340, 312, True), (10, 340, False), (5, 335, False)]
)
def test_only_a_red_with_more_blue_than_green_looks_pink_in_too_much_light(hue, pink, taken):
    colour = Colour(hue=hue, tolerance=20)
    pixel = np.uint8([[255 * np.array(colorsys.hsv_to_rgb(pink / 360, 0.45, 1.0))]])
    assert (colour.loose_mask(colour.hsv_of(pixel)) > 0).all() == taken
    assert not (colour.loose_mask(colour.hsv_of(pixel // 2)) > 0).any()  # a dim pink is no red
