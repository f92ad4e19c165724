"""The exercises: every one of every module, then the framework itself."""

import json
import os
from pathlib import Path

import exercise_rules
import numpy as np
import pytest
import sympy

from ir50p_lab import home
from ir50p_lab.course import exercises as package
from ir50p_lab.course.exercises import (
    Exercise,
    Function,
    Number,
    check,
    grade,
    progress,
    solution,
)
from ir50p_lab.course.exercises._catalogue import everything
from ir50p_lab.course.lab_book.progress import progress_path, read_progress
from ir50p_lab.errors import InputError

ALL = [exercise for _, exercise in everything()]


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


# --- every exercise of every module


@pytest.mark.parametrize("exercise", ALL, ids=lambda exercise: exercise.name)
def test_exercise(exercise):
    assert exercise_rules.problems(exercise) == []


@pytest.mark.parametrize("name", [exercise.name for exercise in ALL])
def test_check_of_a_solution_is_noted(name, capsys, own_progress):
    assert said(capsys, name).startswith(f"{name}: not answered yet")
    assert not own_progress.exists()  # a stub writes nothing
    assert said(capsys, name, solution(name)).startswith(f"{name}: right. ")
    assert list(json.loads(own_progress.read_text())["done"]) == [name]


def test_the_rules_find_faults():
    """The rules above are not vacuous: a careless exercise breaks each of them."""
    good = ALL[0]

    def found(**changes):
        kept = {f: getattr(good, f) for f in ("name", "task", "kind", "why", "slips", "hint")}
        return " ".join(exercise_rules.problems(Exercise(**(kept | changes))))

    right = good.kind.right
    assert found() == ""
    assert "prefix-number" in found(name="Start 1")
    assert "full stop" in found(task="the angles.")
    assert "only 2 slips" in found(slips={})
    assert "is answered by right" in found(slips={"This is in fact the right answer.": right})
    assert "gives the answer away" in found(slips={"It should begin with 1.571 in fact.": right * 2})
    assert "gives the answer away" in found(hint="Try -0.785.")
    assert "is slip" in found(slips={"Anything goes in this one.": exercise_rules.random_wrong(good.kind)})


# --- the two kinds of answer

VECTOR = Exercise("x-1", "three numbers", Number([1.0, 2.0, 3.5], unit="m"), "because")
TYPED = Exercise("x-3", "e", Number(np.e, tolerance=1e-3), "because")
SQUARE = Exercise("x-3", "the square", Function(lambda x: x**2, cases=[1.5, -2.0, np.float64(3)]), "because")
WHOLE = Exercise(
    "x-4", "the sum", Function(lambda q: q.sum(), cases=[np.array([1.0, 2, 4]), np.array([0, 0, 1.0])]), "b"
)


@pytest.mark.parametrize(
    ("exercise", "answer", "words"),
    [
        (VECTOR, None, "found None"),
        (VECTOR, "1 2 3", "found the text '1 2 3'"),
        (VECTOR, True, "found True"),
        (VECTOR, [1, 2], "found 2 numbers; expected 3 numbers in m"),
        (VECTOR, 4, "found a number; expected 3 numbers"),
        (VECTOR, np.zeros((3, 3)), "found a 3 x 3 matrix"),
        (VECTOR, [1, 2, np.nan], "holds nan"),
        (VECTOR, [1, 2, 3j], "complex"),
        (VECTOR, [1, [2], [3, 4]], "different lengths"),
        (VECTOR, [1, 2, ...], "1 of 3 entries are still"),
        (VECTOR, [1, 2, sympy.Symbol("l3")], "still holds the symbol l3"),
        (VECTOR, np.sin, "the function sin, not what it returns"),
        (VECTOR, [], "something empty"),
        (SQUARE, 4, "a value, not a function"),
    ],
)
def test_a_wrong_form_is_named(exercise, answer, words):
    verdict = grade(exercise, answer)
    assert verdict.state == "unreadable"
    assert words in verdict.text


@pytest.mark.parametrize(
    ("exercise", "answer", "state", "words"),
    [
        (VECTOR, [1, 2, 4], "wrong", "look again at answer[2]"),
        (VECTOR, [1.000004, 2, 3.5], "wrong", "close, but 1e-06 m"),
        (TYPED, 2.72, "wrong", "close, but 0.001 is the limit (3 decimals are what you would type)"),
        (VECTOR, [-1, -2, -3.5], "slip", "sign"),
        (VECTOR, [1000, 2000, 3500], "slip", "millimetres"),
        (SQUARE, lambda x: x * x, "right", ""),
        (SQUARE, lambda x: x * abs(x), "wrong", "right for 2 of 3 inputs"),
        (SQUARE, lambda x, y: x, "wrong", "it takes (x, y); it will be called with (x)"),
        (SQUARE, lambda x: 1 / 0, "wrong", "a division by zero"),
        (SQUARE, lambda x: print(end="") or None, "wrong", "is there a `return`"),
        (SQUARE, lambda x: [x, x], "wrong", "an array of shape (2,); expected is ()"),
        (SQUARE, lambda x: np.sqrt(x), "wrong", "not finite"),
        (WHOLE, sum, "right", ""),
        (WHOLE, lambda q: q[0], "wrong", "Expected: a function of (q) that returns a number."),
        (WHOLE, lambda q: (q.fill(1.0), q.sum())[1], "wrong", "it changes what it was given"),
    ],
)
def test_what_is_said(exercise, answer, state, words):
    verdict = grade(exercise, answer)
    assert verdict.state == state, verdict.text
    assert words in verdict.text


def test_a_student_cannot_change_the_question(capsys):
    answer = solution("start-1")
    answer[:] = 0
    assert not np.allclose(solution("start-1"), 0)
    assert said(capsys, "start-1", answer).startswith("start-1: not yet")


def test_an_interrupt_is_told_from_a_mistake():
    def stop(x):
        raise KeyboardInterrupt

    assert "it was stopped: does a loop in it never end?" in grade(SQUARE, stop).text


def test_an_input_that_fails_is_shown():
    verdict = grade(WHOLE, lambda q: q[0])
    assert verdict.more == (("one input that fails", "for q = [1., 2., 4.]\nexpected: 7.\nyours: 1."),)


# --- names, solutions


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("start-11", "Nearest names: start-1"),
        (("stat-5", "start-5")),
        ("zzzzzz", "There is no exercise 'zzzzzz'. Nearest names: "),
        (3, "name of the exercise comes first"),
        ("_numbers-1", "no exercise"),
    ],
)
def test_unknown_name(name, words, capsys):
    assert words in said(capsys, name, 1)
    with pytest.raises(InputError, match=r"no exercise|comes first"):
        solution(name)


def test_the_name_is_read_kindly(capsys):
    assert said(capsys, " Start-1 ").startswith("start-1: not answered yet")


def _root():
    return Path(package.__file__).parents[3]


# --- the progress file


def test_progress_table(capsys, own_progress):
    check("start-5", solution("start-5"))
    capsys.readouterr()
    assert progress() is None
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "00_start_here"
    assert [line.split()[:2] for line in lines[1:3]] == [["start-1", "open"], ["start-5", "done"]]
    assert lines[-1].startswith(f"1 of {len(ALL)} exercises done")


def test_first_success_stays(capsys, own_progress):
    check("start-1", solution("start-1"))
    before = own_progress.read_text()
    own_progress.write_text(before.replace(json.loads(before)["done"]["start-1"], "2020-01-01T00:00+00:00"))
    check("start-5", solution("start-5"))
    check("start-1", solution("start-1"))
    check("start-1", "something else")
    assert json.loads(own_progress.read_text())["done"]["start-1"] == "2020-01-01T00:00+00:00"
    assert sorted(p.name for p in own_progress.parent.iterdir()) == ["progress.json"]  # no scratch files


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", "[" * 100_000, '{"done": 3}', '{"done": {"start-1": 1}}', "{}", b"\xff\xfe".decode("latin1")],
)
def test_damaged_file(content, capsys, own_progress):
    own_progress.write_bytes(content.encode("latin1"))
    text = said(capsys, "start-1", solution("start-1"))
    assert text.startswith("start-1: right.") and "cannot be read" in text and "rename it" in text
    assert own_progress.read_bytes() == content.encode("latin1")  # nothing is lost
    progress()
    assert "cannot be read" in capsys.readouterr().out


def test_unwritable_place(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_PROGRESS", str(tmp_path / "no" / "such" / "folder.json"))
    text = said(capsys, "start-1", solution("start-1"))
    assert text.startswith("start-1: right.") and "cannot be written (No such file" in text


def test_failed_swap_leaves_the_old_file(capsys, own_progress, monkeypatch):
    check("start-1", solution("start-1"))
    before = own_progress.read_text()
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(PermissionError(13, "Permission denied")))
    assert "Permission denied" in said(capsys, "start-5", solution("start-5"))
    assert own_progress.read_text() == before
    assert len(list(own_progress.parent.iterdir())) == 1


def test_the_file_lies_in_the_students_folder(monkeypatch, tmp_path, capsys):
    monkeypatch.delenv("IR50P_PROGRESS")
    monkeypatch.delenv("IR50P_HOME", raising=False)
    assert progress_path() == _root() / "notebooks" / "progress.json"
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "new" / "folder"))
    said(capsys, "start-1", solution("start-1"))
    assert list(json.loads((tmp_path / "new" / "folder" / "progress.json").read_text())["done"]) == ["start-1"]


def test_progress_of_an_earlier_version_is_taken_over(monkeypatch, tmp_path, capsys):
    """It lay in the project's root; what is new goes to the student's folder, and the old file stays as it is."""
    monkeypatch.delenv("IR50P_PROGRESS")
    monkeypatch.delenv("IR50P_HOME", raising=False)
    monkeypatch.setattr(home, "PROJECT", tmp_path)
    (tmp_path / "notebooks").mkdir()
    old = tmp_path / "progress.json"
    old.write_text('{"done": {"start-5": "2020-01-01T00:00+00:00"}}')
    said(capsys, "start-1", solution("start-1"))
    assert list(read_progress()) == ["start-1", "start-5"] and "start-1" not in old.read_text()
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "of somebody else"))
    assert read_progress() == {}


# --- how it looks
