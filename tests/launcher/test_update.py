"""What a student has in an older copy of the course is taken over; nothing is overwritten, edited notebooks are named."""

import json
import os
import shutil

import pytest

from ir50p_lab.launcher.commands import ROOT
from ir50p_lab.launcher.problems import SetUpError
from ir50p_lab.launcher.update import take_over


@pytest.fixture
def old(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "home"))
    notebooks = tmp_path / "older" / "notebooks"
    notebooks.mkdir(parents=True)
    for path in sorted((ROOT / "notebooks").glob("*.ipynb"))[:2]:
        shutil.copy(path, notebooks)
    (notebooks / "my_robot").mkdir()
    (notebooks / "my_robot" / "_rot_z.py").write_text("def rot_z(angle): ...\n")
    (tmp_path / "older" / "progress.json").write_text('{"done": {"pid-3": "2026-01-01T10:00"}}')
    return tmp_path / "older"


def test_what_is_the_students_comes_along(old, tmp_path, capsys):
    edited = sorted((old / "notebooks").glob("*.ipynb"))[0]
    notebook = json.loads(edited.read_text(encoding="utf-8"))
    notebook["cells"][1]["source"] = ["my_own = 1"]
    edited.write_text(json.dumps(notebook), encoding="utf-8")
    assert take_over([str(old)], ROOT) == 0
    out = capsys.readouterr().out
    assert f"You had changed: {edited.name}\n" in out
    assert (tmp_path / "home" / "old" / edited.name).read_bytes() == edited.read_bytes()
    assert (tmp_path / "home" / "my_robot" / "_rot_z.py").exists()
    assert "pid-3" in (tmp_path / "home" / "progress.json").read_text()


def test_what_is_there_already_stays(old, tmp_path, capsys):
    mine = tmp_path / "home" / "my_robot" / "_rot_z.py"
    mine.parent.mkdir(parents=True)
    mine.write_text("newer\n")
    take_over([str(old)], ROOT)
    assert mine.read_text() == "newer\n"
    assert f"Left as it is here: {mine}" in capsys.readouterr().out


@pytest.mark.skipif(os.name == "nt", reason="permission bits and links of POSIX")
def test_from_a_copy_that_is_read_only_with_a_dangling_link(old, tmp_path):
    (old / "notebooks" / "my_robot" / "gone.py").symlink_to("nowhere")
    (old / "notebooks" / "my_robot").chmod(0o555)
    try:
        take_over([str(old)], ROOT)
    finally:
        (old / "notebooks" / "my_robot").chmod(0o755)
    assert (tmp_path / "home" / "my_robot" / "_rot_z.py").exists()
    assert (tmp_path / "home" / "my_robot").stat().st_mode & 0o200


@pytest.mark.parametrize("arguments", [[], ["nowhere"], [str(ROOT)]])
def test_a_folder_without_a_course_is_refused(arguments):
    with pytest.raises(SetUpError):
        take_over(arguments, ROOT)


def test_the_notebooks_that_ship_are_known():
    """After a notebook was changed, its hash joins the list: python tests/launcher/notebook_hashes.py."""
    from ir50p_lab.launcher.update import notebook_hash

    known = set((ROOT / "data" / "notebook_hashes.txt").read_text().split())
    unknown = [path.name for path in (ROOT / "notebooks").glob("*.ipynb") if notebook_hash(path) not in known]
    assert not unknown, f"run python tests/launcher/notebook_hashes.py: {unknown}"
