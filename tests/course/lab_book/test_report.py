"""The report holds what the student predicted, wrote and kept, in one file that asks the network for nothing."""

import re

import solutions
from cells import cell
from matplotlib.figure import Figure

from ir50p_lab.course import check, helped_by, keep, measured, note, partners, predict, solution, why
from ir50p_lab.course.publishing import report


def test_a_report_of_everything(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("IR50P_UNIT", "2")
    partners("Ada", "Blaise")
    predict("fk.height", 0.2, "m")
    predict("fk.height", 0.1, "m")
    measured("fk.height", 0.33)
    why("fk.height", "the elbow is <up>")
    note("it sank <slowly>")
    helped_by("...")
    assert "who or what helped" in capsys.readouterr().out
    helped_by("an assistant explained atan2")
    helped_by("an assistant explained atan2")
    keep(Figure(), "my figure")
    check("rot_z", cell("def rot_z(angle):\n    return angle", "rot_z"))
    check("rot_z", cell(solutions.source("rot_z"), "rot_z"))
    check("forward_kinematics", cell(solutions.source("forward_kinematics"), "forward_kinematics"))
    check("pose-3", solution("pose-3"))
    report.main(["--name", "Ada"])
    (path,) = (tmp_path / "results").glob("report_*.html")
    text = path.read_text(encoding="utf-8")
    row = "<td>0.1 m <small>(at first 0.2 m)</small></td><td>0.33 m</td><td>the elbow is &lt;up&gt;</td>"
    for words in ("Ada and Blaise", row, "unit 2", "it sank &lt;slowly&gt;", "my figure", "def rot_z", "on loan"):
        assert words in text, words
    assert re.search(r"<td>01_[^<]*</td><td>[^<]{30,}</td><td>\d+ \w+ \d{4}, \d\d:\d\d</td>", text)
    assert "height of the tip, by pencil" in text and "fk.height" not in text
    assert not re.search(r"<img(?![^>]*alt=\"[^\"]+\")", text)
    assert not re.search(r"https?://", text)
    assert text.count("an assistant explained atan2") == 1


def test_an_empty_report_says_so():
    assert report.report().count("Nothing yet.") >= 4
