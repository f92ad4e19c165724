"""Figures of notebook 06: the note in the corner, curves and levels of Traces, turning points."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from ir50p_lab.course.simulation_views import (
    STAMP,
    Row,
    Traces,
    chatter_figure,
    friction_figure,
    order_figure,
    sinking_figure,
    turning_points,
)
from ir50p_lab.course.style import COLOURS
from ir50p_lab.modelling import IR50P, Friction, forward_kinematics
from ir50p_lab.simulation import simulate

T = np.linspace(0, 1, 11)
RUN = np.column_stack([np.full(5, 0.4), np.linspace(1.2, -0.8, 5), np.linspace(-0.5, 0.4, 5)])
FIGURES = {
    "traces": lambda: Traces("t [s]", (0, 1), Row("q [rad]", (0, 1))).figure,
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


def test_traces_take_their_curves_in_order():
    view = Traces("t [s]", (0, 1), Row("q [rad]", (0, 2), ("a", "b")), Row("u [N m]", (-1, 1), style="o-"), title="one")
    view.update(T, T, 2 * T, -T)
    assert [line.get_ydata()[-1] for line in view.lines] == [1, 2, -1]
    assert [ax.get_ylim() for ax in view.axes] == [(0, 2), (-1, 1)]
    assert [text.get_text() for text in view.axes[0].get_legend().get_texts()] == ["a", "b"]
    assert view.axes[1].get_legend() is None and view.axes[1].get_xlabel().startswith("t [s]")
    view.title("two")
    assert view.axes[0].get_title() == "two"
    with pytest.raises(ValueError, match="argument"):
        view.update(T, T)


def test_levels_take_the_colours_of_their_curves():
    view = Traces("t [s]", (0, 1), Row("q [rad]", (0, 2), ("a", "b"), levels=(0.5, 1.5)))
    assert [to_hex(line.get_color()) for line in view.axes[0].lines[2:]] == [
        line.get_color().lower() for line in view.lines
    ]
    single = Traces("t [s]", (0, 1), Row("q [rad]", (0, 2), levels=(0.5,)))
    assert single.axes[0].lines[1].get_color() == COLOURS["dark"]


def test_a_law_is_not_called_a_simulation():
    view = Traces("q2 [deg]", (0, 1), Row("torque [N m]", (0, 2), ("a", "b"), legend="lower left"), note="")
    assert view.axes[0].get_xlabel() == "q2 [deg]"
    assert view.axes[0].get_legend()._loc == 3  # matplotlib's number of "lower left"


def test_order_is_the_slope():
    h = np.array([0.1, 0.05, 0.025])
    _, slopes = order_figure(h, {"first": 3 * h, "fourth": 7 * h**4})
    assert slopes == pytest.approx({"first": 1, "fourth": 4})


def test_sinking_figure_says_where_it_ends():
    on_table = np.array([[0.5, 0, 0.6], [0.5, 0, 0.0]])
    assert "on the table" in sinking_figure(IR50P, RUN, on_table).axes[0].get_title()
    assert "12.3 cm" in sinking_figure(IR50P, RUN, on_table + np.array([0, 0, 0.123])).axes[0].get_title()


def test_turning_points_of_a_decaying_swing():
    t = np.linspace(0, 10, 100001)
    angle = np.exp(-0.1 * t) * np.cos(2 * t)
    found = turning_points(angle, np.gradient(angle, t))
    expected = np.abs(np.exp(-0.1 * t) * np.cos(2 * t))[1:-1][np.diff(np.sign(np.diff(angle))) != 0]
    np.testing.assert_allclose(found, expected, atol=1e-6)
    # a swing that stops: coming to rest is the last one
    assert turning_points(np.array([0.3, 0.2, 0.1, 0.1]), np.array([0.0, -1.0, 0.0, 0.0])).tolist() == [0.1]
