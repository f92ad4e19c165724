"""What the sliders of notebook 08 run."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course import loop_views as views
from ir50p_lab.course.functions import folder
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    monkeypatch.setattr(folder, "_at", {})
    my_robot._said.clear()


def turn(PID, kp):
    return simulate(IR50P, PID(kp=kp, ki=100, kd=20), np.array([0.5, 0.3, -0.4]), duration=2)


def test_a_slider_runs_the_twin_only_where_it_is_the_students_run(capsys):
    text = solutions.source("PID")
    check("PID", cell(text, "PID"))
    assert views.quick(turn, 300) is not my_robot.PID
    assert "compiled twin of your class" in capsys.readouterr().out
    add = "grown = self.integral + self.ki * error * self.period"
    trapezoid = text.replace(add, add.replace("error", "(error + self.before) / 2") + "\n        self.before = error")
    trapezoid = trapezoid.replace("self.last = None\n", "self.last = None\n        self.before = np.zeros(3)\n")
    check("PID", cell(trapezoid, "PID"))
    assert "trapezoidal" in capsys.readouterr().out
    assert views.quick(turn, 300) is my_robot.PID
    assert "runs your class in Python" in capsys.readouterr().out
