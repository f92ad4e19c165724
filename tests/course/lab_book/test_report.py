"""The report holds what the student predicted, wrote and kept, in one file that asks the network for nothing."""

import re

import solutions
from cells import cell
from matplotlib.figure import Figure

from ir50p_lab.course import check, keep, measured, note, predict, solution
from ir50p_lab.publishing import report


def test_a_report_of_everything(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    monkeypatch.setenv("IR50P_UNIT", "2")
    predict("fk.height", 0.1, "m")
    measured("fk.height", 0.33)
    note("it sank <slowly>")
    keep(Figure(), "my figure")
    check("rot_z", cell("def rot_z(angle):\n    return angle", "rot_z"))
    check("rot_z", cell(solutions.source("rot_z"), "rot_z"))
    check("forward_kinematics", cell(solutions.source("forward_kinematics"), "forward_kinematics"))
    check("pose-3", solution("pose-3"))
    report.main(["--name", "Ada"])
    (path,) = (tmp_path / "results").glob("report_*.html")
    text = path.read_text(encoding="utf-8")
    for words in ("Ada", "unit 2", "0.1 m", "0.33 m", "it sank &lt;slowly&gt;", "my figure", "def rot_z", "on loan"):
        assert words in text, words
    assert re.search(r"Exercises done: pose-3 \d{4}-\d\d-\d\d\.", text)
    assert not re.search(r"https?://", text)


def test_an_empty_report_says_so(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    assert report.report().count("Nothing yet.") >= 4
