"""The fast drawing must equal matplotlib's own, pixel by pixel, whatever changed since the last one."""

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


def assert_same_pixels(painter):
    fast = painter.rgba().copy()
    reference = full_drawing(painter.figure)
    assert fast.shape == reference.shape
    difference = np.abs(fast.astype(int) - reference)
    assert difference.max() == 0, f"{(difference.max(axis=-1) > 0).sum()} pixels differ"


def plane_figure():
    figure = new_figure(4, 3.5, rows=3, sharex=True)
    x = np.linspace(0, 6, 200)
    for k, ax in enumerate(figure.axes):
        ax.plot(x, np.sin(x + k), label="model")
        ax.plot(x[::9], np.cos(x[::9] + k), "o", ms=3, label="measured")
        ax.set(ylim=(-2, 2), ylabel="q [rad]")
    above, below, last = figure.axes
    above.legend(loc="upper right")
    above.set_title("first")
    below.add_patch(Circle((3, 0), 0.7, alpha=0.5))
    below.scatter(x[::20], np.sin(x[::20]))
    last.text(1, 1, "note")
    below.set_xlabel("time [s]")
    return figure


def space_figure():
    figure = new_figure(6, 3, cols=2, projection=["3d", None])
    rng = np.random.default_rng(1)
    ax = figure.axes[0]
    ax.plot(*rng.normal(size=(3, 5)), lw=4)
    ax.scatter(*rng.normal(size=(3, 9)))
    ax.text(0, 0, 0, "origin")
    ax.set_title("0.000")
    ax.set(xlim=(-2, 2), ylim=(-2, 2), zlim=(-2, 2), xlabel="x [m]", zlabel="z [m]")
    figure.axes[1].plot([0, 1], [1, 0])
    return figure


def turn(axes, **angles):
    axes.view_init(**angles)
    axes.stale = True  # matplotlib leaves that out


def toggle(artist):
    artist.set_visible(not artist.get_visible())


IN_THE_PLANE = {
    "data": lambda f, r: f.axes[0].lines[0].set_ydata(r.normal(size=200)),
    "title": lambda f, r: f.axes[0].set_title(f"the finding is {r.normal():.3f}"),
    "limits": lambda f, r: f.axes[1].set_ylim(-3 - r.random(), 3),
    "axis label": lambda f, r: f.axes[1].set_xlabel(f"time {r.random():.2f} [s]"),
    "new line": lambda f, r: f.axes[1].plot([0, 6], r.normal(size=2)),
    "removed line": lambda f, r: f.axes[1].lines[-1].remove(),
    "moved patch": lambda f, r: f.axes[1].patches[0].set_center((6 * r.random(), 0)),
    "hidden line": lambda f, r: toggle(f.axes[0].lines[1]),
    "text": lambda f, r: f.axes[2].texts[0].set_text(f"{r.random():.3f}"),
    "legend text": lambda f, r: f.axes[0].get_legend().get_texts()[0].set_text(f"m {r.random():.2f}"),
    "figure text": lambda f, r: f.text(0.5, 0.5, f"{r.random():.2f}"),
    "grid in front": lambda f, r: f.axes[2].set_axisbelow(False),
    "axes hidden": lambda f, r: toggle(f.axes[2]),
    "size": lambda f, r: f.set_size_inches(5 + r.random(), 3.5),
}
IN_SPACE = {
    "data": lambda f, r: f.axes[0].lines[0].set_data_3d(*r.normal(size=(3, 5))),
    "view": lambda f, r: turn(f.axes[0], elev=90 * r.random(), azim=360 * r.random()),
    "limits": lambda f, r: f.axes[0].set_zlim(-2 - r.random(), 2),
    "title": lambda f, r: f.axes[0].set_title(f"{r.normal():.3f}"),
}


@pytest.mark.parametrize(
    ("make", "change"),
    [pytest.param(plane_figure, c, id=f"2d {n}") for n, c in IN_THE_PLANE.items()]
    + [pytest.param(space_figure, c, id=f"3d {n}") for n, c in IN_SPACE.items()],
)
def test_fast_drawing_equals_a_full_one_after_each_kind_of_change(make, change):
    painter = Painter(make())
    rng = np.random.default_rng(2)
    before = painter.rgba().copy()
    change(painter.figure, rng)
    after = painter.rgba()
    assert before.shape != after.shape or (before != after).any(), "the change shows"
    assert_same_pixels(painter)


def test_background_is_kept_while_only_what_has_moved_before_moves_again():
    painter = Painter(plane_figure())
    moving = ("data", "title", "text", "moved patch")
    for name in 2 * moving:
        IN_THE_PLANE[name](painter.figure, np.random.default_rng(4))
        painter.rgba()
    before = painter.backgrounds
    for name in moving:
        IN_THE_PLANE[name](painter.figure, np.random.default_rng(5))
        painter.rgba()
    assert painter.backgrounds == before
    IN_THE_PLANE["limits"](painter.figure, np.random.default_rng(4))
    painter.rgba()
    painter.rgba()
    assert painter.backgrounds == before + 1


@pytest.mark.parametrize("below", [False, "line"])
def test_what_moves_under_a_grid_stays_under_it(below):
    figure = plane_figure()
    middle = figure.axes[1]
    middle.set_axisbelow(below)
    painter = Painter(figure)
    rng = np.random.default_rng(6)
    for name in ("moved patch", "data", "limits", "moved patch"):
        IN_THE_PLANE[name](figure, rng)
        middle.lines[0].set_ydata(rng.normal(size=200))
        assert_same_pixels(painter)
    middle.set_axisbelow(True)
    for _ in range(3):
        IN_THE_PLANE["moved patch"](figure, rng)
        assert_same_pixels(painter)
    middle.set_axisbelow(below)  # what moved already goes under it again
    for _ in range(2):
        IN_THE_PLANE["moved patch"](figure, rng)
        assert_same_pixels(painter)


@pytest.mark.parametrize("shape", [(1, 1, 3), (7, 5, 3), (64, 300, 3)])
def test_png_holds_the_pixels(shape):
    rgb = np.random.default_rng(5).integers(0, 256, shape, dtype=np.uint8)
    image = Image.open(io.BytesIO(encode_png(rgb)))
    image.load()
    assert image.format == "PNG"
    np.testing.assert_array_equal(np.asarray(image), rgb)
