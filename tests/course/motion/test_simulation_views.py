"""Figures of notebook 06: the note in the corner, turning points."""

import numpy as np
import pytest

from ir50p_lab.course.draw.traces import STAMP
from ir50p_lab.course.motion.views import (
    chatter_figure,
    friction_figure,
    order_figure,
    sinking_figure,
    turning_points,
)
from ir50p_lab.modelling import IR50P, Friction, forward_kinematics
from ir50p_lab.simulation import simulate

RUN = np.column_stack([np.full(5, 0.4), np.linspace(1.2, -0.8, 5), np.linspace(-0.5, 0.4, 5)])
FIGURES = {
    "order": lambda: order_figure([0.1, 0.2], {"A": [1e-3, 2e-3]})[0],
    "friction": lambda: friction_figure(Friction(fc=(0.5, 0, 0), fs=(0.9, 0, 0)), [0.5, 1.0], [0.5, 1.0]),
    "sinking": lambda: sinking_figure(IR50P, RUN, forward_kinematics(IR50P, RUN)),
    "chatter": lambda: chatter_figure(np.ones((11, 6)), simulate(IR50P, q0=RUN[0], duration=0.05)),
}


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_says_that_it_is_simulated_inside_its_frame(name):
    figure = FIGURES[name]()
    figure.canvas.draw()
    (note,) = [text for text in (*figure.texts, *(ax.xaxis.label for ax in figure.axes)) if STAMP in text.get_text()]
    box, page = note.get_window_extent(), figure.bbox
    assert box.x0 > 0 and box.y0 >= 0 and box.x1 <= page.width and box.y1 < page.height
    for ax in figure.axes:
        assert "[" in ax.get_ylabel() or name == "plain"
        assert ax.xaxis.label is note or not box.overlaps(ax.xaxis.label.get_window_extent())


def test_order_is_the_slope():
    h = np.array([0.1, 0.05, 0.025])
    _, slopes = order_figure(h, {"first": 3 * h, "fourth": 7 * h**4})
    assert slopes == pytest.approx({"first": 1, "fourth": 4})


def test_turning_points_of_a_decaying_swing():
    t = np.linspace(0, 10, 100001)
    angle = np.exp(-0.1 * t) * np.cos(2 * t)
    found = turning_points(angle, np.gradient(angle, t))
    expected = np.abs(np.exp(-0.1 * t) * np.cos(2 * t))[1:-1][np.diff(np.sign(np.diff(angle))) != 0]
    np.testing.assert_allclose(found, expected, atol=1e-6)
    # a swing that stops: coming to rest is the last one
    assert turning_points(np.array([0.3, 0.2, 0.1, 0.1]), np.array([0.0, -1.0, 0.0, 0.0])).tolist() == [0.1]
