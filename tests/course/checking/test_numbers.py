"""What is said to a number; names, solutions and what is noted. The numbers themselves: `test_numbers_of_rooms.py`."""

import json
import subprocess
import sys

import numpy as np
import pytest
import sympy

from ir50p_lab.course import check, solution
from ir50p_lab.course.checking.number import Number
from ir50p_lab.course.checking.numbers import grade_number
from ir50p_lab.errors import InputError
from ir50p_lab.home import PROJECT

VECTOR = Number("x-1", "", "three numbers", [1.0, 2.0, 3.5], unit="m", tolerance=1e-6, why="because", mistakes={})
TYPED = Number(
    "x-3", "", "e", np.e, tolerance=1e-3, why="because", mistakes={"Nearly: it is not pi.": np.pi}, hint="Euler."
)


@pytest.fixture(autouse=True)
def own_progress(tmp_path, monkeypatch):
    """No test touches the progress file of whoever runs it."""
    path = tmp_path / "progress.json"
    monkeypatch.setenv("IR50P_PROGRESS", str(path))
    return path


def said(capsys, name, answer=...):
    """Return what check says."""
    capsys.readouterr()
    assert check(name, answer) is None
    out, err = capsys.readouterr()
    assert err == "" and out.count("\n") == 1
    return out.strip()


class Hostile:
    """An object that raises whatever is done with it."""

    def __getattr__(self, name):
        raise RuntimeError("no")

    __call__ = __array__ = __iter__ = __float__ = __len__ = __repr__ = __str__ = __eq__ = __getattr__
    __hash__ = object.__hash__


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (None, "found None"),
        ("1 2 3", "found text in quotes; expected 3 numbers in m"),
        (True, "type bool"),
        ([1, 2], "found 2 numbers; expected 3 numbers in m"),
        (4, "found a number; expected"),
        ([], "found 0 numbers"),
        (np.zeros((3, 3)), "found a 3 x 3 matrix"),
        ([1, 2, np.nan], "not finite: nan"),
        ([1, 2, np.inf], "inf"),
        ([1, 2, np.complex128(3)], "complex"),
        ([1, [2], [3, 4]], "different lengths"),
        ([1, 2, ...], "dots (...) that are still to be replaced"),
        ([1, 2, sympy.Symbol("l3")], "type Symbol"),
        (lambda: 1, "found a function"),
    ],
)
def test_a_wrong_form_is_named(answer, words):
    note = grade_number(VECTOR, answer)
    assert note.state == "unreadable"
    assert words in note.text


def test_an_object_that_raises_is_no_error():
    assert grade_number(VECTOR, Hostile()).text == "found an object of type Hostile; expected 3 numbers in m."


@pytest.mark.parametrize(
    ("number", "answer", "state", "words"),
    [
        (VECTOR, ..., "open", "not answered yet. To find: three numbers. Expected: 3 numbers in m."),
        (VECTOR, (..., ..., ...), "open", "not answered yet"),
        (VECTOR, [1, 2, 4], "wrong", "look again at answer[2]"),
        (VECTOR, [1.000004, 2, 3.5], "wrong", "close, but 1e-06 m"),
        (VECTOR, [-1, -2, -3.5], "mistake", "sign"),
        (VECTOR, [1000, 2000, 3500], "mistake", "millimetres"),
        (TYPED, 2.72, "wrong", "close, but 0.001 is the limit (it allows for rounding)"),
        (TYPED, 3.1416, "mistake", "not yet, found 3.1416. Nearly: it is not pi."),
        (TYPED, 1, "wrong", "not yet, found 1; expected a number: e. Euler."),
    ],
)
def test_what_is_said(number, answer, state, words):
    note = grade_number(number, answer)
    assert note.state == state, note.text
    assert words in note.text


@pytest.mark.parametrize("answer", [[1.0001, 2, 3.5], [1.2, 2.2, 3.3]])
def test_what_is_far_off_is_not_called_close(answer):
    assert "close" not in grade_number(VECTOR, answer).text


@pytest.mark.parametrize(
    ("number", "answer"),
    [
        (VECTOR, (1, 2, 3.5)),
        (VECTOR, np.array([[1], [2], [3.5]])),
        (VECTOR, sympy.Matrix([1, 2, sympy.Rational(7, 2)])),
        (TYPED, [np.e]),
        (TYPED, sympy.E),
    ],
)
def test_a_right_answer_in_another_form(number, answer):
    note = grade_number(number, answer)
    assert note.state == "right" and note.text == f"right. {number.why}"


def test_a_right_answer_is_noted(capsys, own_progress):
    assert said(capsys, " Start-1 ").startswith("start-1: not answered yet")
    assert not own_progress.exists()  # a stub writes nothing
    assert said(capsys, "start-1", solution("start-1")).startswith("start-1: right. ")
    assert list(json.loads(own_progress.read_text())["done"]) == ["start-1"]
    own_progress.write_text("{")
    assert "right. " in (text := said(capsys, "start-5", solution("start-5"))) and "(Not noted: " in text
    assert own_progress.read_text() == "{"  # nothing is lost


def test_a_student_cannot_change_the_question(capsys):
    answer = solution("start-1")
    answer[:] = 0
    assert not np.allclose(solution("start-1"), 0)
    assert said(capsys, "start-1", answer).startswith("start-1: not yet")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("start-11", "Nearest names: start-1"),
        ("rot_y", "rot_z"),
        ("zzzzzz", "There is no exercise 'zzzzzz'. Nearest names: start-1"),
        ("dyn-3", "There is no exercise 'dyn-3'. Nearest names: dyn-"),  # of an older copy's notebook
        ("", "no exercise"),
        ([1, 2], "name of the exercise comes first"),
    ],
)
def test_unknown_name(name, words, capsys):
    assert words in said(capsys, name, 1)
    with pytest.raises(InputError, match=r"no exercise|comes first"):
        solution(name)


def test_solutions_of_functions_are_texts(capsys):
    assert solution("rot_z").startswith("def rot_z(angle):")
    assert "class PID" in solution("PID.p")


def test_only_the_room_asked_for_is_imported():
    code = (
        "import sys; from ir50p_lab.course import check; check('start-1');"
        "print([m for m in sys.modules if m.startswith('ir50p_lab') and m.endswith('numbers')], 'sympy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=PROJECT)
    rooms = ["ir50p_lab.course.checking.numbers", "ir50p_lab.course.start.numbers"]
    assert done.stdout.splitlines()[1] == f"{rooms} False"
