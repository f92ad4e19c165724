"""What the fast drawing shows is what matplotlib draws from nothing, whatever has changed."""

import io

import numpy as np
import pytest
from matplotlib.patches import Circle
from PIL import Image

from ir50p_lab.course.draw.painter import Painter, encode_png
from ir50p_lab.course.draw.style import new_figure


def full_drawing(figure):
    """What matplotlib draws when nothing moves."""
    moving = [artist for artist in figure.findobj() if artist.get_animated()]
    for artist in moving:
        artist.set_animated(False)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba()).copy()
    for artist in moving:
        artist.set_animated(True)
    return pixels


@pytest.fixture
def figure():
    """A small one: two axes with lines, a patch and words; one in space."""
    made = new_figure(3, 2, cols=2, projection=[None, "3d"])
    plane, space = made.axes
    plane.plot([0, 6], [0, 1], label="model")
    plane.plot([0, 6], [1, 0])
    plane.add_patch(Circle((3, 0), 0.7))
    plane.text(1, 1, "note")
    plane.legend(loc="upper right")
    space.plot([0, 1], [0, 1], [0, 1])
    return made


def turn(axes):
    axes.view_init(elev=70, azim=10)
    axes.stale = True  # matplotlib leaves that out


CHANGES = {
    "data": lambda plane, space: plane.lines[0].set_ydata([1, -1]),
    "title": lambda plane, space: plane.set_title("the finding is 2"),
    "limits": lambda plane, space: plane.set_ylim(-3, 3),
    "new line": lambda plane, space: plane.plot([0, 6], [2, 2]),
    "removed line": lambda plane, space: plane.lines[-1].remove(),
    "hidden line": lambda plane, space: plane.lines[1].set_visible(False),
    "moved patch": lambda plane, space: plane.patches[0].set_center((5, 0)),
    "text": lambda plane, space: plane.texts[0].set_text("other"),
    "legend": lambda plane, space: plane.get_legend().get_texts()[0].set_text("other"),
    "size": lambda plane, space: plane.figure.set_size_inches(4, 2),
    "data in space": lambda plane, space: space.lines[0].set_data_3d([0, 1], [1, 0], [0, 1]),
    "view": lambda plane, space: turn(space),
}


@pytest.mark.parametrize("grid_below", [True, "line", False])
def test_every_change_is_shown(figure, grid_below):
    figure.axes[0].set_axisbelow(grid_below)
    painter = Painter(figure)
    for name, change in CHANGES.items():
        before = painter.rgba().copy()
        change(*figure.axes)
        after = painter.rgba()
        assert before.shape != after.shape or (before != after).any(), name
        np.testing.assert_array_equal(after, full_drawing(figure), err_msg=name)


def test_what_stands_still_is_not_drawn_again(figure):
    painter = Painter(figure)
    plane, _ = figure.axes
    backgrounds = []
    for k in range(6):
        plane.lines[0].set_ydata([k, 0])
        painter.rgba()
        backgrounds.append(painter.backgrounds)
    assert backgrounds[-1] == backgrounds[2]
    plane.set_ylim(-3, 3)
    painter.rgba()
    assert painter.backgrounds > backgrounds[-1]


def test_png_holds_the_pixels():
    rgb = np.random.default_rng(5).integers(0, 256, (64, 300, 3), dtype=np.uint8)
    with Image.open(io.BytesIO(encode_png(rgb))) as image:
        assert image.format == "PNG"
        np.testing.assert_array_equal(np.asarray(image), rgb)
