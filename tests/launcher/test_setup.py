"""The set-up from end to end: first time, again, with the test tools. After changes and interruptions: hostile_setups.py."""

import errno
import fcntl
import json
import os
import subprocess
import sys

import pytest
from mini_project import PROJECT

from ir50p_lab.launcher.environment import _FIRST_RUN, Environment
from ir50p_lab.launcher.file_lock import take_lock
from ir50p_lab.launcher.installer import Installer
from ir50p_lab.launcher.problems import SetUpError

IMPORT_BOTH = "import pebble, ir50p_lab; print(ir50p_lab.__file__)"


def test_first_setup_says_what_it_does_and_makes_the_package_importable_anywhere(made):
    for step in ("[1/5]", "[2/5] packages of environment.txt", "[3/5]", "[4/5]", "[5/5]", "Set-up finished"):
        assert step in made.first.stdout
    assert "-m', 'uv', 'pip', 'install'" in made.log()
    assert made.python(IMPORT_BOTH).stdout.strip() == str(made.root / "ir50p_lab" / "__init__.py")


def test_the_imports_of_the_check_compile_what_is_used(made):
    assert made.variables()["PYTHONDONTWRITEBYTECODE"] == "1"  # as container images set it
    assert list(made.venv.glob("[Ll]ib/**/__pycache__/pebble.*.pyc"))


def test_a_wrong_setting_does_not_stop_the_setup(tmp_path, monkeypatch):
    """What is wrong is told where it is used."""
    for name, wrong in {"IR50P_UNIT": "seven", "IR50P_SEED": "-", "IR50P_ARM": "nowhere.toml"}.items():
        monkeypatch.setenv(name, wrong)
    environment = Environment(PROJECT)
    environment.log = tmp_path / "log"
    with open(tmp_path / "lock", "w") as lock:
        Installer(environment, lock).run([sys.executable, "-P", "-c", _FIRST_RUN])  # raises SetUpError


def test_second_setup_does_nothing(made):
    before = made.stamp.stat().st_mtime_ns
    done = made.run("setup")
    assert done.stdout == f"Ready: {made.venv}\n"
    assert made.stamp.stat().st_mtime_ns == before


def test_test_tools_are_added_in_place_and_stay(tested):
    before, _, after = tested.log().partition("environment-test.txt")
    assert "pebble-test" not in before and "pebble-test" in after  # the first set-up did not bring them
    assert "[1/1] test tools of environment-test.txt" in tested.added.stdout
    assert tested.python("import pebble, pebble_test").returncode == 0
    assert tested.run("setup").stdout.startswith("Ready")
    assert tested.run("setup", "--tests").stdout.startswith("Ready")


def test_states_that_need_a_rebuild(made, monkeypatch):
    made_here = Environment(made.root)
    assert made_here.fault() == ""
    stamp = made.stamp.read_text()
    without_tests = json.loads(stamp) | {"environment-test.txt": None}
    try:
        made.stamp.write_text(json.dumps(without_tests))
        assert made_here.fault() == ""  # the test tools alone are no reason to build it again
        assert made_here.fault(tests=True) == "without the tools of environment-test.txt"
        for damage in ("", "[]", "{}", stamp[: len(stamp) // 2]):
            made.stamp.write_text(damage)
            assert made_here.fault().startswith("half made"), damage
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"root": "/elsewhere"}))
        assert made_here.fault() == "made for another folder (/elsewhere)"
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"environment.txt": "old"}))
        assert made_here.fault() == "out of date (environment.txt has changed)"
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"python": "3.10"}))
        assert made_here.fault().startswith("made with Python 3.10")
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"environment-test.txt": "old"}))
        assert made_here.fault() == ""
        assert made_here.fault(tests=True) == "without the tools of environment-test.txt"
    finally:
        made.stamp.write_text(stamp)
    monkeypatch.setattr(made_here, "python", made.root / "gone")
    assert made_here.fault() == "broken (its Python does not start)"


def test_line_ends_of_a_checkout_do_not_matter(made):
    lock = made.root / "environment.txt"
    text = lock.read_bytes()
    try:
        lock.write_bytes(text.replace(b"\n", b"\r\n"))
        assert Environment(made.root).fault() == ""
    finally:
        lock.write_bytes(text)


def test_variables_of_other_pythons_do_not_leak_in(made, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", "/opt/ros/python")
    monkeypatch.setenv("PYTHONHOME", "/nowhere")
    variables = Environment(made.root).variables()
    assert "PYTHONPATH" not in variables
    assert "PYTHONHOME" not in variables
    assert variables["PATH"].split(os.pathsep)[0] == str(Environment(made.root).scripts)
    assert variables["JUPYTER_PREFER_ENV_PATH"] == "1"


def test_drives_without_locks_are_set_up_all_the_same(tmp_path, monkeypatch):
    def no_locks(descriptor, operation):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(fcntl, "flock", no_locks)
    with open(tmp_path / "lock", "a") as file:
        take_lock(file)  # comes back


def test_an_error_while_building_releases_the_lock(project, monkeypatch):
    environment = Environment(project.root)
    monkeypatch.setattr(environment, "_build", lambda *arguments: (_ for _ in ()).throw(SetUpError("stop")))
    with pytest.raises(SetUpError, match="stop"):
        environment.ensure()
    code = "import fcntl, sys; fcntl.flock(open(sys.argv[1], 'a'), fcntl.LOCK_EX | fcntl.LOCK_NB)"
    command = [sys.executable, "-c", code, str(project.venv / "ir50p_lab-setup.lock")]
    assert subprocess.run(command).returncode == 0
