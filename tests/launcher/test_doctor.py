"""The doctor: every line of its report, its verdict and its exit code."""

import contextlib
import io
import platform

import pytest

from ir50p_lab.launcher import doctor, inventory
from ir50p_lab.launcher.environment import Environment


def report(project, found=None, **options):
    """(exit code, report, verdict) of the doctor within this process; found: in the place of what the inventory finds."""
    environment = Environment(project.root)
    if found:
        environment.look_inside = lambda here=False: (found, "")
    with contextlib.redirect_stdout(io.StringIO()) as said:
        code = doctor.report(environment, **options)
    return code, said.getvalue(), said.getvalue().splitlines()[-1]


def test_before_the_setup_it_says_so_and_makes_nothing(project):
    done = project.run("doctor")
    assert done.returncode == 1
    assert f"Python        {platform.python_version()}" in done.stdout
    assert "pyserial comes with the set-up" in done.stdout
    assert "Verdict: not ready: the environment is not made yet. Run 'python3 -m ir50p_lab' to set up." in done.stdout
    assert not project.venv.exists()


def test_ready(made):
    done = made.run("doctor", variables={"IR50P_ARM": None})
    assert done.returncode == 0, done.stdout
    for text in ("System ", "Project ", ".venv: ready", "2 of 2 as in environment.txt", "GB"):
        assert text in done.stdout
    assert done.stdout.splitlines()[-1] == "Verdict: ready. Open the lab book with 'python3 -m ir50p_lab'."


FOUND = {
    "python": "3.12.1",
    "project": "0.1.0",
    "packages": [{"name": "pebble", "wanted": "1.0", "installed": "1.0"}],
    "broken": {},
    "ports": [],
}


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({"packages": [{"name": "pebble", "wanted": "1.0", "installed": None}]}, "1 packages are missing"),
        ({"packages": [{"name": "pebble", "wanted": "1.0", "installed": "2.0"}]}, "1 packages differ from the lock"),
        ({"project": None}, "the lab book itself is not installed"),
        ({"broken": {"pebble": "ImportError: no"}}, "pebble cannot be imported"),
    ],
)
def test_damaged_environment(made, change, verdict):
    code, text, last = report(made, FOUND | change)
    assert code == 1
    assert verdict in last
    assert last.endswith("Run 'python3 -m ir50p_lab setup --rebuild'.")
    assert "differs: pebble 2.0, the lock has 1.0" in text or "differ" not in text


def test_a_package_that_is_there_but_does_not_work(made):
    (module,) = made.venv.glob("[Ll]ib/**/pebble.py")
    text = module.read_text()
    try:
        module.write_text("import numpy_of_another_version\n")
        done = made.run("doctor")
        assert done.returncode == 1
        assert "broken: import pebble: ModuleNotFoundError: No module named 'numpy_of" in done.stdout
        module.write_text("import os\nos._exit(3)\n")  # as a crash in machine code
        done = made.run("doctor")
        assert done.returncode == 1
        assert "the environment does not answer (ended with code 3)" in done.stdout
    finally:
        module.write_text(text)


def test_here_reports_on_the_running_python(project):
    assert report(project, FOUND, here=True)[0] == 0
    other = [{"name": "pebble", "wanted": "1.0", "installed": "1.1"}]
    code, text, _ = report(project, FOUND | {"packages": other}, here=True)
    assert code == 0  # a hub has its own versions
    assert "differs: pebble 1.1, the lock has 1.0" in text
    code, _, last = report(project, FOUND | {"project": None}, here=True)
    assert code == 1
    assert "--here' prints the command" in last


def test_here_a_path_of_python_is_the_first_to_blame(project, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", "/somewhere")
    code, text, last = report(project, FOUND | {"broken": {"pebble": "ImportError: no"}}, here=True)
    assert code == 1 and "PYTHONPATH=/somewhere (in force with --here)" in text
    assert "pebble cannot be imported. Unset PYTHONPATH" in last


def test_a_package_that_is_broken_is_named_and_not_all_that_needs_it(monkeypatch):
    monkeypatch.setattr(inventory, "_STARTED", ("no_such_package",))
    assert list(inventory.broken_imports([])) == ["no_such_package"]


def test_serial_ports(made):
    ports = [
        {"device": "/dev/null", "vid": 0x2341, "pid": 0x0043, "description": "Arduino Uno"},
        {"device": "/dev/null", "vid": 0x2A03, "pid": 0x0042, "description": "Arduino (www.arduino.org)"},
        {"device": "/dev/not-there", "vid": 0x1A86, "pid": 0x7523, "description": "USB serial"},
        {"device": "/dev/ttyS0", "vid": None, "pid": None, "description": "ttyS0"},
    ]
    _, text, _ = report(made, FOUND | {"ports": ports})
    assert "/dev/null 2341:0043 Arduino Uno\n" in text
    assert "/dev/null 2A03:0042 Arduino (www.arduino.org) (Arduino Mega 2560)\n" in text
    assert "/dev/not-there 1A86:7523 USB serial (CH340 chip, as on clones of the Mega), no permission: " in text
    assert "ttyS0" not in text
    assert "no USB board" in report(made, FOUND | {"ports": ports[3:]})[1]


def test_arm_file_that_is_not_there(made, monkeypatch):
    monkeypatch.setenv("IR50P_ARM", "nowhere.toml")
    code, text, last = report(made)
    assert code == 1
    assert "nowhere.toml (from IR50P_ARM)" in text
    assert "IR50P_ARM names a file that does not exist (nowhere.toml)" in last


def test_arm_file_counts_from_the_project(made, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("IR50P_ARM", ' "data/arm_example.toml" ')
    code, text, _ = report(made)
    assert code == 0 and "Arm           data/arm_example.toml (from IR50P_ARM)" in text


# -- the inventory ---------------------------------------------------------------------------------------------------------


def test_packages_of_a_lock_file(tmp_path):
    lock = tmp_path / "lock.txt"
    lock.write_text(
        "# a comment\npytest==0.1\nno-such-package==2.0 ; python_version >= '3'\nwindows-only==1 ; os_name == 'never'\n"
    )
    assert inventory.packages(lock) == [
        {"name": "pytest", "wanted": "0.1", "installed": pytest.__version__},
        {"name": "no-such-package", "wanted": "2.0", "installed": None},
    ]
