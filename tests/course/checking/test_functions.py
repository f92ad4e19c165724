"""What students write: right answers are kept and used, wrong ones told apart, nothing is lost."""

import subprocess
import sys

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab import modelling
from ir50p_lab.course import check, lab_book, my_robot, reset
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.modelling import IR50P


def said(capsys):
    return capsys.readouterr().out


def give(name, text, notebook=()):
    check(name, cell(text, name, notebook))


def test_reference_solutions_pass_become_the_robot_and_stand_alone(home, capsys):
    for name in ORDER:
        give(name, solutions.source(name))
        assert "right, and yours" in said(capsys), name
        assert my_robot.whose(name) == "yours"
    place = my_robot.forward_kinematics([0.1, 0.2, 0.3], [0.285, 0.2, 0.372])
    np.testing.assert_allclose(place, solutions.load().forward_kinematics([0.1, 0.2, 0.3], [0.285, 0.2, 0.372]))
    code = "import sys; import my_robot; my_robot.frames([0, 0, 0], [1, 1, 1]); assert 'ir50p_lab' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], cwd=home, check=True)
    subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "my_robot"], cwd=home, check=True)


def test_poses_and_tip_that_stand_in_are_the_packages():
    l, q = np.array(IR50P.l), np.random.default_rng(0).uniform(-1.5, 1.5, (50, 3))
    tips = modelling.forward_kinematics(IR50P, q)
    np.testing.assert_allclose([task("forward_kinematics").reference(one, l) for one in q], tips, atol=1e-12)
    poses = [task("inverse_kinematics").reference(p, l) for p in tips]
    np.testing.assert_allclose(np.exp(1j * np.array(poses)), np.exp(1j * modelling.inverse_kinematics(IR50P, tips).q))


@pytest.mark.parametrize("name", ORDER)
def test_the_loan_is_right_too(name):
    names = {"np": np, **{one: task(one).reference for one in ORDER}}
    exec(task(name).solution_text, names)
    assert grade(task(name), names[name]).state == "right"


@pytest.mark.parametrize("name", ORDER)
def test_every_mistake_gets_its_own_sentence(name):
    one = task(name)
    for mistake in one.mistakes:
        verdict = grade(one, mistake.function)
        assert verdict.says == mistake.says
        assert verdict.state == "wrong"


def test_a_function_that_fails_says_how_and_for_what(capsys):
    give("rot_z", "def rot_z(angle):\n    return np.array([[1, 0], [0, 1 / 0]])")
    assert "ZeroDivisionError" in said(capsys)
    give("rot_z", "def rot_z(angle):\n    c = np.cos(angle)")
    assert "is there a `return`" in said(capsys)
    give("rot_z", "def rot_z():\n    return np.eye(3)")
    assert "will be called with (angle)" in said(capsys)
    give(
        "rot_z",
        "def rot_z(angle):\n    c, s = np.cos(angle), np.sin(angle)\n    return [[c, -s, 0], [s, c, 0], [0, 0, 1]]",
    )
    assert "returns a list" in said(capsys)
    give("forward_kinematics", "def forward_kinematics(q, l):\n    q *= 2\n    return q")
    assert "changes what it was given" in said(capsys)


def test_the_stub_is_not_written_yet(capsys):
    give("rot_z", "def rot_z(angle):\n    ...\n    return np.eye(3)")
    assert "not written yet" in said(capsys)


def test_what_stands_in_the_cell_comes_along_and_nothing_else(capsys):
    text = (
        "import numpy as np\nTURN = 1.0\n\n\ndef c(a):\n    'No __init__ here.'\n    return np.cos(TURN * a)\n\n\ndef rot_z(angle):\n"
        "    s = np.sin(angle)\n    return np.array([[c(angle), -s, 0], [s, c(angle), 0], [0, 0, 1]])\n\n\nprint('hello')\n"
    )
    give("rot_z", text)
    kept = student_package.path_of("rot_z").read_text()
    assert "TURN = 1.0" in kept and "def c(a)" in kept and "hello" not in kept
    assert kept.count("import numpy") == 1


@pytest.mark.parametrize(
    ("text", "notebook", "words"),
    [
        ("def rot_z(angle):\n    return turn", {"turn": np.eye(3)}, "a variable of the notebook"),
        ("def rot_z(angle):\n    return turner(angle)", {}, "defined nowhere"),
        ("def rot_z(angle):\n    return cos(angle)", {"cos": np.cos}, "write `np.cos`"),
        ("def rot_z(angle):\n    from ir50p_lab.modelling import rot_z\n    return rot_z(angle)", {}, "NumPy alone"),
        ("from scipy.spatial.transform import Rotation\n\n\ndef rot_z(angle):\n    return Rotation", {}, "NumPy alone"),
        ("def rot_z(angle):\n    return np.lib._npyio_impl.sys", {}, "it uses `"),
        ("from dataclasses import sys\n\n\ndef rot_z(angle):\n    return sys", {}, "it uses `sys`"),
        (
            "import operator\n\n\ndef rot_z(angle):\n    return operator.attrgetter('__dict__')(np)",
            {},
            "it uses `attrgetter`",
        ),
        ("def rot_z(angle):\n    return '{0.__dict__}'.format(np)", {}, "a text in it holds `__`"),
        (
            "class A:\n    def m(self):\n        return self.m.__globals__\n\n\ndef rot_z(angle):\n    return A().m()",
            {},
            "`self.m.__globals__`",
        ),
    ],
)
def test_strangers_are_refused_with_a_sentence(text, notebook, words, capsys):
    give("rot_z", text, notebook)
    assert words in said(capsys)
    assert my_robot.whose("rot_z") == "the course's"


def test_after_three_failures_lines_after_six_a_loan(capsys):
    for k in range(6):
        give("rot_z", f"def rot_z(angle):\n    return {k} * np.eye(3)")
        give("rot_z", f"def rot_z(angle):\n    return {k} * np.eye(3)  # the same again")
        out = said(capsys)
        assert ("lends you" in out) == (k == 5)
    tries = lab_book.read()["attempts"]["rot_z"].values()
    assert len(tries) == 6 and list(tries)[-1] in out
    assert my_robot.whose("rot_z") == "on loan"
    give("rot_z", solutions.source("rot_z"))
    assert my_robot.whose("rot_z") == "yours"
    assert list((student_package.folder() / "old").glob("rot_z_*.py"))


def test_what_it_calls_comes_along_on_loan(capsys):
    give("forward_kinematics", solutions.source("forward_kinematics"))
    assert "on loan" in said(capsys)
    assert my_robot.whose("frames") == my_robot.whose("dh_matrix") == "on loan"
    assert my_robot.whose("forward_kinematics") == "yours"


def test_a_changed_file_is_read_again_and_a_reset_keeps_a_copy(capsys):
    give("rot_z", solutions.source("rot_z"))
    student_package.path_of("rot_z").write_text("def rot_z(angle):\n    return 'mine'\n")
    assert my_robot.rot_z(1) == "mine"
    reset("rot_z")
    assert my_robot.whose("rot_z") == "the course's"
    np.testing.assert_allclose(my_robot.rot_z(0), np.eye(3))
    assert any("mine" in old.read_text() for old in (student_package.folder() / "old").glob("*.py"))


def test_my_robot_may_be_named_in_a_cell(capsys):
    give("rot_z", solutions.source("rot_z"))
    give("dh_matrix", solutions.source("dh_matrix").replace("= rot_z(", "= my_robot.rot_z("), {"my_robot": my_robot})
    assert my_robot.whose("dh_matrix") == "yours"


def test_a_damaged_lab_book_stops_no_check(capsys):
    lab_book.path().parent.mkdir()
    lab_book.path().write_text("{")
    give("rot_z", "def rot_z(angle):\n    return np.eye(3)")
    out = said(capsys)
    assert "not yet: angle does nothing" in out and "rename it" in out
