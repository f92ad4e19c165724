"""What a Task can ask for: several results, a function as argument, other right answers; and what the files hold then."""

import time

import numpy as np
import pytest
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course.checking.cell import extract
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.task import Failed, Task, text_of
from ir50p_lab.course.robot import student_package


def fit_line(x, y):
    A = np.column_stack([x, np.ones_like(x)])
    inverse = np.linalg.inv(A.T @ A)
    slope, offset = inverse @ A.T @ y
    rest = y - slope * x - offset
    scatter = np.sqrt(rest @ rest / (len(x) - 2))
    return slope, offset, scatter**2 * inverse, scatter


def lines():
    rng = np.random.default_rng(1)
    places = [np.sort(rng.uniform(0, 5, n)) for n in (5, 8, 20, 3)]
    return [(x, 2 * x - 1 + rng.normal(0, 0.3, len(x))) for x in places]


FIT_LINE = Task(
    name="fit_line",
    returns="slope, offset, covariance (2, 2) and scatter",
    reference=fit_line,
    solution_text=text_of(fit_line),
    cases=lines,
    results=("slope", "offset", "covariance", "scatter"),
)


def integrate(f, x0, duration, dt):
    count = round(duration / dt)
    t = np.linspace(0, duration, count + 1)
    x = np.empty((count + 1, len(x0)))
    x[0] = x0
    for k in range(count):
        half = x[k] + dt / 2 * f(t[k], x[k])
        x[k + 1] = x[k] + dt * f(t[k] + dt / 2, half)
    return t, x


def swing(t, x):
    return np.array([x[1], -x[0]])


INTEGRATE = Task(
    name="integrate",
    returns="t (k + 1,) and x (k + 1, n)",
    reference=integrate,
    solution_text=text_of(integrate),
    cases=lambda: [(swing, np.array([1.0, 0.5]), 0.3, 0.1), (swing, np.array([0.2, 1.0]), 2.0, 0.2)],
    results=("t", "x"),
)


def says(task, old, new):
    assert old in task.solution_text
    text = task.solution_text.replace(old, new)
    return grade(task, extract(cell(text, task.name), task.name, ())).says


@pytest.mark.parametrize("task", [FIT_LINE, INTEGRATE], ids=lambda task: task.name)
def test_a_right_answer_in_parts_of_unlike_shape_passes(task):
    assert grade(task, task.reference).state == "right"


@pytest.mark.parametrize(
    ("task", "old", "new", "words"),
    [
        (
            FIT_LINE,
            "scatter**2 * inverse",
            "scatter * inverse",
            "slope, offset and scatter are right; covariance is not",
        ),
        (FIT_LINE, "slope, offset, scatter**2", "offset, slope, scatter**2", "slope and offset have changed places"),
        (
            FIT_LINE,
            ", scatter**2 * inverse, scatter",
            "",
            "4 results are asked for, slope, offset, covariance, scatter",
        ),
        (FIT_LINE, "scatter**2 * inverse, ", "(scatter**2 * inverse).tolist(), ", "returns a list"),
        (FIT_LINE, "scatter**2 * inverse", "np.diag(scatter**2 * inverse)", r"shape (2,); expected is (2, 2)"),
        (INTEGRATE, "return t, x", "return x", "2 results are asked for, t, x, in this order; yours returns one array"),
        (INTEGRATE, "return t, x", "return", "it returns nothing"),
        (INTEGRATE, "dt * f(t[k]", "dt / 2 * f(t[k]", "t is right; x"),
        (INTEGRATE, "t = np.linspace(0, duration, count + 1)", "t = np.arange(0, count)", "t: it returns an array of"),
    ],
)
def test_results_are_graded_one_by_one(task, old, new, words):
    assert words in says(task, old, new)


def test_each_result_is_named_in_the_example():
    example = grade(FIT_LINE, lambda x, y: (*fit_line(x, y)[:3], 0.0)).example
    assert "expected: slope = " in example and "scatter = 0" in example.split("yours: ")[1]


def find(rgb, *, hue):
    return np.argmax(rgb == hue)


def tried(function):
    if function(np.array([1, 2, 3]), hue=3) != 2:
        raise Failed("it finds another place")
    return ""


def test_a_function_of_keywords_is_asked_by_a_trial_of_its_own():
    task = Task("find", "a place", find, text_of(find), trial=tried, test="def test_find():\n    pass\n")
    assert grade(task, find).state == "right"
    assert grade(task, lambda rgb, *, hue: 0).says == "it finds another place"


def test_a_rounded_pi_and_a_constant_factor_are_told_apart():
    def turns(count):
        return np.array([2 * np.pi * count, np.pi])

    task = Task("turns", "angles", turns, text_of(turns).replace("    def", "def").replace("\n        ", "\n    "),
                cases=lambda: [(1.0,), (2.5,)])  # fmt: skip
    assert "rounded, or written by hand" in grade(task, lambda count: np.array([2 * 3.14 * count, 3.14])).says
    assert "1.002 times" in grade(task, lambda count: 1.002 * turns(count)).says
    assert "0.7 times what it should be" in grade(task, lambda count: 0.7 * turns(count)).says
    nearly = grade(task, lambda count: turns(count) + np.array([0.01 * count**2, 0.003])).says
    assert "by hand" not in nearly and "rounded" not in nearly


def test_whole_numbers_are_no_mistake_where_the_right_ones_are_whole():
    task = Task("count", "a count", lambda n: np.array([n, n + 1, 3, n]), "", cases=lambda: [(2,), (5,)])
    assert "whole numbers" not in grade(task, lambda n: np.array([n + 3, n + 4, 4, n * 7])).says


@pytest.mark.timing
def test_an_answer_that_nothing_explains_waits_a_second_at_most():
    text = "def reach(p, l, q_now, limits):\n    return np.sin(p) + np.cos(q_now) ** {}"
    check("reach", cell(text.format(2), "reach"))  # what is made once and kept is made here
    started = time.process_time()
    check("reach", cell(text.format(3), "reach"))
    assert time.process_time() - started < 1.5  # the page's own time comes on top


ROT_Z = "def rot_z(angle):\n    c, s = np.cos(angle), np.sin(angle)\n    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])"


def test_all_files_of_a_function_are_written_or_none(capsys):
    (student_package.folder() / "test_rot_z.py").mkdir(parents=True)
    check("rot_z", cell(ROT_Z, "rot_z"))
    assert "could not be kept" in capsys.readouterr().out
    assert my_robot.whose("rot_z") == "the course's" and not student_package.path_of("rot_z").exists()
    np.testing.assert_allclose(my_robot.rot_z(0), np.eye(3))
    (student_package.folder() / "test_rot_z.py").rmdir()
    check("rot_z", cell(ROT_Z, "rot_z"))
    assert my_robot.whose("rot_z") == "yours"


@pytest.mark.timing
def test_a_file_is_looked_at_once_in_a_tenth_of_a_second(monkeypatch, capsys):
    check("rot_z", cell(ROT_Z, "rot_z"))
    looks = []
    load = student_package.load
    monkeypatch.setattr(student_package, "load", lambda name: looks.append(name) or load(name))
    began = time.monotonic()
    while time.monotonic() < began + 0.05:
        my_robot.rot_z(0)
    assert len(looks) == 1
    time.sleep(0.11)
    my_robot.rot_z(0)
    assert len(looks) == 2
    check("rot_z", cell(ROT_Z.replace("0, 0, 1.0", "0, 0, 1"), "rot_z"))  # what was just kept is used at once
    looks.clear()
    my_robot.rot_z(0)
    assert looks == ["rot_z"]
