"""The panel of notebook 16 learns what is clicked, and every rendered picture says that it is."""

import io

import numpy as np
import pytest
from PIL import Image

from ir50p_lab.course.draw.pictures import STAMP, pictures_figure
from ir50p_lab.course.images import views
from ir50p_lab.vision import RED, render_scene, to_grey
from ir50p_lab.vision.rendering import SceneBall, bench_scene


@pytest.fixture(scope="module")
def bench():
    blue = SceneBall(position=(0.35, -0.12, 0.03), colour="blue")
    return render_scene(bench_scene(SceneBall(), blue), seed=1)


def texts(figure):
    return " ".join(t.get_text() for t in figure.findobj(match=lambda a: hasattr(a, "get_text")))


def test_every_picture_says_that_it_is_rendered(bench):
    assert STAMP in texts(pictures_figure(("a", bench[0]), ("b", to_grey(bench[0]))))
    assert "photograph" not in texts(pictures_figure(("mine", bench[0]), source="my_pictures/a.jpg"))
    assert STAMP in views.ClickColour(bench[0]).status.value


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
