"""The project's own environment, the folder .venv: is it ready for these lock files, and if not, build it.

The set-up writes its stamp last and removes it first. A .venv without a valid stamp is therefore half made, whatever
interrupted it, and is emptied and built again.
"""

import hashlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ir50p_lab.file_lock import take_lock
from ir50p_lab.launcher import inventory, problems
from ir50p_lab.launcher.installer import Installer
from ir50p_lab.launcher.problems import COMMAND, SetUpError

LOCK = "environment.txt"
TEST_LOCK = "environment-test.txt"
#: Space that .venv and uv's cache take, GB (measured on Linux: see README.md).
NEEDED_GB = 2.0

_STAMP = "ir50p_lab-setup.json"
_LOG = "ir50p_lab-setup.log"
_BUSY = "ir50p_lab-setup.lock"

_UNWANTED = (
    "PYTHONDONTWRITEBYTECODE",
    "PYTHONHOME",
    "PYTHONPATH",
    "PYTHONSTARTUP",
    "PYTHONWARNINGS",
    "__PYVENV_LAUNCHER__",
)


@dataclass(frozen=True)
class EnvironmentState:
    """Whether .venv can be used, why not, and whether it must be built from nothing."""

    ready: bool
    reason: str
    rebuild: bool = False


class Environment:
    """The folder .venv of the project in `root`, and everything the launcher does with it."""

    def __init__(self, root):
        self.root = Path(root).resolve()
        self.folder = self.root / ".venv"
        self.scripts = self.folder / ("Scripts" if os.name == "nt" else "bin")
        self.python = self.scripts / ("python.exe" if os.name == "nt" else "python")
        self.log = self.folder / _LOG

    def state(self, *, tests=False):
        """Look, without changing anything."""
        if not self.folder.exists():
            return EnvironmentState(False, "not made yet", rebuild=True)
        stamp = self._read_stamp()
        if stamp is None:
            return EnvironmentState(False, "half made (a set-up was interrupted)", rebuild=True)
        changed = {name: stamp[name] for name, value in self._stamp(tests=True).items() if stamp[name] != value}
        if "root" in changed:
            return EnvironmentState(False, f"made for another folder ({stamp['root']})", rebuild=True)
        if "python" in changed:
            return EnvironmentState(
                False, f"made with Python {stamp['python']}, this is {_python_version()}", rebuild=True
            )
        if LOCK in changed:
            return EnvironmentState(False, f"out of date ({LOCK} has changed)", rebuild=True)
        if not self._python_works():
            return EnvironmentState(False, "broken (its Python does not start)", rebuild=True)
        if tests and TEST_LOCK in changed:
            return EnvironmentState(
                False, "without the test tools" if stamp[TEST_LOCK] is None else f"behind {TEST_LOCK}"
            )
        return EnvironmentState(True, "ready")

    def ensure(self, *, tests=False, rebuild=False, stream=None):
        """Make .venv ready, building what is not; say on `stream` what happens. Raises SetUpError."""
        stream = stream or sys.stdout
        self._check_project()
        if not rebuild and self.state(tests=tests).ready:
            return
        try:
            with self._only_one(stream) as lock:
                state = self.state(tests=tests)  # again: another set-up may just have finished
                if state.ready and not rebuild:
                    return
                started = time.monotonic()
                if rebuild or state.rebuild:
                    self._build(state, tests, stream, lock)
                else:
                    (self.folder / _STAMP).unlink()
                    self._install_lock(TEST_LOCK, "[1/1] test tools of", stream, lock)
                self._write_stamp(tests)
                _say(stream, f"Set-up finished in {time.monotonic() - started:.0f} s.")
        except OSError as error:
            raise problems.from_os_error(error, self.root) from error

    def variables(self):
        """Environment variables for programs that run inside .venv."""
        variables = _clean_variables()
        variables["VIRTUAL_ENV"] = str(self.folder)
        variables["PATH"] = str(self.scripts) + os.pathsep + variables.get("PATH", "")
        # Kernels and settings of .venv come before those in the home folder: 'python3' is this Python.
        variables["JUPYTER_PREFER_ENV_PATH"] = "1"
        return variables

    def look_inside(self, python=None):
        """Run the inventory with the Python of .venv, or another: (what it found or None, last line of its errors)."""
        command = [str(python or self.python), "-P", inventory.__file__, str(self.root / LOCK)]
        variables = _clean_variables() if python else self.variables()
        done = subprocess.run(command, env=variables, capture_output=True, encoding="utf-8", errors="replace")
        try:
            return json.loads(done.stdout), ""
        except ValueError:
            return None, (done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1]

    # -- building ------------------------------------------------------------------------------------------------------

    def _build(self, state, tests, stream, lock):
        if not state.ready and self._has_content():
            _say(stream, f"The folder .venv is {state.reason}: building it again.")
        else:
            _say(stream, f"Set-up of {self.folder}: takes a minute or two, once. Ctrl-C stops it safely.")
        free = shutil.disk_usage(self.root).free / 1e9
        if free < NEEDED_GB:
            _say(stream, f"Only {free:.1f} GB are free; the set-up may need {NEEDED_GB:.0f} GB.")
        for module in ("venv", "ensurepip"):
            if not _has_module(module):
                raise problems.problem("no_ensurepip", self.root, module)
        self._empty()
        _say(stream, f"[1/4] Python {_python_version()} environment")
        self._run_venv()
        installer = self._install_lock(TEST_LOCK if tests else LOCK, "[2/4] packages of", stream, lock)
        _say(stream, "[3/4] the lab book itself")
        # Editable, so that notebooks anywhere import the package as it is here; the build tool is in the lock.
        installer.install("--no-deps", "--no-build-isolation", "--editable", str(self.root))
        _say(stream, "[4/4] check: everything is imported once")
        self._check(stream)
        self._quieten_jupyter()

    def _install_lock(self, lock_file, step, stream, lock):
        """Install what a lock file asks for; return the installer."""
        _say(stream, f"{step} {lock_file}")
        path = self.root / lock_file
        installer = Installer(self.python, self.variables(), folder=self.root, log=self.log, lock=lock, stream=stream)
        text = path.read_text("utf-8")
        uv = re.search(r"^uv==\S+", text, re.MULTILINE)
        if uv and not installer.fetch_uv(uv[0]):
            path = self.folder / lock_file
            path.write_text(text.replace(uv[0], ""), encoding="utf-8")
        # Ready-made packages only: nobody should need a compiler.
        installer.install("--only-binary", ":all:", "--requirement", str(path))
        return installer

    def _empty(self):
        """Remove what is in .venv, stamp first; the folder itself (it may be a link to another disk) stays."""
        (self.folder / _STAMP).unlink(missing_ok=True)
        try:
            for entry in self.folder.iterdir():
                if entry.name == _BUSY:
                    continue
                if entry.is_dir() and not entry.is_symlink():
                    shutil.rmtree(entry)
                else:
                    entry.unlink()
        except PermissionError as error:
            if os.name != "nt":
                raise
            raise SetUpError(
                f"{self.folder} is in use and cannot be rebuilt: close JupyterLab and every program that runs Python "
                f"from it, then run '{COMMAND}' again."
            ) from error

    def _run_venv(self):
        # Not sys.executable: when that is the .venv being rebuilt, it is gone by now. The module venv refuses links.
        base = getattr(sys, "_base_executable", None) or sys.executable
        done = subprocess.run(
            [base, "-m", "venv", str(self.folder.resolve())],
            env=_clean_variables(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
        )
        if done.returncode:
            self.log.write_text(done.stdout, encoding="utf-8")
            raise problems.from_output(done.stdout, done.returncode, self.root, self.log)

    def _check(self, stream):
        """The package and all it needs must be importable from anywhere."""
        command = [str(self.python), "-P", "-c", "import ir50p_lab"]
        if subprocess.run(command, env=self.variables(), capture_output=True, cwd=self.folder).returncode:
            raise SetUpError(
                f"The path {self.root} has letters that this Python cannot read when it starts. Move the project to a "
                f"folder whose path has plain letters only (or use Python 3.13 or newer), then run '{COMMAND}' again."
            )
        found, error = self.look_inside()
        broken = {"the set-up's last step": error} if found is None else found["broken"]
        for name, why in broken.items():
            _say(stream, f"Careful: {name} cannot be used ({why}). '{COMMAND} doctor' says more.")

    def _quieten_jupyter(self):
        """Spare the student JupyterLab's question about news from the web at its first start."""
        settings = self.folder / "etc" / "jupyter" / "labconfig" / "page_config.json"
        settings.parent.mkdir(parents=True, exist_ok=True)
        disabled = {"@jupyterlab/apputils-extension:announcements": True}
        settings.write_text(json.dumps({"disabledExtensions": disabled}), encoding="utf-8")

    # -- the stamp -----------------------------------------------------------------------------------------------------

    def _stamp(self, tests):
        """What a finished set-up leaves behind."""
        return {
            "root": str(self.root),
            "python": _python_version(),
            LOCK: self._digest(LOCK),
            TEST_LOCK: self._digest(TEST_LOCK) if tests else None,
        }

    def _write_stamp(self, tests):
        path = self.folder / _STAMP
        part = path.with_suffix(".part")
        part.write_text(json.dumps(self._stamp(tests), indent=1), encoding="utf-8")
        os.replace(part, path)  # all of it or nothing

    def _read_stamp(self):
        try:
            stamp = json.loads((self.folder / _STAMP).read_text("utf-8"))
            return stamp if {"root", "python", LOCK, TEST_LOCK} <= stamp.keys() else None
        except (OSError, ValueError, AttributeError):
            return None

    def _digest(self, lock_file):
        text = (self.root / lock_file).read_text("utf-8")  # as text: line ends may differ between checkouts
        return hashlib.sha256(text.encode()).hexdigest()

    # -- looking -------------------------------------------------------------------------------------------------------

    def _check_project(self):
        for name in (LOCK, TEST_LOCK, "pyproject.toml"):
            if not (self.root / name).is_file():
                raise SetUpError(
                    f"{self.root} is not the project's folder: it has no {name}. Run '{COMMAND}' in the folder that "
                    "was cloned or unpacked."
                )
        if (self.folder.is_symlink() and not self.folder.exists()) or self.folder.is_file():
            raise SetUpError(f"{self.folder} is not a folder: remove it, then run '{COMMAND}' again.")

    def _has_content(self):
        return any(entry.name != _BUSY for entry in self.folder.iterdir())

    def _python_works(self):
        try:
            command = [str(self.python), "-c", ""]
            return subprocess.run(command, env=_clean_variables(), capture_output=True).returncode == 0
        except OSError:
            return False

    @contextmanager
    def _only_one(self, stream):
        """Hold a lock while .venv is being built; yields its file descriptor (None where locks are not to be had)."""
        self.folder.mkdir(exist_ok=True)
        with open(self.folder / _BUSY, "a") as file:
            try:
                if not take_lock(file, wait=False):
                    _say(stream, "Another set-up is at work in this folder: waiting for it to end (Ctrl-C to give up).")
                    take_lock(file, wait=True)
            except OSError:  # some network drives have no locks: go on without
                yield None
                return
            yield file.fileno()


def _has_module(name):
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _python_version():
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def _clean_variables():
    """Environment variables without those that bring in another Python's packages or make warnings of others fatal.

    Nor the one that container images set: without bytecode each notebook compiles its libraries again, for seconds.
    """
    return {name: value for name, value in os.environ.items() if name not in _UNWANTED}


def _say(stream, text):
    print(text, file=stream, flush=True)
