"""Views of notebook 09: what they draw is what they were given, and every rendered picture says so."""

import io

import numpy as np
import pytest
from PIL import Image

from ir50p_lab.course import vision_views as views
from ir50p_lab.course.widgets import live
from ir50p_lab.vision import RED, Ball, canny_steps, circle_votes, render_scene, rgb_to_hsv, to_grey
from ir50p_lab.vision.rendering import Ball as SceneBall
from ir50p_lab.vision.rendering import bench_scene


@pytest.fixture(scope="module")
def bench():
    blue = SceneBall(position=(0.35, -0.12, 0.03), colour="blue")
    return render_scene(bench_scene(SceneBall(), blue), seed=1)


def texts(figure):
    return " ".join(t.get_text() for t in figure.findobj(match=lambda a: hasattr(a, "get_text")))


def test_every_picture_says_that_it_is_rendered(bench):
    image, truth = bench
    ball = truth.red_balls[0]
    grey = to_grey(image)
    figures = [
        views.pictures_figure(("a", image), ("b", grey)),
        views.numbers_figure(grey, 100, 100),
        views.ball_hues_figure(image, ball)[0],
        views.MaskView(image[::2, ::2]).figure,
        views.canny_figure(canny_steps(grey, 60, 160)),
        views.balls_figure(image, [Ball(ball.x, ball.y, ball.radius, 0.9)], "found"),
    ]
    for figure in figures:
        figure.savefig(io.BytesIO(), format="png")
        assert views.STAMP in texts(figure)
    assert "photograph" not in texts(views.pictures_figure(("mine", image), source="my_pictures/a.jpg"))


def test_numbers_are_the_pixels(bench):
    grey = to_grey(bench[0])
    figure = views.numbers_figure(grey, 40, 50, n=3)
    written = [int(t.get_text()) for t in figure.axes[0].texts]
    assert written == grey[50:53, 40:43].ravel().tolist()


def test_share_of_the_thesis_ranges(bench):
    image, truth = bench
    ball = truth.red_balls[0]
    _, kept = views.ball_hues_figure(image, ball)
    y, x = np.mgrid[: image.shape[0], : image.shape[1]]
    h, s, _ = rgb_to_hsv(image[np.hypot(x - ball.x, y - ball.y) < 0.95 * ball.radius]).T
    assert kept == pytest.approx(((h > 340) & (s > 0.2) & (s < 0.8)).mean())


@pytest.mark.parametrize(("low", "high"), [(335, 15), (20, 60), (0, 359), (350, 350)])
def test_ranges_of_hue_go_round(low, high):
    hues = np.arange(0, 360.0)
    hsv = np.stack([hues, np.full(360, 0.5), np.full(360, 0.5)], axis=-1)[None]
    mask = views.mask_between(hsv, low, high, 0.2, 0.8, 0.1)[0] > 0
    wanted = (hues >= low) & (hues <= high) if low <= high else (hues >= low) | (hues <= high)
    assert np.array_equal(mask, wanted)
    assert not views.mask_between(hsv, 0, 359, 0.6, 1, 0).any()


def test_mask_panel_redraws(bench):
    image = bench[0][::2, ::2]
    view = views.MaskView(image)
    panel = live(view.figure, lambda s: view.update(RED.mask(image, saturation=s)), s=(0.3, 1, 0.1, 0.3))
    before = panel.image.value
    panel.set(s=1.0)
    assert panel.image.value != before and "% of the picture" in panel.status.value


def test_votes_and_lens():
    votes = circle_votes([(20, 20)], (40, 50), 8)
    views.votes_figure([(20, 20)], votes, (20, 20)).savefig(io.BytesIO(), format="png")
    lens = views.LensView()
    assert "below one pixel from" in lens.update(0.7, 0.002)
    assert lens.blur_pixels(0.7, 0.7, 0.002) == 0
    views.colour_solids_figure().savefig(io.BytesIO(), format="png")


def test_a_click_learns_the_colour(bench):
    image, truth = bench
    panel = views.ClickColour(image)
    assert panel.colour == RED and len(panel.balls) == 1
    blue = next(ball for ball in truth.balls if ball.colour == "blue")
    height, width = image.shape[:2]
    for half in (0, 1):  # in the picture, and at the same place of the mask
        right, up = (blue.x + 0.5 + half * width) / (2 * width), 1 - (blue.y + 0.5) / height
        panel.image_box.clicked = [right, up, float(half)]
        assert np.hypot(panel.balls[0].x - blue.x, panel.balls[0].y - blue.y) < 0.6
    shown = np.asarray(Image.open(io.BytesIO(panel.image_box.value)))
    assert shown.shape[:2] == (height, 2 * width)
    assert (shown[round(blue.y), width + round(blue.x)] == 255).all()


def test_a_refused_click_is_said(bench):
    image = np.full((60, 80, 3), 128, np.uint8)
    panel = views.ClickColour(image)
    panel.click(10, 10)
    assert "grey" in panel.status.value
