"""Clicks on a picture: coordinates, sliders that follow, errors in the status line."""

import pytest

from ir50p_lab.course.draw.clickable import click_sets
from ir50p_lab.course.draw.style import new_figure
from ir50p_lab.course.draw.widgets import live, slider


@pytest.fixture
def panel():
    figure = new_figure(6, 3, cols=2)
    left = figure.axes[0]
    left.set(xlim=(0, 100), ylim=(1, 1000), yscale="log", xlabel="kp [1]", ylabel="kd [1]")
    (mark,) = left.plot([0], [1], "o")

    def update(kp, kd):
        if kp == 77:
            raise ValueError("no seventy-seven")
        mark.set_data([kp], [kd])

    made = live(figure, update, kp=(0, 100, 1, 10), kd=slider(1.0, 500.0, 0.5, 20.0))
    return click_sets(made, left, x="kp", y="kd")


def click_at(panel, right, up):
    """What the browser sends for a click at a place of the picture, fractions from its lower left."""
    panel.image._handle_custom_msg({"right": right, "up": up}, [])


def click(panel, x, y, axes=None):
    """What the browser sends for a click at data coordinates x, y."""
    axes = axes or panel.figure.axes[0]
    pixel = axes.transData.transform((x, y)) / panel.figure.bbox.size
    click_at(panel, *pixel.tolist())


def test_a_click_moves_both_sliders_and_redraws(panel):
    before = panel.image.value
    click(panel, 42.3, 100.2)
    assert panel.values == {"kp": 42, "kd": 100.0} and panel.drawn == panel.values
    assert isinstance(panel.values["kp"], int)
    assert panel.controls["kd"].box.value == 100.0
    assert panel.image.value != before and panel.image.value.startswith(b"\x89PNG")
    click(panel, 42.3, 100.2)  # the same place again is a click as well
    assert panel.values == {"kp": 42, "kd": 100.0}


def test_clicks_beside_the_axes_do_nothing(panel):
    updates = panel.updates
    click(panel, -5, 10)
    click(panel, 0.5, 0.5, axes=panel.figure.axes[1])
    assert panel.updates == updates


def test_errors_appear_in_the_status_line(panel):
    click(panel, 77, 10)
    assert "no seventy-seven" in panel.status.value
    click(panel, 50, 10)
    assert panel.status.value == "" and panel.values["kp"] == 50
    click_at(panel, float("nan"), 0.5)  # nothing a browser sends; it must not raise either
    assert panel.values["kp"] == 50


def test_the_corners_of_the_axes(panel):
    axes = panel.figure.axes[0]
    box = axes.get_position()
    click_at(panel, box.x0 + 1e-9, box.y0 + 1e-9)
    assert panel.values == {"kp": 0, "kd": 1.0}
    click_at(panel, box.x1 - 1e-9, (box.y0 + box.y1) / 2)
    assert panel.values == {"kp": 100, "kd": 31.5}  # the middle of 1 to 1000, logarithmic: 31.6
    updates = panel.updates
    click_at(panel, 0.999, 0.5)
    assert panel.updates == updates
