"""The project's own environment, the folder .venv: is it ready for these lock files? If not, it is built.

The set-up writes its stamp last and removes it first. So a .venv without a valid stamp is half made, whatever
interrupted it, and is emptied and built again.
"""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from ir50p_lab.launcher import inventory
from ir50p_lab.launcher.file_lock import take_lock
from ir50p_lab.launcher.installer import Installer, clock
from ir50p_lab.launcher.problems import COMMAND

LOCK = "environment.txt"
TEST_LOCK = "environment-test.txt"

_FIRST_RUN = """import ir50p_lab
try:
    from ir50p_lab import bench, controllers, modelling, signals, simulation
    pid = controllers.PID(kp=1, limit_pwm=255)
    simulation.simulate(modelling.IR50P, pid, (0, 1, -1), duration=0.1, period=0.01)
    with bench.SimulatedBench(modelling.IR50P, record_to=False) as simulated:
        simulated.follow(pid, signals.hold((0, 0, 0)), 0.1)
except ImportError:  # what cannot be used is named by the check
    pass"""
_BUSY = "ir50p_lab-setup.lock"
_NOT_MADE = "not made yet"
#: Of another Python, and where pip should put what it installs.
UNWANTED = set(
    "PYTHONDONTWRITEBYTECODE PYTHONHOME PYTHONPATH PYTHONSTARTUP PYTHONWARNINGS __PYVENV_LAUNCHER__ "
    "PIP_TARGET PIP_PREFIX PIP_ROOT PIP_USER".split()
)


class Environment:
    """The folder .venv of the project in `root`, and everything the launcher does with it."""

    def __init__(self, root):
        self.root = Path(root).resolve()
        self.folder = self.root / ".venv"
        self.scripts = self.folder / ("Scripts" if os.name == "nt" else "bin")
        self.python = self.scripts / ("python.exe" if os.name == "nt" else "python")
        self.log = self.folder / "ir50p_lab-setup.log"
        self._stamp = self.folder / "ir50p_lab-setup.json"

    def fault(self, *, tests=False):
        """Return why .venv, or its test tools, cannot be used as it is; "" if it is ready. Changes nothing."""
        if not any(self.folder.glob("*")):
            return _NOT_MADE
        ready = self._ready_stamp(tests=True)
        try:
            stamp = json.loads(self._stamp.read_text("utf-8"))
            reasons = {
                "root": f"made for another folder ({stamp['root']})",
                "python": f"made with Python {stamp['python']}, this is {ready['python']}",
                LOCK: f"out of date ({LOCK} has changed)",
            }
        except (OSError, ValueError, LookupError, TypeError):
            return "half made (a set-up was interrupted)"
        for name, reason in reasons.items():
            if stamp[name] != ready[name]:
                return reason
        try:
            self._run([self.python, "-c", ""]).check_returncode()
        except (OSError, subprocess.CalledProcessError):
            return "broken (its Python does not start)"
        return f"without the tools of {TEST_LOCK}" if tests and stamp[TEST_LOCK] != ready[TEST_LOCK] else ""

    def ensure(self, *, tests=False, rebuild=False):
        """Make .venv ready, build what is missing, and print what happens. Raises SetUpError, OSError, ImportError."""
        fault = self.fault(tests=tests)
        if not rebuild and not fault:
            return
        self.folder.mkdir(exist_ok=True)
        with open(self.folder / _BUSY, "a") as lock:
            take_lock(lock, "Another set-up is at work in this folder: waiting for it to end (Ctrl-C to give up).")
            if rebuild or self.fault():  # again: another set-up may just have finished
                self._build(fault, Installer(self, lock), TEST_LOCK if tests else LOCK)
            elif self.fault(tests=tests):
                self._stamp.unlink()
                self._install_lock("[1/1] test tools of", Installer(self, lock), TEST_LOCK)
            else:
                return
            self._stamp.write_text(json.dumps(self._ready_stamp(tests), indent=1), encoding="utf-8")
            print("Set-up finished.")

    def variables(self):
        """Return the environment variables for programs that run inside .venv.

        Those that bring in another Python's packages, or make other people's warnings fatal, are left out; so is the
        one that container images set: without bytecode each notebook would compile its libraries again, for seconds.
        """
        variables = {name: value for name, value in os.environ.items() if name not in UNWANTED}
        variables["VIRTUAL_ENV"] = str(self.folder)
        variables["PATH"] = str(self.scripts) + os.pathsep + variables.get("PATH", "")
        # Kernels and settings of .venv come before those in the home folder: 'python3' is this Python.
        variables["JUPYTER_PREFER_ENV_PATH"] = "1"
        return variables

    def look_inside(self, *, here=False):
        """Run the inventory with the Python of .venv, or with `here` by this one, with its variables as they are.

        Returns (what it found or None, last line of its errors).
        """
        command = [sys.executable if here else self.python, "-P", inventory.__file__, self.root / LOCK]
        done = self._run(command, dict(os.environ) if here else None)
        try:
            return json.loads(done.stdout), ""
        except ValueError:
            return None, (done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1]

    # -- building ------------------------------------------------------------------------------------------------------

    def _build(self, fault, installer, lock_file):
        if fault not in ("", _NOT_MADE):
            print(f"The folder .venv is {fault}: building it again.")
        print(f"Set-up of {self.folder}: takes a minute or two, once. Ctrl-C stops it safely.")
        importlib.import_module("ensurepip")  # without it venv fails halfway and does not say why
        importlib.import_module("venv")
        self._empty()
        print(f"[1/5] Python {sysconfig.get_python_version()} environment")
        # Not sys.executable: when that is the .venv being rebuilt, it is gone by now. The module venv refuses links.
        installer.run([sys._base_executable, "-m", "venv", str(self.folder.resolve())])
        self._install_lock("[2/5] packages of", installer, lock_file)
        print("[3/5] the lab book itself")
        # Editable, so that notebooks anywhere import the package as it is here; the build tool is in the lock.
        installer.install("--no-deps", "--no-build-isolation", "--editable", str(self.root))
        print("[4/5] the simulated arm is compiled, once")
        installer.run([str(self.python), "-P", "-c", _FIRST_RUN])  # from anywhere
        print("[5/5] check: everything is imported, once")
        with clock():
            found, error = self.look_inside()
        for name, why in (found["broken"] if found else {"the set-up's last step": error}).items():
            print(f"Careful: {name} cannot be used ({why}). '{COMMAND} doctor' says more.")
        # Spare the student JupyterLab's question about news from the web at its first start.
        labconfig = self.folder / "etc/jupyter/labconfig"
        shutil.copytree(Path(__file__).with_name("labconfig"), labconfig, dirs_exist_ok=True)

    def _install_lock(self, step, installer, lock_file):
        print(step, lock_file)
        text = self._text(lock_file)
        uv = re.search(r"^uv==\S+", text, re.MULTILINE)[0]
        installer.fetch_uv(uv)
        rest = self.folder / lock_file
        rest.write_text(text.replace(uv, ""), encoding="utf-8")
        # Ready-made packages only: nobody should need a compiler.
        installer.install("--only-binary", ":all:", "--requirement", str(rest))

    def _empty(self):
        """Remove what is in .venv, stamp first; the folder itself (it may be a link to another disk) stays."""
        self._stamp.unlink(missing_ok=True)
        for entry in self.folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                shutil.rmtree(entry)
            elif entry.name != _BUSY:
                entry.unlink()

    # -- looking -------------------------------------------------------------------------------------------------------

    def _ready_stamp(self, tests):
        """What a finished set-up leaves behind."""
        return {
            "root": str(self.root),
            "python": sysconfig.get_python_version(),
            LOCK: self._text(LOCK),
            TEST_LOCK: self._text(TEST_LOCK) if tests else None,
        }

    def _text(self, lock_file):
        return (self.root / lock_file).read_text("utf-8")  # line ends may differ between checkouts

    def _run(self, command, variables=None):
        """Run a Python to its end; without `variables` with nothing of another Python around it."""
        variables = variables or self.variables()
        return subprocess.run(command, env=variables, capture_output=True, encoding="utf-8", errors="replace")
