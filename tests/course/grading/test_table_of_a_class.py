"""Two students who did their work, one who borrowed: the table, the page, the three questions."""

import csv
import json
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest

from ir50p_lab.course.grading import __main__ as command
from ir50p_lab.course.grading import viva
from ir50p_lab.course.grading.page import page
from ir50p_lab.course.grading.submissions import submissions
from ir50p_lab.course.publishing.take_home import packed
from ir50p_lab.course.robot.catalogue import ORDER

_SOLUTIONS = Path(__file__).parents[2] / "solutions"
_SLIP = "every number is 2 times what it should be"


def _home(folder, names, guess=0.5, why="I forgot the <b>sine</b>"):
    robot = folder / "my_robot"
    robot.mkdir(parents=True)
    for name in names:
        imports = "import numpy as np\nfrom ._frames import frames\n\n\n" if name == "jacobian" else ""
        text = (_SOLUTIONS / f"{name}.py").read_text("utf-8")
        (robot / f"_{name}.py").write_text(imports + text, encoding="utf-8")
    entry = {"guess": guess, "truth": 0.33, "within": 0.1, "unit": "m", "why": why}
    book = {
        "predictions": {
            "fk.height": entry,
            "odd": {"guess": "x", "truth": []},
            "none": 3,
            "late": entry | {"late": True},
        },
        "attempts": {"frames": {"a": _SLIP, "b": _SLIP}, "jacobian": ["c"], "evil": 3},
        "partners": ["=1+1", "Bob"],
        "helped": [{"text": "an assistant"}],
    }
    (folder / "results").mkdir()
    (folder / "results" / "lab_book.json").write_text(json.dumps(book), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory):
    folder = tmp_path_factory.mktemp("class")
    _home(folder / "=ada", ORDER)
    borrowed = _home(folder / "bob" / "notebooks", ("rot_z", "dh_matrix", "frames", "jacobian"), guess=0.2)
    robot = borrowed / "my_robot"
    (robot / "_rot_z.py").write_bytes("# für q\n".encode("latin-1") + (robot / "_rot_z.py").read_bytes())
    frames = (robot / "_frames.py").read_text("utf-8")
    (robot / "_frames.py").write_text(frames.replace("return ", "return 2 * "), encoding="utf-8")
    (robot / "_quintic.py").write_text("# on loan from the course: the next\n", encoding="utf-8")
    (robot / "_PID.py").write_text("# yours, stage PID.p: the next\n", encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IR50P_HOME", str(_home(folder / "cleo", ("rot_z",), guess=0.34)))
        (folder / "cleo.zip").write_bytes(packed())
    shutil.rmtree(folder / "cleo")
    return folder


@pytest.fixture(scope="module")
def judged(handed_in):
    made = submissions(handed_in)
    return made, command.judged(made)


def test_functions_are_judged_one_by_one(judged):
    made, (ada, bob, cleo) = judged
    assert [one.name for one in made] == ["=ada", "bob", "cleo"]
    assert ada == dict.fromkeys(ORDER, ("right", ""))
    states = {name: state for name, (state, _) in bob.items()}
    assert states.pop("frames") == "wrong"
    assert states == {"rot_z": "right", "dh_matrix": "right", "jacobian": "right", "quintic": "loan", "PID": "open"}
    assert cleo == {"rot_z": ("right", "")}


def test_the_command_writes_table_and_page(handed_in, tmp_path, monkeypatch, judged, capsys):
    monkeypatch.setattr(command, "judged", lambda _: judged[1])
    command.main([str(handed_in), "--to", str(tmp_path / "out")])
    said = capsys.readouterr().out
    assert "bubblewrap" in said and "3 hand-ins" in said
    with (tmp_path / "out" / "class.csv").open(encoding="utf-8-sig", newline="") as file:
        ada, bob, cleo = csv.DictReader(file)
    assert ada["student"] == "'=ada" and ada["right"] == str(len(ORDER)) and ada["partners (self-reported)"][0] == "'"
    assert (bob["right"], bob["wrong"], bob["loan"], bob["frames"]) == ("3", "1", "1", "wrong")
    assert cleo["right"] == "1" and cleo["predictions (self-reported)"] == "1"
    assert (tmp_path / "out" / "class.html").stat().st_size > 3000


@pytest.mark.parametrize("folder", ["nowhere", "."])
def test_a_folder_without_hand_ins_is_said(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit, match="hand-ins"):
        command.main([folder])


class _Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.seen = []

    def handle_starttag(self, tag, attrs):
        self.seen.append(tag)


def test_the_page_needs_no_script_and_escapes_what_students_wrote(judged):
    text = page(*judged)
    tags = _Tags()
    tags.feed(text)
    assert "script" not in tags.seen and "b" not in tags.seen and "http" not in text
    assert tags.seen.count("details") == 3 and tags.seen.count("svg") == 1
    assert "2 of 3" in text and "1 too low, 2 too high" in text
    assert "3 × <q>I forgot the &lt;b&gt;sine&lt;/b&gt;</q>" in text
    assert "6 × every number is # times what it should be" in text
    assert "self-reported" in text


def test_three_questions_come_from_what_was_handed_in(judged):
    made, found = judged
    guess, tries, loan = viva.questions(made[1], found[1])
    assert "you guessed 0.2 m, it is 0.33" in guess and "I forgot" in guess
    assert tries.startswith("frames took 2 wrong answers") and _SLIP in tries
    assert loan.startswith("quintic is on loan")
    assert all(question.endswith(("?", ".")) for question in viva.questions(made[2], found[2]))
