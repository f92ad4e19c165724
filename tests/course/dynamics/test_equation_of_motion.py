"""Notebook 05: its two functions against the course's equation, wrong ones told apart, its pictures."""

import re

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.dynamics import lump_view
from ir50p_lab.course.dynamics.functions.velocity_torque import made_up_mass
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.robot.catalogue import task
from ir50p_lab.course.robot.parts import parts
from ir50p_lab.modelling import IR50P, Arm, coriolis_matrix, gravity, mass_matrix

OTHER = Arm.load("data/arm_example.toml")
ARMS = pytest.mark.parametrize("arm", [IR50P, OTHER], ids=lambda arm: arm.name)


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    my_robot._said.clear()
    return tmp_path


def states(count=30):
    return np.random.default_rng(55).uniform(-2, 2, (count, 2, 3))


@ARMS
def test_what_stands_in_is_the_courses_equation(arm):
    numbers = parts(arm)
    for q, qd in states():
        held = task("gravity_torque").right(q, numbers.l, numbers.m, numbers.lc, numbers.g)
        np.testing.assert_allclose(held, gravity(arm, q), atol=1e-9)
        asked = task("velocity_torque").right(q, qd, lambda q: mass_matrix(arm, q))
        np.testing.assert_allclose(asked, coriolis_matrix(arm, q, qd) @ qd, atol=1e-8)


def test_the_made_up_mass_is_that_of_some_arm():
    """It depends on all three angles, is symmetric and positive, and gentle: a step of one degree is as good as a small one."""
    for q, _ in states():
        M = made_up_mass(q)
        assert np.array_equal(M, M.T) and np.linalg.eigvalsh(M)[0] > 0.05
    slope = made_up_mass(np.array([0.1, 0.2, 0.3])) - made_up_mass(np.array([0.2, 0.2, 0.3]))
    assert np.abs(slope).max() > 0.005


STEP = "h = 1e-5"
FORCE = "m[i] * g * jacobian(T, i + 1, centre)[2]"
RATE = "change @ qd - pull / 2"


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("gravity_torque", "(T, i + 1, centre)[2]", "(T, i + 1, centre)[:3, 2]", "how fast the point rises"),
        ("gravity_torque", "(T, i + 1, centre)[2]", "(T, i + 1, centre)[5]", "a row of turning"),
        ("gravity_torque", "T[i][:3, 3] + lc", "T[i + 1][:3, 3] + lc", "from the far end of"),
        ("gravity_torque", "T[i][:3, 3] + lc", "T[i + 1][:3, 3] - lc", "back from the far end"),
        ("gravity_torque", "T, i + 1", "T, 3", "does the elbow carry the upper arm"),
        ("gravity_torque", "T[2][:3, 0], T[3]", "T[1][:3, 0], T[2]", "which frame turns with the link"),
        ("gravity_torque", "frames(q, l)", "frames(q, l * np.array([1, 0, 1]))", "at the end of the upper arm"),
        ("gravity_torque", FORCE, FORCE.replace("m[i]", "sum(m)"), "as much as the whole arm"),
        ("gravity_torque", "torque + m", "m", "only the forearm counts"),
        ("gravity_torque", "m[i] * g", "m[i] * 9.81", "g = .* is built in"),
        ("velocity_torque", "pull / 2", "pull", "the energy does not come out"),
        ("velocity_torque", " - pull / 2", "", "nothing is thrown outwards"),
        ("velocity_torque", RATE, "change @ qd / 2", "balances the energy, and is not the torque"),
        ("velocity_torque", RATE, "-pull / 2", "think of the skater"),
        ("velocity_torque", "step[joint] = h", "step[:] = h", "joint by joint"),
        ("velocity_torque", "step = np.zeros(3)", "step = h * (np.arange(3) < joint)", "pile up"),
        ("velocity_torque", "qd @ slope[joint] @ qd", "np.sum(qd * slope[joint] * qd)", "only squares"),
        ("velocity_torque", STEP, "h = 0.1", "a small step in it too wide, or too small"),
        ("velocity_torque", STEP, "h = 1e-13", "a small step in it too wide, or too small"),
        ("velocity_torque", " / (2 * h)", "", "next to nothing for every input"),
        ("velocity_torque", "qd @ slope[joint] @ qd", "abs(qd @ slope[joint] @ qd)", "the motion gains"),
    ],
)
def test_a_wrong_one_is_named(capsys, name, old, new, words):
    text = solutions.source(name)
    assert old in text
    check(name, cell(text.replace(old, new), name))
    assert re.search(words, capsys.readouterr().out)


@pytest.mark.parametrize("name", ["gravity_torque", "velocity_torque"])
def test_other_routes_are_right(name):
    for route in task(name).routes:
        names = {"np": np, "frames": frames, "jacobian": task("jacobian").right}
        exec(route, names)
        assert grade(task(name), names[name]).state == "right", route


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
