"""The doctor: every line of its report, its verdict and its exit code."""

import io
import json
import platform
import subprocess
import sys
from types import SimpleNamespace

import pytest

from ir50p_lab.launcher import doctor, inventory
from ir50p_lab.launcher.environment import Environment


def report(project, **options):
    """(exit code, report, verdict) of the doctor within this process."""
    stream = io.StringIO()
    code = doctor.report(Environment(project.root), stream=stream, **options)
    lines = stream.getvalue().splitlines()
    return code, stream.getvalue(), lines[-1]


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
    for text in ("System ", "Project ", ".venv: ready", "2 of 2 as in environment.txt", "pebble 1.0", "GB"):
        assert text in done.stdout
    assert done.stdout.splitlines()[-1] == "Verdict: ready. Open the lab book with 'python3 -m ir50p_lab'."


FOUND = {
    "python": "3.12.1",
    "executable": "python",
    "project": "0.1.0",
    "packages": [{"name": "pebble", "wanted": "1.0", "installed": "1.0"}],
    "ports": [],
}


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({"packages": [{"name": "pebble", "wanted": "1.0", "installed": None}]}, "1 packages are missing"),
        ({"packages": [{"name": "pebble", "wanted": "1.0", "installed": "2.0"}]}, "1 packages differ from the lock"),
        ({"project": None}, "the lab book itself is not installed"),
    ],
)
def test_damaged_environment(made, monkeypatch, change, verdict):
    monkeypatch.setattr(doctor, "_look_inside", lambda environment: FOUND | change)
    code, text, last = report(made)
    assert code == 1
    assert verdict in last
    assert last.endswith("Run 'python3 -m ir50p_lab setup --rebuild'.")
    assert ("missing: " in text) or ("differs: pebble 2.0, the lock has 1.0" in text)


def test_environment_that_does_not_answer(made, monkeypatch):
    monkeypatch.setattr(doctor.inventory, "__file__", str(made.root / "gone.py"))
    code, _, last = report(made)
    assert code == 1
    assert "the environment does not answer" in last


def test_here_reports_on_the_running_python(project, monkeypatch):
    monkeypatch.setattr(inventory, "collect", lambda lock: FOUND | {"packages": [{**FOUND["packages"][0]}]})
    assert report(project, here=True)[0] == 0
    other = [{"name": "pebble", "wanted": "1.0", "installed": "1.1"}]
    monkeypatch.setattr(inventory, "collect", lambda lock: FOUND | {"packages": other})
    code, text, _ = report(project, here=True)
    assert code == 0  # a hub has its own versions
    assert "differs: pebble 1.1, the lock has 1.0" in text
    monkeypatch.setattr(inventory, "collect", lambda lock: FOUND | {"project": None})
    code, _, last = report(project, here=True)
    assert code == 1
    assert "--here' prints the command" in last


def test_serial_ports(made, monkeypatch):
    ports = [
        {"device": "/dev/null", "usb": "2341:0043", "description": "Arduino Uno"},
        {"device": "/dev/null", "usb": "2A03:0042", "description": "Arduino (www.arduino.org)"},
        {"device": "/dev/not-there", "usb": "1A86:7523", "description": "USB serial"},
        {"device": "/dev/ttyS0", "usb": None, "description": "ttyS0"},
    ]
    monkeypatch.setattr(doctor, "_look_inside", lambda environment: FOUND | {"ports": ports})
    _, text, _ = report(made)
    assert "/dev/null 2341:0043 Arduino Uno\n" in text
    assert "/dev/null 2A03:0042 Arduino (www.arduino.org) (Arduino Mega 2560)\n" in text
    assert "/dev/not-there 1A86:7523 USB serial (CH340 chip, as on clones of the Mega), no permission: " in text
    assert "ttyS0" not in text
    monkeypatch.setattr(doctor, "_look_inside", lambda environment: FOUND | {"ports": ports[3:]})
    assert "no USB board (1 ports without USB id)" in report(made)[1]


def test_arm_file_that_is_not_there(made, monkeypatch):
    monkeypatch.setenv("IR50P_ARM", "nowhere.toml")
    code, text, last = report(made)
    assert code == 1
    assert "nowhere.toml (from IR50P_ARM)" in text
    assert "IR50P_ARM names a file that does not exist (nowhere.toml)" in last


def test_little_disk_matters_before_the_setup_only(made, project, monkeypatch):
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda path: SimpleNamespace(free=3e8))
    assert "the set-up needs 2 GB of disk, 0.3 GB are free" in report(project)[2]
    assert report(made)[0] == 0


def test_not_the_projects_folder(project):
    (project.root / "environment.txt").unlink()
    code, _, last = report(project)
    assert code == 1
    assert "environment.txt is missing" in last


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


def test_markers_with_pips_packaging_and_with_none(monkeypatch):
    monkeypatch.setitem(sys.modules, "packaging.markers", None)
    assert inventory._applies("python_version >= '3'")
    assert not inventory._applies("python_version < '3'")
    monkeypatch.setitem(sys.modules, "pip._vendor.packaging.markers", None)
    assert inventory._applies("python_version < '3'")  # nobody to ask: assume it applies


def test_serial_ports_as_pyserial_sees_them(monkeypatch):
    from serial.tools import list_ports, list_ports_common

    board = list_ports_common.ListPortInfo("/dev/ttyACM0")
    board.vid, board.pid, board.description = 0x2341, 0x43, "Arduino Uno"
    plain = list_ports_common.ListPortInfo("/dev/ttyS0")
    monkeypatch.setattr(list_ports, "comports", lambda: [plain, board])
    assert inventory.serial_ports() == [
        {"device": "/dev/ttyACM0", "usb": "2341:0043", "description": "Arduino Uno"},
        {"device": "/dev/ttyS0", "usb": None, "description": "n/a"},
    ]
    monkeypatch.setitem(sys.modules, "serial.tools", None)
    assert inventory.serial_ports() is None


def test_inventory_as_a_script(tmp_path):
    lock = tmp_path / "lock.txt"
    lock.write_text("pytest==0.1\n")
    done = subprocess.run([sys.executable, "-P", inventory.__file__, str(lock)], capture_output=True, encoding="utf-8")
    assert json.loads(done.stdout)["packages"][0]["installed"] == pytest.__version__
    assert set(json.loads(done.stdout)) == set(inventory.collect(lock))
