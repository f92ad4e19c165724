"""Notebook 05: its two functions against the course's equation, wrong ones told apart, its pictures."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.dynamics import lump_view
from ir50p_lab.course.dynamics.functions.velocity_torque import made_up_mass
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.modelling import IR50P, Arm, coriolis_matrix, gravity, mass_matrix

OTHER = Arm.load("data/arm_example.toml")
ARMS = pytest.mark.parametrize("arm", [IR50P, OTHER], ids=lambda arm: arm.name)


def states(count=30):
    return np.random.default_rng(55).uniform(-2, 2, (count, 2, 3))


@ARMS
def test_what_stands_in_is_the_courses_equation(arm):
    numbers = parts(arm)
    for q, qd in states():
        held = task("gravity_torque").reference(q, numbers.l, numbers.m, numbers.lc, numbers.g)
        np.testing.assert_allclose(held, gravity(arm, q), atol=1e-9)
        asked = task("velocity_torque").reference(q, qd, lambda q: mass_matrix(arm, q))
        np.testing.assert_allclose(asked, coriolis_matrix(arm, q, qd) @ qd, atol=1e-8)


def test_the_made_up_mass_is_that_of_some_arm():
    """It depends on all three angles, is symmetric and positive, and gentle: a step of one degree is as good as a small one."""
    for q, _ in states():
        M = made_up_mass(q)
        assert np.array_equal(M, M.T) and np.linalg.eigvalsh(M)[0] > 0.05
    slope = made_up_mass(np.array([0.1, 0.2, 0.3])) - made_up_mass(np.array([0.2, 0.2, 0.3]))
    assert np.abs(slope).max() > 0.005


@pytest.mark.parametrize("step", ["np.radians(1)", "1e-8"])
def test_any_sensible_step_is_right(capsys, step):
    check("velocity_torque", cell(solutions.source("velocity_torque").replace("1e-5", step), "velocity_torque"))
    assert "right, and yours" in capsys.readouterr().out


@ARMS
def test_the_lump_is_drawn_where_it_is(arm):
    q = np.array([0.0, 0.6, -1.2])
    (ax,) = lump_view.on_a_circle(arm, q).axes
    force, lever, lump = (line.get_xydata() for line in ax.lines[-3:])
    T = frames(q, np.array(arm.l))
    centre = T[2][:3, 3] + arm.lc[2] * T[3][:3, 0]
    np.testing.assert_allclose([lump[0], force[0]], [centre[[0, 2]]] * 2, atol=1e-9)
    length = np.linalg.norm(lever[1] - lever[0])
    assert length == pytest.approx(arm.l[1] * np.sin(1.2)) and (lever[1] - lever[0]) @ (force[1] - force[0]) < 1e-9
