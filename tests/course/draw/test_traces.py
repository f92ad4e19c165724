"""Curves over time: in their order, with their levels, and saying where they are from."""

import numpy as np
import pytest

from ir50p_lab.course.draw.traces import STAMP, Row, Traces

T = np.linspace(0, 1, 11)


def test_traces_say_that_they_are_simulated():
    view = Traces("t [s]", (0, 1), Row("q [rad]", (0, 1)))
    view.figure.canvas.draw()
    note = view.axes[-1].xaxis.label
    assert STAMP in note.get_text() and note.get_window_extent().y0 >= 0


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
