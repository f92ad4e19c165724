"""The classifier of the ball detector: its weights, what it may not depend on, and how they are trained."""

import dataclasses

import numpy as np
import pytest
from drawn_balls import add_ball, add_polygon, circle_corners, empty, photograph

from ir50p_lab.vision import RED, Ball, Colour, find_balls, learn_colour
from ir50p_lab.vision.ball import find
from ir50p_lab.vision.ball.classifier import WEIGHTS, score
from ir50p_lab.vision.ball.features import RAYS, median
from ir50p_lab.vision.ball.find import decide, least_score
from ir50p_lab.vision.ball.fit import view_of
from ir50p_lab.vision.ball.measure import measure
from tests.support.scene_truth import scene_truth
from tests.targets.ball_examples import BALL, NEARLY, NOTHING, behind, crowded_examples, examples, painted
from tests.targets.crowded_scene import crowded_scene
from tests.targets.train_ball_classifier import LAYERS, gradient, logit, start

RNG = np.random.default_rng(3)


def measured(light, guess=(300, 200, 40), colour=RED):
    picture = photograph(light)
    return measure(picture, guess, view_of(picture.shape), colour)


def test_ball_and_octagon():
    ball = measured(add_ball(empty(grain=0.05), 700, (300, 200), 40))
    octagon = measured(add_polygon(empty(grain=0.05), circle_corners((300, 200), 40, 8)))
    scores = score([ball, octagon])
    assert scores[0] > 0.9 and scores[1] < 0.5


def test_weights_are_small():
    assert WEIGHTS.stat().st_size < 300_000


def test_small_and_half_hidden_must_be_surer():
    assert 0.8 < least_score(30, 1.0) < least_score(7, 1.0) < 0.97
    assert least_score(30, 0.9) < least_score(30, 0.7) < least_score(30, 0.4) < least_score(7, 0.4) < 0.999


@pytest.mark.parametrize("surely,first,closer", [(0.5, 0, 0), (0.8, 1, 0), (0.9, 1, 1)])
def test_the_closer_look_must_be_surer(surely, first, closer, monkeypatch):
    """It comes where the first saw nothing: there is more often none."""
    picture = photograph(add_ball(empty(grain=0.05), 700, (300, 200), 40))
    monkeypatch.setattr(find, "score", lambda found, others=None: np.full(len(found), surely))
    assert len(find_balls(picture)) == first
    monkeypatch.setattr(find, "guess_circles", lambda *_: np.empty((0, 3)))
    assert len(find_balls(picture)) == closer


@pytest.mark.parametrize("order", [1, -1])
def test_of_two_sure_outlines_the_one_with_most_edge(order):
    """And no part of a ball is among what is rejected."""
    ball = measured(add_ball(empty(grain=0.05), 700, (300, 200), 40))
    assert score([ball])[0] > 0.9975
    less = dataclasses.replace(ball, support=0.8 * ball.support, centre=(0.0, 0.0))
    octagon = measured(add_polygon(empty(grain=0.05), circle_corners((300, 200), 40, 8)))
    outlines = [ball, less, octagon][::order]
    (found,), rejected = decide(outlines, score(outlines))
    assert (found.x, found.y) == ball.centre and found.support == ball.support and not rejected
    balls, (why,) = decide([octagon], score([octagon]))
    assert balls == [] and "not round" in why[1]


def test_turned_and_alone_or_among_others():
    ball = measured(add_ball(empty(grain=0.05), 700, (300, 200), 40))
    turned = dataclasses.replace(ball, samples=np.roll(ball.samples, 5, axis=0), edges=np.roll(ball.edges, 5, axis=0))
    np.testing.assert_allclose(score([ball]), score([turned, ball])[1], atol=1e-5)
    np.testing.assert_allclose(score([ball]), score([turned])[0], atol=1e-4)


def test_what_another_ball_covers_is_left_out():
    found = measured(add_ball(add_ball(empty(), 700, (300, 200), 40), 700, (345, 215), 35))
    assert score([found], [[Ball(345.0, 215.0, 35.0, 0.9)]])[0] > max(score([found])[0], 0.98)


@pytest.mark.parametrize("radius", [30, 48, 52])
def test_guess_too_small_or_too_large(radius):
    found = measured(add_ball(empty(grain=0.05), 700, (300, 200), 40), guess=(301, 199, radius))
    assert np.hypot(found.outline.x - 300, found.outline.y - 200) < 0.3 and abs(found.outline.r - 40) < 0.5


@pytest.mark.parametrize("paint", [(0.03, 0.12, 0.5), (0.05, 0.4, 0.08), (0.7, 0.45, 0.02)])
def test_any_colour(paint):
    """The classifier has seen red balls only: shape and shading count, not the hue."""
    picture = photograph(add_ball(empty(), 700, (300, 200), 30, colour=paint))
    assert find_balls(picture, learn_colour(picture, (300, 200)))[0].score > 0.9


@pytest.mark.parametrize("green,light", [(0.05, 12), (0.05, 16), (0.06, 9)])
def test_overexposed(green, light):
    """Where red is clipped a red ball looks orange; a thing that is orange where nothing is clipped is none."""
    picture = photograph(light * add_ball(empty(grain=0.05), 700, (300, 200), 40, colour=(0.55, green, 0.03)))
    assert picture[200, 300, 0] == 255 and picture[200, 300, 1] > picture[200, 300, 2] + 40
    assert np.hypot(find_balls(picture)[0].x - 300, find_balls(picture)[0].y - 200) < 0.5
    picture = photograph(add_ball(empty(grain=0.05), 700, (300, 200), 40, colour=(0.55, 0.09, 0.03)))
    assert find_balls(picture) == [] and "another colour" in find_balls(picture).reason


@pytest.mark.parametrize("front", [(0.3, 0.2, 0.1), (0.3, 0.28, 0.1), (0.05, 0.2, 0.05)])
@pytest.mark.parametrize("green,found", [(0.05, True), (0.12, False)])
def test_overexposed_behind_a_thing_in_good_light(front, green, found):
    """The hue is that of the ball's own part of the disc, not of what hides the rest."""
    light = 6 * add_ball(empty(grain=0.05), 700, (300, 200), 40, colour=(0.55, green, 0.03))
    light = add_polygon(light, [(200, 210), (420, 190), (420, 300), (200, 300)], colour=front)
    balls = find_balls(photograph(light))
    assert [np.hypot(ball.x - 300, ball.y - 200) < 1 for ball in balls] == [True] * found


@pytest.mark.parametrize("blue,light", [(0.07, 12), (0.10, 6), (0.10, 9)])
def test_overexposed_in_bluish_light(blue, light):
    """A red ball turns pink, beyond the hues of red; a thing that is pink in good light is none."""
    pink = (0.55, 0.03, 0.20)
    picture = photograph(light * add_ball(empty(grain=0.05), 700, (300, 200), 40, colour=(0.55, 0.02, blue)))
    assert picture[200, 300, 0] == 255 and picture[200, 300, 2] > picture[200, 300, 1] + 20
    assert np.hypot(find_balls(picture)[0].x - 300, find_balls(picture)[0].y - 200) < 0.5
    assert find_balls(photograph(add_ball(empty(grain=0.05), 700, (300, 200), 40, colour=pink))) == []


@pytest.mark.parametrize("hue,pink", [(345, True), (355, True), (5, False), (12, False), (120, False)])
def test_which_colours_turn_pink(hue, pink):
    colour = Colour(hue=hue)
    beyond = colour.bounds()[1][0] + 5  # it goes on where the colour's own range ends, if a channel is clipped
    hsv = np.uint8([[(beyond, 255, 255), (beyond, 255, 200)]])
    assert (colour.loose_mask(hsv)[0] > 0).tolist() == [pink, False]


def test_dark_and_noisy():
    light = 0.06 * add_ball(empty(), 700, (300, 200), 24)
    balls = find_balls(photograph(light, noise=6))
    assert np.hypot(balls[0].x - 300, balls[0].y - 200) < 1.5


def test_looser_colour():
    looser = Colour(hue=355.0, tolerance=20.0, saturation=0.3, value=0.14).looser
    assert looser.value < 0.14 and looser.saturation < 0.3


def test_examples_tell_balls_from_the_rest():
    found = [one for seed in range(101, 103) for one in examples(seed, "ball")]
    labels = np.array([label for *_, label in found])
    assert {NOTHING, BALL} <= set(labels) <= {NOTHING, BALL, NEARLY}
    assert all(rays.shape[0] == RAYS and np.isfinite(rays).all() and np.isfinite(m).all() for rays, m, _ in found)
    shapes = [label for turn in range(2) for *_, label in painted(103, turn)]
    assert {NOTHING, BALL} <= set(shapes)  # discs and others
    halves = {label for seed in range(101, 104) for *_, label in behind(seed)}
    assert {NOTHING, BALL} <= halves  # rods and balls


@pytest.mark.parametrize("kind", ["ball", "no_ball"])
def test_crowded_scenes(kind):
    """Many things; red balls only where the kind says so."""
    scenes = [crowded_scene(seed, kind) for seed in range(110_000, 110_004)]
    assert all(scene.pinhole.size[0] <= 640 and len(scene.objects) + len(scene.patches) >= 5 for scene in scenes)
    balls = [b for scene in scenes for b in scene_truth(scene).balls if b.is_red and b.visible > 0.6]
    assert len(balls) > 4 if kind == "ball" else not balls
    labels = {label for seed in range(110_000, 110_004) for *_, label in crowded_examples(seed, kind, copies=1)}
    assert NOTHING in labels and (BALL in labels) == (kind == "ball")


@pytest.mark.parametrize("name", LAYERS)
def test_gradient_against_differences(name):
    net = {key: value.astype(float) for key, value in start(RNG, 9, 5).items()}
    rays, numbers = RNG.normal(size=(6, RAYS, 9)), RNG.normal(size=(6, 5))
    labels, weights = np.array([0.0, 1, 1, 0, 1, 0]), RNG.uniform(0.5, 2, 6)
    slope = np.asarray(gradient(rays, numbers, labels, weights, net)[0][name])
    along = RNG.normal(size=net[name].shape)
    ends = [gradient(rays, numbers, labels, weights, net | {name: net[name] + e * along})[1] for e in (1e-5, -1e-5)]
    assert np.sum(slope * along) == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-3, abs=1e-6)


def test_networks_agree_in_shape():
    with np.load(WEIGHTS) as file:
        count = {name: len(file[name]) for name in LAYERS}
        channels, numbers = len(file["ray_mean"]), len(file["number_mean"])
        net = {name: file[name][0].astype(np.float32) for name in LAYERS}
    assert len(set(count.values())) == 1
    assert logit(np.zeros((2, RAYS, channels), np.float32), np.zeros((2, numbers), np.float32), net)[0].shape == (2,)


@pytest.mark.parametrize("shape", [(1,), (4, 3), (32, 6), (5, 5)])
def test_median(shape):
    values = RNG.normal(size=shape)
    assert median(values) == pytest.approx(np.median(values))
