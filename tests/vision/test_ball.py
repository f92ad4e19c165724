"""Balls drawn by another route than the renderer: found, measured, and not seen where there are none."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from drawn_balls import add_ball, add_polygon, circle_corners, empty, photograph
from refusals import refused

from ir50p_lab.errors import CalibrationError, ImageError
from ir50p_lab.vision import RED, Ball, Colour, Pinhole, find_balls, render_scene
from ir50p_lab.vision.ball import find
from ir50p_lab.vision.rendering import Patch, SceneBall, bench_scene
from tests.support.random_picture import random_picture

F = 700.0


def drawn(centre=(300, 200), radius=30, **options):
    return photograph(add_ball(empty(grain=0.05), F, centre, radius), **options)


def offset(balls, centre):
    assert len(balls) >= 1, balls.reason
    return np.hypot(balls[0].x - centre[0], balls[0].y - centre[1])


@pytest.mark.parametrize("radius", [9, 30, 80])
@pytest.mark.parametrize("centre", [(318.3, 240.7), (500.8, 120.1)])
def test_centre_to_a_fraction_of_a_pixel(radius, centre):
    picture = drawn(centre, radius, jpeg=90)
    balls = find_balls(picture, camera=Pinhole.simple(F))
    assert len(balls) == 1
    assert isinstance(balls[0], Ball)
    assert offset(balls, centre) < 0.5
    assert balls[0].radius == pytest.approx(radius, rel=0.12)
    assert balls[0].score > 0.5
    assert offset(find_balls(picture), centre) < 1.5  # without a camera one is assumed: here a fifth too short


def test_centre_of_the_sphere_is_not_the_centre_of_its_outline():
    centre, radius = np.array([560.0, 410.0]), 60.0
    picture = drawn(centre, radius, noise=0.5)
    axis = np.array([319.5, 239.5])
    far = np.linalg.norm(centre - axis)
    mask = (RED.mask(picture) > 0).astype(np.uint8)
    y, x = np.nonzero(mask)
    middle = np.array([x.mean(), y.mean()])
    predicted = far * (radius / F) ** 2  # of the ellipse, outwards: to first order
    shift = (middle - centre) @ (centre - axis) / far
    assert shift == pytest.approx(predicted, rel=0.35)
    assert offset(find_balls(picture, camera=Pinhole.simple(F)), centre) < 0.4 < shift


def test_the_lens_is_allowed_for():
    errors = []
    for position in ((0.68, -0.2, 0.03), (0.7, 0.28, 0.03), (0.72, -0.12, 0.03)):
        picture, truth = render_scene(bench_scene(SceneBall(position=position)), seed=4)
        where = truth.balls[0].x, truth.balls[0].y
        assert truth.pinhole.distortion.any()
        errors.append((offset(find_balls(picture, camera=truth.pinhole), where), offset(find_balls(picture), where)))
    known, assumed = np.array(errors).T
    assert (known < 0.3).all() and (known < assumed).all() and (assumed < 2.0).all()


def test_lists_are_ranked_and_say_why_they_are_empty():
    light = empty()
    for centre, radius in (((150, 150), 35), ((420, 260), 25), ((560, 90), 12)):
        add_ball(light, F, centre, radius)
    balls = find_balls(photograph(light))
    assert len(balls) == 3 and balls.reason == ""
    assert [b.score for b in balls] == sorted((b.score for b in balls), reverse=True)
    nothing = find_balls(photograph(empty()))
    assert nothing == [] and "red" in nothing.reason


@pytest.mark.parametrize("radius", [12, 40])
def test_red_and_blue_exchanged_are_said_with_the_remedy(radius):
    balls = find_balls(drawn((420, 150), radius)[..., ::-1])
    assert balls == [] and "at (420, 150)" in balls.reason
    assert "BGR" in balls.reason and "image[..., ::-1]" in balls.reason and "cv2.cvtColor" in balls.reason
    assert "BGR" not in find_balls(photograph(empty())).reason + find_balls(no_ball(6)).reason


def test_channels_are_turned_round_only_where_nothing_is_found(monkeypatch):
    searched = []
    guess = find.guess_circles
    monkeypatch.setattr(find, "guess_circles", lambda *arguments: searched.append(1) or guess(*arguments))
    assert find_balls(drawn()) and len(searched) == 1
    assert not find_balls(photograph(empty())) and len(searched) == 3


@pytest.mark.parametrize("paint", [(153, 82, 57), (130, 60, 45), (165, 75, 60), (150, 50, 50)])
def test_a_red_ball_on_a_table_of_reddish_wood(paint):
    """Most of the picture has the colour; the ball is what differs from most of it."""
    table = Patch(position=(0.25, 0.0), size=(1.7, 1.6), colour=paint)
    picture, truth = render_scene(bench_scene(SceneBall(position=(0.5, 0.1, 0.03)), patches=(table,)), seed=1)
    balls = find_balls(picture)
    assert len(balls) == 1 and offset(balls, (truth.balls[0].x, truth.balls[0].y)) < 2
    bare = replace(bench_scene(patches=(table,)), objects=())
    assert find_balls(render_scene(bare, seed=1)[0]) == []


def test_shown_in_a_notebook():
    assert repr(Ball(12.345678, 200.0, 30.5, 0.987)) == "Ball(x=12.35, y=200.00, radius=30.50, score=0.99)"
    nothing = find_balls(photograph(empty()))
    assert repr(nothing) == f"Balls([], reason={nothing.reason!r})"
    assert repr(find_balls(drawn()))[:8] == "[Ball(x="


def test_twelve_balls_in_touching_pairs():
    light = empty()
    places = [(x + side, y) for x in (110, 320, 530) for y in (140, 340) for side in (-24, 24)]
    for place in places:
        add_ball(light, F, place, 24)
    found = find_balls(photograph(light))
    assert len(found) == 12
    assert all(min(np.hypot(b.x - x, b.y - y) for b in found) < 2 for x, y in places)


@pytest.mark.parametrize("hidden", ["left", "below", "middle"])
def test_partly_hidden(hidden):
    light = add_ball(empty(), F, (300, 200), 40)
    box = {"left": (250, 130, 285, 280), "below": (240, 218, 360, 300), "middle": (293, 130, 310, 280)}[hidden]
    light[box[1] : box[3], box[0] : box[2]] = (0.02, 0.05, 0.03)
    assert offset(find_balls(photograph(light)), (300, 200)) < 1.0


@pytest.mark.parametrize("centre", [(5, 240), (637, 100), (300, 472), (22, 460), (320, -10)])
def test_touching_the_border(centre):
    picture = drawn(centre, 40)
    assert offset(find_balls(picture, camera=Pinhole.simple(F)), centre) < 0.5
    assert offset(find_balls(picture), centre) < 4.0  # a focal length that is a fifth off tells here


def no_ball(name):
    light, red = empty(grain=0.05), (0.6, 0.02, 0.03)
    middle = (300.0, 200.0)
    if name == "ring":
        add_polygon(light, circle_corners(middle, 60))
        add_polygon(light, circle_corners(middle, 38), (0.2, 0.22, 0.25))
    elif isinstance(name, int):
        add_polygon(light, circle_corners(middle, 60, name, 0.3))
    elif name == "small nut":
        add_polygon(light, circle_corners(middle, 15, 6, 0.3))
    elif name == "tape":
        add_polygon(light, [(100, 100), (500, 300), (495, 312), (95, 112)], red)
    elif name == "ellipse":
        add_polygon(light, circle_corners((0, 0), 60) * (1, 0.6) + middle)
    elif name == "shirt":
        light[:, 250:] = red
    elif name == "orange ball":
        add_ball(light, F, middle, 40, colour=(0.85, 0.25, 0.02))
    elif name == "skin":
        add_polygon(light, circle_corners(middle, 50), (0.6, 0.33, 0.22))
    return photograph(light)


@pytest.mark.parametrize(
    "name", ["ring", 3, 4, 5, 6, 8, 10, "small nut", "tape", "ellipse", "shirt", "orange ball", "skin"]
)
def test_no_ball(name):
    balls = find_balls(no_ball(name))
    assert balls == []
    assert len(balls.reason) > 20


def test_a_nut_is_called_one():
    assert "6 corners" in find_balls(no_ball(6)).reason and "ring" in find_balls(no_ball("ring")).reason


@pytest.mark.parametrize("size", [(224, 224), (320, 240), (1280, 720), (1920, 1080)])
def test_sizes(size):
    centre, radius = (0.4 * size[0], 0.6 * size[1]), max(10, size[1] / 14)
    picture = photograph(add_ball(empty(size), 1.1 * size[0], centre, radius))
    assert offset(find_balls(picture), centre) < 0.8


def test_of_two_balls_it_finds_the_one_of_the_colour():
    light = add_ball(empty(), F, (200, 200), 30)
    add_ball(light, F, (420, 250), 35, colour=(0.03, 0.12, 0.5))
    picture = photograph(light)
    blue = Colour(hue=226, tolerance=20)
    assert offset(find_balls(picture, blue), (420, 250)) < 0.5
    assert len(find_balls(picture, blue)) == len(find_balls(picture)) == 1


def test_pixels_alone_decide():
    picture = drawn()
    kept = picture.copy()
    assert find_balls(picture) == find_balls(picture)
    assert (picture == kept).all()


def test_bad_arguments():
    refused("is None", find_balls, None, error=ImageError)
    refused("255", find_balls, np.zeros((48, 64, 3)), error=ImageError)
    picture = drawn()
    for colour in ("red", 12, None):
        refused("Colour", find_balls, picture, colour)
    for radius in (0, -3, np.nan, np.inf, "8"):
        refused("least_radius", find_balls, picture, least_radius=radius)
    refused("Pinhole", find_balls, picture, camera=700)
    refused("320x200", find_balls, picture, camera=Pinhole.simple(F, size=(320, 200)), error=CalibrationError)


def test_tiny_and_plain_pictures():
    for shape in ((1, 1, 3), (1, 2, 3), (2, 5, 3), (9, 9, 3)):
        for value in (0, 255):
            assert find_balls(np.full(shape, value, np.uint8)) == []
    red = np.zeros((60, 80, 3), np.uint8)
    red[..., 0] = 200
    assert find_balls(red) == []
    assert find_balls(red, Colour(hue=120)) == []


def test_random_scenes():
    """A small sample of what tests/targets/vision_ball.py measures."""
    found = 0
    for seed in range(10_000, 10_002):
        picture, truth = random_picture(seed)
        true = truth.balls[0]
        found += any(np.hypot(ball.x - true.x, ball.y - true.y) < 1.5 for ball in find_balls(picture))
        assert find_balls(random_picture(seed, "no_ball")[0]) == []
    assert found >= 1


def disc(colour, seed, radius=26, centre=(310.0, 230.0)):
    """A shaded ball of a paint (r, g, b) 0..255 as the picture shows it where the light falls straight."""
    rng = np.random.default_rng(seed)
    light = tuple((np.array(colour) / 255) ** 2.2)
    place = np.array(centre) + rng.uniform(-60, 60, 2)
    return photograph(add_ball(empty(grain=0.05, seed=seed), F, place, radius, light, ambient=0.7), seed=seed)


@pytest.mark.parametrize(
    "colour", [(40, 8, 10), (30, 4, 4), (105, 52, 36), (90, 45, 32), (110, 60, 42), (76, 26, 11), (64, 24, 13)]
)
def test_a_nearly_black_disc_and_a_brown_sweet_are_no_red_balls(colour):
    for seed in range(3):
        assert not find_balls(disc(colour, seed, radius=22))


@pytest.mark.parametrize("seed", range(3))
def test_fingertips_beside_a_ball_are_no_balls(seed):
    rng = np.random.default_rng(seed)
    light, centre = empty(grain=0.05, seed=seed), np.array([320.0, 240.0])
    skin = (np.array([218, 140, 120]) / 255) ** 2.2 * rng.uniform(0.7, 1.1)
    add_ball(light, F, centre, 30)
    tips = [centre + 52 * np.array([np.cos(a), np.sin(a)]) for a in rng.uniform(0, 6.28) + np.arange(3) * 0.75]
    for tip in tips:
        add_ball(light, F, tip, 15, tuple(skin), ambient=0.7)
    balls = find_balls(photograph(light, seed=seed))
    assert [np.hypot(b.x - 320, b.y - 240) < 2 for b in balls] == [True]


@pytest.mark.parametrize("paint, light", [((0.55, 0.05, 0.03), 12), ((0.55, 0.06, 0.03), 9), ((0.55, 0.02, 0.10), 6)])
def test_overexposed(paint, light):
    """Where red is clipped a red ball looks orange, or pink in bluish light."""
    picture = photograph(light * add_ball(empty(grain=0.05), F, (300, 200), 40, colour=paint))
    assert picture[200, 300, 0] == 255
    assert offset(find_balls(picture), (300, 200)) < 0.5


@pytest.mark.parametrize("paint", [(0.55, 0.14, 0.03), (0.55, 0.03, 0.20)])
def test_orange_and_pink_in_good_light_are_not_red(paint):
    assert find_balls(photograph(add_ball(empty(grain=0.05), F, (300, 200), 40, colour=paint))) == []


def test_dark_and_noisy():
    picture = photograph(0.06 * add_ball(empty(), F, (300, 200), 24), noise=6)
    assert offset(find_balls(picture), (300, 200)) < 1.5


@pytest.mark.parametrize(("x", "y", "r"), [(575, 42, 33), (60, 50, 40), (575, 430, 25), (320, 240, 30)])
def test_a_drawn_disc_is_a_ball_in_a_corner_too(x, y, r):
    """Seen as a ball, its outline there is an ellipse: that makes no corners."""
    picture = np.full((480, 640, 3), 255, np.uint8)
    cv2.circle(picture, (x, y), r, (220, 30, 30), -1, cv2.LINE_AA)
    (ball,) = find_balls(cv2.GaussianBlur(picture, (0, 0), 0.8))
    assert np.hypot(ball.x - x, ball.y - y) < 1.5
