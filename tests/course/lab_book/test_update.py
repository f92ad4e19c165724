"""What a student has in an older copy of the course is taken over; nothing is overwritten, edited notebooks are named."""

import json
import os
import shutil
import subprocess
import sys

import pytest

from ir50p_lab.course.lab_book.progress import read_progress, record
from ir50p_lab.course.lab_book.update import notebook_hash, take_over
from ir50p_lab.errors import InputError
from ir50p_lab.home import PROJECT


@pytest.fixture
def old(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "home"))
    notebooks = tmp_path / "older" / "notebooks"
    notebooks.mkdir(parents=True)
    for path in sorted((PROJECT / "notebooks").glob("*.ipynb"))[:2]:
        shutil.copy(path, notebooks)
    (notebooks / "my_robot").mkdir()
    (notebooks / "my_robot" / "_rot_z.py").write_text("def rot_z(angle): ...\n")
    (tmp_path / "older" / "progress.json").write_text(
        '{"done": {"pid-3": "2026-01-01T10:00", "dyn-3": "2026-01-01T11:00"}}'
    )
    return tmp_path / "older"


def test_what_is_the_students_comes_along(old, tmp_path, capsys):
    edited = sorted((old / "notebooks").glob("*.ipynb"))[0]
    notebook = json.loads(edited.read_text(encoding="utf-8"))
    notebook["cells"][1]["source"] = ["my_own = 1"]
    edited.write_text(json.dumps(notebook), encoding="utf-8")
    take_over(str(old))
    out = capsys.readouterr().out
    assert f"You had changed: {edited.name}\n" in out
    assert (tmp_path / "home" / "old" / edited.name).read_bytes() == edited.read_bytes()
    assert (tmp_path / "home" / "my_robot" / "_rot_z.py").exists()
    record("start-1")
    assert list(read_progress()) == ["dyn-3", "pid-3", "start-1"]  # dyn-3 is no exercise any more


def test_what_is_there_already_stays(old, tmp_path, capsys):
    mine = tmp_path / "home" / "my_robot" / "_rot_z.py"
    mine.parent.mkdir(parents=True)
    mine.write_text("newer\n")
    take_over(str(old))
    assert mine.read_text() == "newer\n"
    assert f"Left as it is here: {mine}" in capsys.readouterr().out


@pytest.mark.skipif(os.name == "nt", reason="permission bits and links of POSIX")
def test_from_a_copy_that_is_read_only_with_a_dangling_link(old, tmp_path):
    (old / "notebooks" / "my_robot" / "gone.py").symlink_to("nowhere")
    (old / "notebooks" / "my_robot").chmod(0o555)
    try:
        take_over(str(old))
    finally:
        (old / "notebooks" / "my_robot").chmod(0o755)
    assert (tmp_path / "home" / "my_robot" / "_rot_z.py").exists()
    assert (tmp_path / "home" / "my_robot").stat().st_mode & 0o200


@pytest.mark.parametrize("folder", ["nowhere", str(PROJECT)])
def test_a_folder_without_a_course_is_refused(folder):
    with pytest.raises(InputError, match="no older copy"):
        take_over(folder)


def test_the_command_without_a_folder():
    command = [sys.executable, "-m", "ir50p_lab.course.lab_book.update"]
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)
    assert done.returncode == 1 and done.stdout == ""
    assert "holds no older copy of the course: give its folder" in done.stderr and "Traceback" not in done.stderr


def test_the_notebooks_that_ship_are_known():
    """After a notebook was changed, its hash joins the list: python tests/course/lab_book/notebook_hashes.py."""
    known = set((PROJECT / "data" / "notebook_hashes.txt").read_text().split())
    unknown = [path.name for path in (PROJECT / "notebooks").glob("*.ipynb") if notebook_hash(path) not in known]
    assert not unknown, f"run python tests/course/lab_book/notebook_hashes.py: {unknown}"
