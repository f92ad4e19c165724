"""Wrong answers are told apart from their numbers, right ones of any shape are taken, and nothing makes check raise."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course.checking import grade as grading
from ir50p_lab.course.checking.calling import call, case_in_words
from ir50p_lab.course.checking.cell import extract
from ir50p_lab.course.checking.judge_text import CannotTake
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.robot.catalogue import ORDER


def sections_of(name):
    """Pairs (heading, text) of a file beside this one; a heading stands behind "# "."""
    text = Path(__file__).with_name(name).read_text(encoding="utf-8")
    _, *parts = re.split(r"^# (.+)\n", text, flags=re.MULTILINE)
    return [(heading, part.strip("\n")) for heading, part in zip(parts[::2], parts[1::2], strict=True)]


def told(capsys, name, *changes, text=None, notebook=()):
    """What check says of the reference solution with some words replaced."""
    text = solutions.source(name) if text is None else text
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    capsys.readouterr()
    check(name, cell(text, name.partition(".")[0], notebook))
    return capsys.readouterr().out.split("one input that fails")[0]


HAND = "def rot_z(angle):\n    {}\n    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])"
SINE = "c, s = np.cos(angle), np.sin(angle)"
OTHER_FORMS = sections_of("other_forms.txt")
OTHER_FORM = dict(reversed(OTHER_FORMS))  # of each function the first
ROWS = [(heading, line) for heading, text in sections_of("wrong_answers.txt") for line in text.splitlines()]


def judged(name, text):
    """State and sentence on the text of a cell."""
    wanted = task(name)
    try:
        found = grading.grade(wanted, extract(cell(text, wanted.function), wanted.function, wanted.leans_on))
    except CannotTake as reason:
        return f"wrong: {reason}"
    return f"{found.state}: {found.says}"


@pytest.mark.parametrize(("heading", "line"), ROWS, ids=range(len(ROWS)))
def test_a_wrong_answer_is_told(heading, line):
    """A row of wrong_answers.txt: one change or several (;;) in a right answer, and words of what is said of it."""
    name, _, form = heading.partition(", ")
    text = OTHER_FORM[name] if form else task(name).solution_text if name.startswith("PID") else solutions.source(name)
    changes, words = line.replace("\\n", "\n").split("  =>  ")
    for change in changes.split("  ;;  "):
        old, new = change.split("  ->  ")
        assert old in text
        text = text.replace(old, new)
    says = judged(name, text)
    assert says.startswith("wrong") and words in says.replace("\n", " "), says


@pytest.mark.parametrize(("name", "text"), OTHER_FORMS, ids=[name for name, _ in OTHER_FORMS])
def test_other_forms_are_right(name, text):
    assert judged(name, text) == "right: "


@pytest.mark.parametrize("name", ["dh_matrix", "frames", "jacobian"])
def test_integers_that_cut_off_are_named_everywhere(name, capsys):
    whole = {
        "dh_matrix": [("T = np.eye(4)", "T = np.eye(4, dtype=int)")],
        "frames": [("return np.array(T)", "return np.array(T).astype(int)")],
        "jacobian": [("np.zeros((6, 3))", "np.zeros((6, 3), int)")],
    }[name]  # fmt: skip
    assert "integers" in told(capsys, name, *whole)


@pytest.mark.parametrize(
    "value", ["[[1, 2], [3]]", "np", "'text'", "{1: 2}", "None", "np.nan", "[]", "(1, [2, 3])", "..."]
)
@pytest.mark.parametrize("name", ["rot_z", "inverse_kinematics", "reach", "damped_step"])
def test_whatever_comes_back_is_no_error(name, value, capsys):
    arguments = ", ".join(task(name).signature)
    assert "not" in told(capsys, name, text=f"def {name}({arguments}):\n    x = {value}\n    return x")


def test_an_empty_list_out_of_reach_and_a_numeric_jacobian_are_right(capsys):
    assert "right, and yours" in told(capsys, "inverse_kinematics", ("return np.empty((0, 3))", "return []"))
    step = "((np.cos(1e-6) - 1) * np.cross(axis, np.cross(lever, axis)) + np.sin(1e-6) * np.cross(axis, lever)) / 1e-6"
    text = task("jacobian").solution_text.replace("np.cross(axis, lever)", step)
    assert "right, and yours" in told(capsys, "jacobian", text=text)


def test_a_number_of_the_edge_is_a_nanometre(capsys):
    for step, inside in ((-0.5e-9, True), (0.5e-9, True), (1e-6, False)):
        l = np.array([0.285, 0.2, 0.372])
        p = np.array([0, 0, l[0]]) + (l[1] + l[2] + step) * np.array([0.6, 0, 0.8])
        assert (len(task("inverse_kinematics").reference(p, l)) > 0) == inside


@pytest.mark.parametrize("difference", ["(place(q + e) - place(q - e)) / 2e-6", "(place(q + e) - place(q)) / 1e-6"])
def test_a_good_numeric_jacobian_is_right(difference, capsys):
    text = f"""def damped_step(q, p, l, damping):
    def place(q):
        return forward_kinematics(q, l)
    J = np.zeros((3, 3))
    for k in range(3):
        e = np.zeros(3)
        e[k] = 1e-6
        J[:, k] = {difference}
    return q + J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(3), p - place(q))"""
    assert "right, and yours" in told(capsys, "damped_step", text=text)


@pytest.mark.parametrize(
    "text",
    [
        "from math import *\n\n\n" + HAND.format("c, s = cos(angle), sin(angle)"),
        "from functools import lru_cache\n\n\n@lru_cache\n" + HAND.format(SINE),
        "import itertools\nfrom typing import Any\nfrom collections import namedtuple\n\nPair = namedtuple('Pair', 'c s')\n\n\n"
        + HAND.format("c, s = Pair(*itertools.chain([np.cos(angle)], [np.sin(angle)]))"),
        "cosine = lambda a: np.cos(a)\n\n\n" + HAND.format("c, s = cosine(angle), np.sin(angle)"),
        "cosine, sine = np.cos, np.sin\n\n\n" + HAND.format("c, s = cosine(angle), sine(angle)"),
        "rot_z = lambda a: np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])",
        HAND.format("f = np; c, s = f.cos(angle), f.sin(angle)"),
    ],
)
def test_right_ones_of_any_shape_are_kept_and_run_alone(text, capsys):
    said = told(capsys, "rot_z", text=text, notebook={"sin": 0})
    assert "right, and yours" in said
    np.testing.assert_allclose(my_robot.rot_z(0.3), task("rot_z").reference(0.3))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("np.allclose = lambda *a, **k: True; c, s = 1, 0", "changes or opens `np.allclose`"),
        ("c = s = __import__('ir50p_lab.modelling').modelling.rot_z(angle)", "uses `__import__`"),
        ("exec('from ir50p_lab.modelling import rot_z as r', d := {}); c = s = d['r'](angle)", "uses `exec`"),
        ("c = s = np.__builtins__", "changes or opens"),
        ("c = s = frames(angle, angle)", "calls `frames`: this function has to do without it"),
    ],
)
def test_ways_round_the_task_are_refused(line, words, capsys):
    before = np.allclose
    assert words in told(capsys, "rot_z", text=HAND.format(line))
    assert np.allclose is before


def test_what_is_not_written_in_the_cell_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(np, "allclose", np.allclose)  # to put it back
    patched = "np.allclose = lambda *a, **k: True\n\n\ndef rot_z(angle):\n    return np.eye(3)"
    assert "changes or opens `np.allclose`" in told(capsys, "rot_z", text=patched)
    assert "the course's own" in told(capsys, "rot_z", text="from ir50p_lab.modelling import rot_z")
    assert "right, and yours" not in told(capsys, "rot_z", text="def rot_z(angle):\n    return np.eye(3) + angle")


def test_after_six_tries_the_right_formula_is_ones_own_whoever_printed_it(capsys):
    for k in range(6):
        told(capsys, "rot_z", text=f"def rot_z(angle):\n    return {k} * np.eye(3)")
    assert my_robot.whose("rot_z") == "on loan"
    assert "right, and yours" in told(capsys, "rot_z", text=task("rot_z").solution_text)


def test_no_sentence_says_not_yet_twice(capsys):
    said = told(capsys, "forward_kinematics", text="def forward_kinematics(q, l):\n    return np.cos(q * l) + q**3")
    assert said.count("not yet") == 1 and "0 of 9 inputs" in said


def test_crossings_between_two_samples_are_right_too(capsys):
    text = """def step_metrics(t, q, target):
    rise, *others = by_samples(t, q, target)
    done = (q - q[0]) / (target - q[0])
    if np.any(done >= 0.9):
        first, last = np.argmax(done >= 0.1), np.argmax(done >= 0.9)
        rise = np.interp(0.9, done[last - 1:last + 1], t[last - 1:last + 1])
        rise -= np.interp(0.1, done[first - 1:first + 1], t[first - 1:first + 1])
    return rise, *others"""
    check(
        "step_metrics",
        cell(solutions.source("step_metrics").replace("step_metrics", "by_samples") + "\n\n\n" + text, "step_metrics"),
    )
    assert "from now on my_robot.step_metrics is this function" in capsys.readouterr().out


def test_long_runs_are_shown_short_and_last(capsys):
    text = solutions.source("step_metrics").replace("0.02", "0.05")
    check("step_metrics", cell(text, "step_metrics"))
    said = capsys.readouterr().out
    assert "expected (s, rad, s, rad)" in said and said.index("target = ") < said.index("t = [")
    assert len(re.findall(r"\d\.\d*", said.split("expected")[0])) < 25


def test_a_question_ends_as_one_and_names_are_the_students(capsys):
    said = told(capsys, "rot_z", ("[c, -s, 0.0], [s", "[c, s, 0.0], [-s"))
    assert "?." not in said and said.rstrip().endswith("?")
    text = task("damped_step").solution_text.replace("missing = p - tip", "e = tip - p").replace("missing", "e")
    said = told(capsys, "damped_step", text=text)
    assert "wrong way round" in said and "missing" not in said


def test_a_waist_beyond_half_a_turn_is_told(capsys):
    said = told(capsys, "inverse_kinematics", ("q1 = np.arctan2(side * y, side * x)",
                "q1 = np.arctan2(y, x) + (np.pi if side < 0 else 0)"))  # fmt: skip
    assert re.search(r"the waist of pose 3 is (\d.\d) rad: the same pose is -\d.\d rad", said), said


def test_numbers_that_two_mistakes_share_name_both(capsys):
    said = told(
        capsys, "jacobian", text=task("jacobian").solution_text.replace("cross(axis, lever)", "cross(lever, axis)")
    )
    assert "factors of the cross product" in said and "from the point to the joint" in said
    said = told(capsys, "reach", text=task("reach").solution_text.replace("            smallest = turn\n", ""))
    assert "compared" in said and "kept up to date" in said


def test_places_to_reach_have_one_best_pose():
    for p, l, q_now, limits in task("reach").cases():
        turns = [np.abs(q - q_now).max() for q in task("inverse_kinematics").reference(p, l)
                 if (q >= limits[0]).all() and (q <= limits[1]).all()
                 and (task("frames").reference(q, l)[2:, 2, 3] >= 0).all()]  # fmt: skip
        assert len(turns) < 2 or np.diff(np.sort(turns))[0] > 0.05


WHOLE = [[*heading.split("  =>  "), text] for heading, text in sections_of("wrong_texts.txt")]


@pytest.mark.parametrize(("name", "words", "text"), WHOLE, ids=range(len(WHOLE)))
def test_a_whole_wrong_answer_is_told(name, words, text, capsys):
    said = told(capsys, name, text=text, notebook={"my_robot": my_robot, "by_course": task("frames").reference})
    assert words in said and "gufunc" not in said, said


@pytest.mark.parametrize("name", [name for name in ORDER if task(name).cases is not None])
def test_the_example_shown_is_one_where_the_mistake_named_happens(name, monkeypatch):
    """With the sentences for known mistakes taken away, the symptom has to speak of what is shown."""
    monkeypatch.setattr(grading, "distortions", lambda task: ())
    known, one = task(name).mistakes, dataclasses.replace(task(name), mistakes=())
    cases, shown = one.cases(), 0
    beginnings = [case_in_words(one, case) + "\n" for case in cases]
    right = [one.reference(*case) for case in cases]
    for mistake in known:
        verdict = grading.grade(one, mistake.function)
        returned = [call(one, mistake.function, case) for case in cases]
        answers = {k: (case, returned[k], right[k]) for k, case in enumerate(cases)}
        answers = {k: answer for k, answer in answers.items() if not one.agrees(*answer[1:])}
        there = [k for k, words in enumerate(beginnings) if verdict.example.startswith(words)]
        shown += bool(there)
        assert not there or any(k in answers for k in there)
        if there and one.symptom and not verdict.says.startswith("it stops"):
            if verdict.says not in {one.symptom(*answer) for answer in answers.values()}:
                continue
            assert verdict.says in {one.symptom(*answers[k]) for k in there if k in answers}
    assert shown > 0.8 * len(known)


def test_a_function_of_the_notebook_in_place_of_the_argument_is_told(capsys):
    name, text = "rk4_step", solutions.source("rk4_step")
    said = told(capsys, name, text=text.replace("f(t", "falling(t"), notebook={"falling": np.sin})
    assert "it gets the function as its argument `f`" in said


@pytest.mark.parametrize("name", ["velocity_torque", "gravity_torque"])
def test_an_array_that_takes_its_kind_from_whole_angles_is_told(capsys, name):
    text = solutions.source(name)
    body = (
        f"\n\n\ndef {name}(q, *others):\n    tau = np.zeros_like(q)\n    tau[:] = right(q, *others)\n    return tau\n"
    )
    said = told(capsys, name, text=text.replace(f"def {name}(", "def right(") + body)
    assert "it is right except where `q` holds whole numbers" in said.replace("\n", " ")
