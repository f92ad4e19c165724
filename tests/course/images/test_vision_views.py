"""Views of notebook 16: what they draw is what they were given, and every rendered picture says so."""

import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from ir50p_lab.course.draw.pictures import STAMP, pictures_figure
from ir50p_lab.course.draw.widgets import live
from ir50p_lab.course.images import views
from ir50p_lab.vision import (
    RED,
    Ball,
    Balls,
    canny_steps,
    render_scene,
    rgb_to_hsv,
    to_grey,
)
from ir50p_lab.vision.rendering import SceneBall, bench_scene


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
        pictures_figure(("a", image), ("b", grey)),
        views.numbers_figure(grey, 100, 100),
        views.ball_hues_figure(image, ball)[0],
        views.MaskView(image[::2, ::2]).figure,
        views.canny_figure(canny_steps(grey, 60, 160), 60, 160),
        views.balls_figure(image, Balls([Ball(ball.x, ball.y, ball.radius, 0.9)]), "found"),
        views.sheet_figure(8 * [(image, [], (ball.x, ball.y, ball.radius))]),
    ]
    for figure in figures:
        figure.savefig(io.BytesIO(), format="png")
        assert STAMP in texts(figure)
    assert "photograph" not in texts(pictures_figure(("mine", image), source="my_pictures/a.jpg"))


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


def test_mask_panel_redraws(bench):
    image = bench[0][::2, ::2]
    view = views.MaskView(image)
    panel = live(view.figure, lambda s: view.update(RED.mask(image, saturation=s) > 0), s=(0.3, 1, 0.1, 0.3))
    before = panel.image.value
    panel.set(s=1.0)
    assert panel.image.value != before and "% of the picture" in panel.status.value


def test_crests_in_classes():
    steps = canny_steps(np.repeat(np.repeat([[0, 20, 70, 70]], 9, axis=1), 20, axis=0).astype(np.uint8), 60, 160)
    shown = np.asarray(views.canny_figure(steps, 60, 160).axes[2].images[0].get_array())
    colours = {tuple(colour) for colour in shown.reshape(-1, 3).tolist()}
    assert (shown[steps.thin > 160] == 1).all() and not shown[steps.thin == 0].any()
    assert len(colours) == 3 and to_rgb("#56B4E9") in colours  # a step of 20 levels is weak


@pytest.mark.parametrize("x", [3.0, 150.0, 316.0])
@pytest.mark.parametrize("y", [4.0, 230.0])
def test_labels_of_balls_stay_in_the_picture(x, y):
    rejected = [((100.0, 100.0, 9.0), "not round")]
    found = Balls([Ball(x, y, 20, 0.9)], rejected=rejected)
    figure = views.balls_figure(np.zeros((240, 320, 3), np.uint8), found, "found")
    figure.savefig(io.BytesIO(), format="png")
    (ax,) = figure.axes
    label, frame = ax.texts[0].get_window_extent(), ax.get_window_extent()
    assert frame.x0 <= label.x0 and label.x1 <= frame.x1 and frame.y0 <= label.y0 and label.y1 <= frame.y1
    drawn = [line.get_xydata().mean(axis=0) for line in ax.lines]
    assert any(np.allclose(middle, (100, 100), atol=0.2) for middle in drawn)  # what was rejected is seen too


def test_sheet(bench):
    image, truth = bench
    ball = truth.red_balls[0]
    target = (ball.x, ball.y, ball.radius)
    seen = [(image, [Ball(ball.x + 0.5, ball.y, ball.radius, 0.9)], target), (image, [], target)]
    figure = views.sheet_figure(4 * seen)
    assert [ax.get_title() for ax in figure.axes] == 4 * ["0.50 px off", "missed"]


def test_a_click_learns_the_colour(bench):
    image, truth = bench
    panel = views.ClickColour(image)
    assert panel.colour == RED and len(panel.balls) == 1
    blue = next(ball for ball in truth.balls if ball.colour == "blue")
    height, width = image.shape[:2]
    for half in (0, 1):  # in the picture, and at the same place of the mask
        right, up = (blue.x + 0.5 + half * width) / (2 * width), 1 - (blue.y + 0.5) / height
        panel.image_box._handle_custom_msg({"right": right, "up": up}, [])
        assert np.hypot(panel.balls[0].x - blue.x, panel.balls[0].y - blue.y) < 0.6
    shown = np.asarray(Image.open(io.BytesIO(panel.image_box.value)))
    assert shown.shape[:2] == (height, 2 * width)
    assert (shown[round(blue.y), width + round(blue.x)] == 255).all()
    assert (shown[[0, -1], width:] == 153).all() and (shown[:, -1] == 153).all()  # a frame around the mask


def test_a_refused_click_is_said(bench):
    image = np.full((60, 80, 3), 128, np.uint8)
    panel = views.ClickColour(image)
    panel.click(10, 10)
    assert "grey" in panel.status.value
