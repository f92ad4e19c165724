"""A file of a function that an editor has saved in another encoding is named, with the remedy."""

import pytest

from ir50p_lab.course import my_robot
from ir50p_lab.course.lab_book.update import take_over
from ir50p_lab.course.publishing import report
from ir50p_lab.errors import LabError


@pytest.fixture(params=["latin-1", "utf-16", "cp1252", "utf-16-le"])
def foreign(request, tmp_path, monkeypatch):
    """The student's folder with a rot_z in such a file."""
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "home"))
    folder = tmp_path / "home" / "my_robot"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text("from ._rot_z import rot_z\n")
    letter = "e" if request.param == "utf-16-le" else "é"  # plain letters of two bytes are UTF-8, too
    (folder / "_rot_z.py").write_bytes(f'def rot_z(angle):\n    return "{letter}"\n'.encode(request.param))
    return folder / "_rot_z.py"


def test_my_robot_names_it(foreign):
    with pytest.raises(LabError, match=r"_rot_z\.py is not in UTF-8: .*encoding UTF-8"):
        my_robot.rot_z(0.0)


def test_the_report_names_it(foreign, monkeypatch):
    with pytest.raises(LabError, match=r"_rot_z\.py is not in UTF-8"):
        report.main(["--name", "Ada"])


def test_update_names_it(foreign, tmp_path, monkeypatch, capsys):
    older = tmp_path / "older" / "notebooks"
    older.mkdir(parents=True)
    foreign.parent.rename(older / "my_robot")
    take_over(str(older.parent))
    assert "encoding UTF-8" in capsys.readouterr().out
