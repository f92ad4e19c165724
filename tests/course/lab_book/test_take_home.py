"""What was written in one place goes into another as a ZIP; what is there already stays."""

import zipfile

import pytest

from ir50p_lab.course.lab_book.update import take_over
from ir50p_lab.course.publishing.take_home import main, packed


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A ZIP of a folder with a function, a result, a compiled file and a folder that is not the student's."""
    for name in ("my_robot/_rot_z.py", "results/figures/circle.png", "my_robot/__pycache__/a.pyc", "elsewhere/b.txt"):
        path = tmp_path / "tab" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "tab"))
    (tmp_path / "mine.ZIP").write_bytes(packed())
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "laptop"))
    return tmp_path / "mine.ZIP"


def test_a_zip_of_a_tab_comes_to_a_laptop(mine, tmp_path):
    take_over(mine)
    kept = {path.relative_to(tmp_path / "laptop").as_posix() for path in (tmp_path / "laptop").rglob("*.*")}
    assert kept == {"my_robot/_rot_z.py", "results/figures/circle.png"}


def test_a_name_that_leads_out_of_the_folder_stays_inside(mine, tmp_path):
    with zipfile.ZipFile(mine, "a") as archive:
        archive.writestr("notebooks/results/../../../outside.txt", "no")
    take_over(mine)
    assert [path.parent for path in tmp_path.parent.glob("**/outside.txt")] == [tmp_path / "laptop" / "results"]


@pytest.mark.parametrize("content", [b"", b"no archive"])
def test_what_is_no_zip_is_said_in_a_sentence(content, tmp_path):
    (tmp_path / "a.zip").write_bytes(content)
    with pytest.raises(SystemExit, match=r"a\.zip' cannot be unpacked"):
        take_over(str(tmp_path / "a.zip"))


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(SystemExit, match=r"gone\.zip' cannot be unpacked: .*No such file"):
        take_over(tmp_path / "gone.zip")


def test_one_file_to_send_has_the_recordings_too(mine, tmp_path, monkeypatch, capsys):
    (tmp_path / "laptop" / "recordings").mkdir(parents=True)
    (tmp_path / "laptop" / "recordings" / "drive.csv").write_text("t,q1")
    monkeypatch.chdir(tmp_path)
    main()
    (sent,) = tmp_path.glob("ir50p_*.zip")
    assert "notebooks/recordings/drive.csv" in zipfile.ZipFile(sent).namelist() and str(sent) in capsys.readouterr().out
