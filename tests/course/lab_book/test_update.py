"""What a student has in an older copy of the course is taken over; nothing is overwritten, what stays behind is named."""

import os
import subprocess
import sys

import pytest

from ir50p_lab.course.lab_book.update import take_over
from ir50p_lab.home import PROJECT

_OWN = ("my_robot/_rot_z.py", "results/lab_book.json", "recordings/drive.csv", "progress.json")


@pytest.fixture
def older(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "home"))
    notebooks = tmp_path / "older" / "notebooks"
    for name in (*_OWN, "01_rotations.ipynb"):
        (notebooks / name).parent.mkdir(parents=True, exist_ok=True)
        (notebooks / name).write_text(f'"{name}"')
    return notebooks


def test_what_is_the_students_comes_along(older, tmp_path, capsys):
    take_over(str(older.parent))
    for name in (*_OWN, "old/01_rotations.ipynb"):
        assert (tmp_path / "home" / name).read_text() == f'"{name.removeprefix("old/")}"'
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 3 and ": 5 files" in said[0] and said[2].endswith(": none")


def test_what_is_there_already_stays_and_is_named(older, tmp_path, capsys):
    take_over(str(older.parent))
    mine = tmp_path / "home" / "my_robot" / "_rot_z.py"
    mine.write_text("newer\n")
    take_over(str(older.parent))
    assert mine.read_text() == "newer\n"
    assert f"different here: {older / 'my_robot' / '_rot_z.py'}\n" in capsys.readouterr().out


def test_a_notebook_that_cannot_be_read_is_named(older, tmp_path, monkeypatch, capsys):
    def refuse(path, target):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("shutil.copyfile", refuse)
    take_over(str(older.parent))
    assert "01_rotations.ipynb" in capsys.readouterr().out.splitlines()[2]


@pytest.mark.parametrize("content", [b"", b"\0" * 4096, b"<<<<<<< HEAD\n{}", b'{"cells": ['])
def test_a_notebook_that_holds_none_is_named_and_stays(older, tmp_path, capsys, content):
    (older / "01_rotations.ipynb").write_bytes(content)
    take_over(str(older.parent))
    assert "01_rotations.ipynb" in capsys.readouterr().out.splitlines()[-1]
    assert not (tmp_path / "home" / "old").exists()


@pytest.mark.skipif(os.name == "nt", reason="permission bits and links of POSIX")
def test_from_a_copy_that_is_read_only_with_a_dangling_link(older, tmp_path):
    (older / "my_robot" / "gone.py").symlink_to("nowhere")
    (older / "my_robot").chmod(0o555)
    try:
        take_over(str(older.parent))
    finally:
        (older / "my_robot").chmod(0o755)
    assert (tmp_path / "home" / "my_robot" / "_rot_z.py").exists()
    assert (tmp_path / "home" / "my_robot").stat().st_mode & 0o200


@pytest.mark.parametrize("folder", ["nowhere", str(PROJECT)])
def test_the_command_refuses_a_folder_without_an_older_course(folder):
    command = [sys.executable, "-m", "ir50p_lab.course.lab_book.update", folder]
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)
    assert done.returncode == 1 and done.stdout == ""
    assert "holds no older copy of the course: give its folder" in done.stderr and "Traceback" not in done.stderr
