"""Notebook 06: what check says of steps, runs and ways; its views."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import my_robot
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.live_arm.badge import badge_of
from ir50p_lab.course.motion import trajectory_views as views
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.source import Source
from ir50p_lab.modelling import IR50P, mass_matrix


@pytest.mark.parametrize("name", ["rk4_step", "integrate"])
def test_the_small_test_of_a_function_of_functions_runs(name, tmp_path):
    """What is written beside the student's function is Python, and holds."""
    calls = ("rk4_step",) if name == "integrate" else ()
    student_package.keep(Source(name, solutions.source(name), calls), task(name), task)
    text = (tmp_path / "my_robot" / f"test_{name}.py").read_text(encoding="utf-8")
    names = {name: student_package.load(name)}
    exec(text, names)  # student_package.load has made `my_robot` a module
    names[f"test_{name}"]()


def test_the_last_honey_is_too_thick_for_the_step():
    """A step of 10 ms multiplies the fastest speed by more than 1 in the last, by less in the others."""
    M = mass_matrix(IR50P, [0, 0.8, -0.8])
    z = 0.01 * views.honey(M) * np.max(np.linalg.eigvals(np.linalg.solve(M, np.eye(3))).real)
    growth = 1 - z + z**2 / 2 - z**3 / 6 + z**4 / 24
    assert (growth[:3] < 1).all() and growth[3] > 1


def test_a_badge_follows_what_a_function_calls_beside_my_robot():
    """A function that uses my_robot and another that is not written: the weaker of both is said."""
    text = "def unwritten(q):\n    ...\n\n\ndef moves(q):\n    return my_robot.rot_z(unwritten(q))\n"
    assert badge_of(cell(text, "moves", {"my_robot": my_robot})) == "not written yet"


def test_figures_name_their_axes():
    t, q = np.linspace(0, 1, 5), np.zeros((5, 3))
    orders = views.orders(np.array([0.02, 0.01]), {"A": [2.0, 1.0]})
    for figure in (views.one_step(), orders):
        assert all("[" in ax.get_xlabel() and "[" in ax.get_ylabel() for ax in figure.axes)
    assert orders.axes[0].get_legend_handles_labels()[1] == ["A: slope 1.00"]
    assert views.motion(t, np.hstack([q, q]), 4).q.shape == (4, 3)
