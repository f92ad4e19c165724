"""Curves over time: in their order, with their levels, and saying where they are from."""

import numpy as np
import pytest

from ir50p_lab.controllers import PID
from ir50p_lab.course.draw.traces import STAMP, JointPlots, Row, Traces
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

T = np.linspace(0, 1, 11)
TARGET = np.array([0.8, 0.5, -0.7])


@pytest.fixture(scope="module")
def run():
    return simulate(IR50P, PID((289, 225, 270), kd=(40, 30, 30), limit_pwm=255), TARGET, duration=2)


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


def test_joint_plots_show_the_run(run):
    view = JointPlots(TARGET, duration=2, unit="PWM", u_max=255)
    assert view.update(run) is view.figure
    for joint in range(3):
        angle, command = view.figure.axes[joint], view.figure.axes[3 + joint]
        assert any(np.array_equal(line.get_ydata(), run.q[:, joint]) for line in angle.lines)
        assert any(np.array_equal(line.get_ydata(), run.u[:, joint]) for line in command.lines)
        assert angle.get_ylim()[0] < min(0, TARGET[joint]) and angle.get_ylim()[1] > max(0, TARGET[joint])
        assert angle.get_title() == f"joint {joint + 1}"
    assert "[PWM]" in view.figure.axes[3].get_ylabel()
