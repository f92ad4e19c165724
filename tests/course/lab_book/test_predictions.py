"""The lab book: guesses and what came out, notes, figures; a damaged one is named."""

import pytest
from matplotlib.figure import Figure

from ir50p_lab.course import lab_book


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    return tmp_path


def said(capsys):
    return capsys.readouterr().out


def test_predictions_are_kept_and_the_first_counts(capsys):
    lab_book.predict("fk.height", ..., "m")
    assert "in place of the dots" in said(capsys)
    lab_book.predict("fk.height", 0.1, "m")
    lab_book.predict("fk.height", 0.3, "m")
    assert "the first one counts" in said(capsys)
    lab_book.measured("fk.height", 0.33)
    assert "you guessed 0.1 m, it is 0.33 m" in said(capsys)
    lab_book.measured("other", 1, "m")
    assert said(capsys) == "other: 1 m\n"
    lab_book.note("it sank")
    lab_book.note("it sank")
    assert [one["text"] for one in lab_book.read()["notes"]] == ["it sank"]


def test_a_figure_is_kept_under_its_name(home, capsys):
    lab_book.keep(Figure(), "my first arm")
    lab_book.keep(Figure(), "my first arm")
    assert [one["file"] for one in lab_book.read()["figures"]] == ["my_first_arm.png"]
    assert (home / "results" / "figures" / "my_first_arm.png").exists()


def test_a_damaged_lab_book_is_named(home):
    lab_book.path().parent.mkdir()
    lab_book.path().write_text("[" * 100000)
    with pytest.raises(lab_book.LabBookError, match="rename it"):
        lab_book.read()
