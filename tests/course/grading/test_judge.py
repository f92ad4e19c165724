"""The judge: what ends early is void, with its error; the reference finishes; a hand-in is one file out of a notebook."""

from pathlib import Path

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import my_robot
from ir50p_lab.course.grading.judge import judged
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.course.unknown import both_ways
from ir50p_lab.course.unknown.hand_in import lent, text_of_hand_in
from ir50p_lab.errors import InputError

REFERENCE = Path(__file__).parents[2] / "support" / "hand_in" / "unknown_arm.py"


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("pass", "void: it never asked for the race"),
        ("for _ in bench.race():\n        bench.drve(0)", "void: AttributeError: 'FarBench' object has no attribute"),
        ("import os\n    os._exit(0)", "void: its process ended"),
        ("print('{\"op\": \"race\"}')\n    open('x', 'w')", "void: "),
        ("for _ in bench.race():\n        break", "0 of 3 balls, 50.00 s"),
        ("bench.look().tofile('/dev/null')\n    1 / 0", "void: ZeroDivisionError"),
    ],
)
def test_what_ends_early_is_void_with_its_error(tmp_path, body, says):
    file = tmp_path / "unknown_arm.py"
    file.write_text(f"def unknown_arm(bench):\n    {body}\n")
    day = judged(file, seeds=[1])
    assert str(day.races[0]).startswith(says)
    assert day.median == 50 and day.complete == 0 and not (tmp_path / "x").exists()


def test_an_endless_loop_is_out_of_time(tmp_path):
    file = tmp_path / "unknown_arm.py"
    file.write_text("while True:\n    pass\n")
    assert str(judged(file, seeds=[1], seconds=5).races[0]).startswith(
        "void: its process ended, or did not end in time"
    )


def test_the_reference_finishes_on_three_arms():
    day = judged(REFERENCE, seeds=[1, 2, 3])
    assert day.complete == 3, str(day)
    assert day.median < 4.5
    assert "complete on 3 of 3 arms" in str(day)


def test_a_file_that_is_not_there_or_not_python_is_told(tmp_path):
    (tmp_path / "ada.zip").write_bytes(b"PK")
    for name in ("none.py", "ada.zip"):
        with pytest.raises(InputError, match="is not a Python file: give the one"):
            judged(tmp_path / name)


def notebook(text, name, **known):
    """A name of a cell with this text, as the notebook has it."""
    found = cell(text, name)
    found.__globals__.update({"np": np, "my_robot": my_robot, "__name__": "__main__"} | known)
    found.__module__ = "__main__"
    return found


def test_a_hand_in_takes_along_what_it_rests_on(monkeypatch):
    law = notebook("def law(q):\n    return GAIN * np.tanh(q) @ table\n", "law", GAIN=3, table=np.eye(2))
    hand_in = notebook(
        "def unused():\n    pass\n\n\ndef unknown_arm(bench):\n    return law(bench), my_robot.rot_z(0)\n",
        "unknown_arm",
        law=law,
        GAIN=3,
    )
    text = text_of_hand_in(hand_in)
    assert "unused" not in text and "GAIN = 3" in text and "table = np.array([[1.0, 0.0], [0.0, 1.0]])" in text
    room = {}
    exec(text, room)
    first, second = room["unknown_arm"](np.array([0.0, 0.5]))
    assert np.allclose(first, 3 * np.tanh([0, 0.5])) and np.allclose(second, np.eye(3))


def test_what_the_course_lent_is_told(tmp_path):
    text = "def unknown_arm(bench):\n    both_ways(np.ones(200))\n    next(bench.race())\n"
    file = tmp_path / "unknown_arm.py"
    file.write_text(text_of_hand_in(notebook(text, "unknown_arm", both_ways=both_ways)))
    day = judged(file, seeds=[1])
    assert "0 of 3 balls" in str(day) and "the course's in it: both_ways, circle_votes, " in str(day)


def test_what_my_robot_lacks_or_has_on_loan_is_the_courses(tmp_path):
    (tmp_path / "my_robot").mkdir()
    for name, text in ("quintic", ""), ("reach", "# on loan from the course: the next you write takes its place\n"):
        (tmp_path / "my_robot" / f"_{name}.py").write_text(text + solutions.source(name))
    found = lent("def unknown_arm(bench):\n    my_robot.quintic(my_robot.fit_percent, my_robot.whose)\n", tmp_path)
    assert {"reach", "fit_percent", "hue_mask"} <= set(found) and not {"quintic", "whose", "rot_z"} & set(found)


def test_nothing_is_lent_to_who_wrote_it_all(tmp_path):
    (tmp_path / "my_robot").mkdir()
    for name in ORDER:
        (tmp_path / "my_robot" / f"_{name}.py").write_text(solutions.source(name))
    assert lent(REFERENCE.read_text(encoding="utf-8"), tmp_path) == ()


def test_what_cannot_be_handed_in_is_told():
    with pytest.raises(InputError, match="a function called `unknown_arm`"):
        text_of_hand_in(notebook("def other(bench):\n    pass\n", "other"))
    with pytest.raises(InputError, match="there are still dots"):
        text_of_hand_in(notebook("def unknown_arm(bench):\n    ...\n", "unknown_arm"))
    with pytest.raises(InputError, match="needs `thing`"):
        text_of_hand_in(notebook("def unknown_arm(bench):\n    thing\n", "unknown_arm", thing=object()))
