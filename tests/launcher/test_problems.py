"""Every failure is one line that says what to do next: each provoked for real where that is possible."""

import ast
import ctypes
import errno
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from mini_project import PROJECT, one_line

from ir50p_lab.launcher import commands, problems

# -- Python too old --------------------------------------------------------------------------------------------------------


def test_too_old_python_says_so_and_where_to_get_a_newer_one():
    # This Python calls itself 3.6 before the launcher starts.
    pretend = "import runpy, sys; sys.version_info = (3, 6, 15); runpy.run_module('ir50p_lab', run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", pretend], cwd=PROJECT, capture_output=True, encoding="utf-8")
    assert done.returncode == 1 and done.stdout == ""
    first, second = done.stderr.splitlines()
    assert first.startswith("The IR50P lab book needs Python 3.11 or newer; this is Python ")
    assert "https://www.python.org/downloads/" in second


def test_the_files_before_the_gate_parse_on_old_pythons():
    for name in ("__init__.py", "__main__.py"):
        text = (PROJECT / "ir50p_lab" / name).read_bytes()
        text.decode("ascii")  # Python 2 would ask for a coding line
        tree = ast.parse(text, feature_version=(3, 4))
        assert not [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr | ast.AnnAssign)]


# -- a Python without venv or ensurepip ------------------------------------------------------------------------------------

WITHOUT = """
import sys
class Without:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Without())
"""


@pytest.mark.parametrize("module", ["venv", "ensurepip"])
def test_missing_module_names_the_debian_package(project, tmp_path, module):
    (tmp_path / "sitecustomize.py").write_text(WITHOUT.format(module=module))  # imported by Python as it starts
    line = one_line(project.run("setup", variables={"PYTHONPATH": str(tmp_path)}))
    assert "came without its modules 'venv' and 'ensurepip'" in line
    assert f"apt install python{sys.version_info.major}.{sys.version_info.minor}-venv" in line
    assert not (project.venv / "pyvenv.cfg").exists()


# -- no permission, disk full (in the middle of pip, and without network: hostile_setups.py) -------------------------------


def obey_permissions():
    """In the child: even root (in a container) must respect the permission bits: Linux capability CAP_DAC_OVERRIDE off."""
    if os.geteuid() == 0:
        assert ctypes.CDLL(None, use_errno=True).prctl(24, 1, 0, 0, 0) == 0  # PR_CAPBSET_DROP


@pytest.mark.skipif(os.name == "nt", reason="permission bits of POSIX")
def test_no_write_permission(project):
    project.root.chmod(0o555)
    try:
        line = one_line(project.run("setup", preexec_fn=obey_permissions))
    finally:
        project.root.chmod(0o755)
    assert line.startswith(f"No permission to write in {project.root}.")
    assert "Move the project into your home folder" in line


@pytest.mark.skipif(os.name == "nt", reason="permission bits of POSIX")
def test_ready_environment_needs_no_write_permission(made):
    made.root.chmod(0o555)
    try:
        done = made.run("setup", preexec_fn=obey_permissions)
    finally:
        made.root.chmod(0o755)
    assert done.returncode == 0, done.stderr


# -- the wrong folder ------------------------------------------------------------------------------------------------------


def test_project_without_its_lock_file(project):
    (project.root / "environment.txt").unlink()
    assert "is not the project's folder: it has no environment.txt" in one_line(project.run("setup"))


def test_a_file_in_the_place_of_the_environment(project):
    project.venv.write_text("")
    line = one_line(project.run("setup"))
    assert f"in the place of a folder: {project.venv}. Remove or rename it" in line


def test_words_in_a_path_are_no_sign_of_a_problem():
    for name in ("zip file", "HTTPError"):
        error = OSError(errno.EIO, os.strerror(errno.EIO), f"/home/{name}/lab")
        assert "refused" in str(problems.from_error(error, Path("lab")))


# -- what the programs print -----------------------------------------------------------------------------------------------


def printed():
    """(output, words of what is told) of each block of printed.txt."""
    blocks = re.split(r"\n(?=\S)", (Path(__file__).parent / "printed.txt").read_text("utf-8").rstrip("\n"))
    parts = [block.partition("\n") for block in blocks[1:]]  # behind the line that says what this is
    return [(re.sub("^    ", "", output, flags=re.MULTILINE), words) for words, _, output in parts]


@pytest.mark.parametrize(("output", "expected"), printed())
def test_what_pip_prints_becomes_one_line(output, expected):
    text = str(problems.from_output(output, 1, Path("lab"), Path("lab/log")))
    assert expected in text
    assert "\n" not in text
    assert problems.COMMAND in text or "https://" in text or "README.md" in text  # what to do next


def test_settings_in_force_are_named(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("UV_EXCLUDE_NEWER", "2024-01-01")
    monkeypatch.setenv("PIP_CONSTRAINT", "../two.txt")
    (tmp_path / "uv.toml").touch()
    text = str(problems.from_output("ERROR: No matching distribution found for basalt==2.0", 1, tmp_path, "log"))
    for setting in ("UV_EXCLUDE_NEWER=2024-01-01", "PIP_CONSTRAINT=../two.txt", str(tmp_path / "uv.toml")):
        assert setting in text
    assert "64-bit" not in text


@pytest.mark.parametrize(
    ("variable", "file"),
    [
        ("XDG_CONFIG_HOME", "uv/uv.toml"),
        ("XDG_CONFIG_DIRS", "pip/pip.conf"),
        ("PROGRAMDATA", "pip/pip.ini"),
        ("HOME", "Library/Application Support/pip/pip.conf"),
    ],
)
def test_files_of_settings_are_found_where_each_system_has_them(tmp_path, monkeypatch, variable, file):
    monkeypatch.setenv(variable, str(tmp_path))
    (tmp_path / file).parent.mkdir(parents=True)
    (tmp_path / file).touch()
    assert str(tmp_path / file) in problems.in_force("lab")


def test_a_32_bit_python_is_told_to_be_one(monkeypatch):
    monkeypatch.setattr(problems.sys, "maxsize", 2**31 - 1)
    error = problems.from_output("ERROR: No matching distribution found for basalt==2.0", 1, Path("lab"), Path("log"))
    assert "This Python is a 32-bit one: use a 64-bit Python 3.11 to 3.14" in str(error)


def test_another_end_of_uv_is_no_missing_package():
    """Only code 1 is uv's for 'no such package'."""
    said = "error: Failed to install: basalt-2.0-py3-none-any.whl (basalt==2.0)\n  cause: something new"
    error = problems.from_output(said, 2, Path("lab"), Path("log"))
    assert not isinstance(error, problems.NoWheelError) and "The set-up failed" in str(error)


def test_windows_on_arm_is_told_which_python(monkeypatch):
    monkeypatch.setattr(problems.platform, "system", lambda: "Windows")
    monkeypatch.setattr(problems.platform, "machine", lambda: "ARM64")
    said = "cause: Because opencv==5 has no usable wheels and you require opencv==5, we can conclude"
    text = str(problems.from_output(said, 1, Path("lab"), Path("log")))
    assert "on Windows ARM64" in text and "x86-64 installer" in text


def test_installer_ended_by_a_signal():
    assert "signal 9 (often: out of memory)" in str(problems.from_output("", -9, Path("lab"), Path("log")))


@pytest.mark.parametrize(
    ("number", "expected"),
    [(errno.ENOSPC, "The disk is full"), (errno.EACCES, "No permission"), (errno.EIO, "refused")],
)
def test_errors_of_the_system(number, expected):
    assert expected in str(problems.from_error(OSError(number, os.strerror(number)), Path("lab")))


def test_environment_that_cannot_be_emptied(project, monkeypatch, capsys):
    (project.venv / "lib").mkdir(parents=True)
    monkeypatch.setattr(shutil, "rmtree", lambda path: (_ for _ in ()).throw(PermissionError(13, "no")))
    assert commands.main(["setup"], root=project.root) == 1
    assert capsys.readouterr().err.startswith("No permission")
