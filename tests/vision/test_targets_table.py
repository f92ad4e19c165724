"""The table of targets: one line each, a missed target and a part that fails are seen and set the exit code."""

import sys
import types

import pytest

from tests.targets import vision
from tests.targets.rows import Row, table


def test_a_table_has_one_line_a_row_and_marks_what_is_missed():
    rows = [Row("centre, median", "<= 0.5 px", "0.1 px", "-", True), Row("rms", "<= 1", "2", "0.15 px", False)]
    lines = table(rows, "Title").splitlines()
    assert lines[0] == "Title"
    assert len(lines) == 6
    assert lines[4].endswith("met")
    assert lines[5].endswith("MISSED")


@pytest.mark.parametrize("ok", [True, False, None])
def test_the_exit_code_says_whether_a_target_was_missed(monkeypatch, capsys, ok):
    fake = types.ModuleType("fake")
    fake.rows = lambda *, quick: [Row("x", "y", str(quick), ok=ok)]
    monkeypatch.setitem(sys.modules, "tests.targets.vision_ball", fake)
    assert vision.main(["--quick", "--only", "ball"]) == (1 if ok is False else 0)
    assert "True" in capsys.readouterr().out
