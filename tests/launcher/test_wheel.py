"""The wheel carries the course: from it alone a student's folder is made, once, and the launcher there takes over."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from ir50p_lab.home import PROJECT

CARRIED = [
    "ir50p_lab",
    "wheel_build",
    "notebooks",
    "data",
    "docs",
    *"environment.txt environment-test.txt pyproject.toml README.md LICENSE CITATION.cff AGENTS.md".split(),
]
BUILD = "import sys, course_wheel; print(course_wheel.build_wheel(sys.argv[1]))"


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The command of an environment that has nothing but the wheel."""
    source, room = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("room")
    leave = shutil.ignore_patterns("__pycache__", "node_modules", "results", "recordings")
    for name in CARRIED:
        one = PROJECT / name
        shutil.copytree(one, source / name, ignore=leave) if one.is_dir() else shutil.copy(one, source)
    (source / "notebooks" / "my_robot").mkdir(exist_ok=True)
    (source / "notebooks" / "my_robot" / "_rot_z.py").write_text("mine = True")
    path = {"PYTHONPATH": str(source / "wheel_build")}
    built = subprocess.run(
        [sys.executable, "-c", BUILD, str(room)], cwd=source, env=os.environ | path, capture_output=True, text=True
    )
    assert built.returncode == 0, built.stderr
    wheel = room / built.stdout.split()[-1]
    assert not any("my_robot/_rot_z" in name for name in zipfile.ZipFile(wheel).namelist())
    uv = [sys.executable, "-m", "uv", "--offline", "--quiet"]
    subprocess.run([*uv, "venv", "--python", sys.executable, str(room / "env")], check=True)
    scripts = room / "env" / ("Scripts" if os.name == "nt" else "bin")
    subprocess.run([*uv, "pip", "install", "--python", str(scripts / "python"), "--no-deps", str(wheel)], check=True)
    return shutil.which("ir50p-lab", path=str(scripts))


def run(program, folder, *arguments):
    variables = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.run([program, *arguments], cwd=folder, env=variables, capture_output=True, text=True, timeout=60)


def test_a_folder_is_made_once_and_the_launcher_there_takes_over(program, tmp_path):
    first = run(program, tmp_path, "--help")
    assert first.returncode == 0 and "Copying the course" in first.stdout and "set up .venv" in first.stdout, (
        first.stderr
    )
    folder = tmp_path / "ir50p-lab"
    assert all((folder / name).exists() for name in CARRIED)
    kept = folder / "notebooks" / "00_start_here.ipynb"
    kept.write_text("the student's")
    again = run(program, tmp_path, "setup", "--nonsense")
    assert "setup does not know '--nonsense'" in again.stderr and "Copying" not in again.stdout
    assert kept.read_text() == "the student's"
    assert "came without tests" in run(program, tmp_path, "test").stderr


def test_a_folder_of_something_else_is_left_alone(program, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("")
    done = run(program, tmp_path, "--to", "thesis", "--help")
    assert done.returncode == 1 and "name a new folder" in done.stderr
    assert [path.name for path in Path(tmp_path / "thesis").iterdir()] == ["chapter.tex"]
