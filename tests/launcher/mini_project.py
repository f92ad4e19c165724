"""A project in miniature: the real launcher, two tiny lock files and a folder of wheels, so that no network is needed."""

import base64
import hashlib
import importlib.metadata
import os
import re
import shutil
import signal
import subprocess
import sys
import zipfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PYPROJECT = """
[build-system]
requires = ["flit-core>=3.10"]
build-backend = "flit_core.buildapi"
[project]
name = "ir50p-lab"
description = "miniature"
dynamic = ["version"]
dependencies = ["pebble>=1"]
[tool.flit.module]
name = "ir50p_lab"
"""


class MiniProject:
    """A copy of the launcher in a folder of its own, run as a person would."""

    def __init__(self, root, wheels):
        self.root = root
        self.wheels = wheels
        self.venv = root / ".venv"
        self.stamp = self.venv / "ir50p_lab-setup.json"
        (root / "ir50p_lab").mkdir(parents=True)
        package = PROJECT / "ir50p_lab"
        for name in ("__init__.py", "__main__.py", "home.py", "browser_tab.py", "errors.py"):
            shutil.copy(package / name, root / "ir50p_lab")
        shutil.copytree(package / "launcher", root / "ir50p_lab" / "launcher", ignore=shutil.ignore_patterns("*.pyc"))
        tools = "".join(f"{name}=={importlib.metadata.version(name)}\n" for name in ("flit-core", "uv"))
        (root / "pyproject.toml").write_text(PYPROJECT)
        (root / "environment.txt").write_text(f"# a comment\n{tools}pebble==1.0\nghost==1 ; python_version < '3'\n")
        (root / "environment-test.txt").write_text(f"{tools}pebble==1.0\npebble-test==1.0\n")
        (root / "notebooks").mkdir()
        (root / "tests").mkdir()

    @property
    def interpreter(self):
        """The Python of .venv."""
        return self.venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")

    def variables(self, **changes):
        """Return an environment in which pip knows nothing but the wheel folder, Python no folder but its own.

        None takes a variable away.
        """
        left_out = ("PIP_", "COV_", "PYTHONPATH")
        variables = {name: value for name, value in os.environ.items() if not name.startswith(left_out)}
        variables |= {"PIP_CONFIG_FILE": os.devnull, "PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(self.wheels)}
        variables |= {"PYTHONDONTWRITEBYTECODE": "1"}
        variables |= {name: value for name, value in changes.items() if value is not None}
        return {name: value for name, value in variables.items() if changes.get(name, "") is not None}

    def command(self, *arguments):
        return [sys.executable, "-m", "ir50p_lab", *arguments]

    def run(self, *arguments, variables=None, **options):
        """Run the launcher to its end; warnings of the launcher itself are errors."""
        return subprocess.run(
            self.command(*arguments),
            cwd=options.pop("cwd", self.root),
            env=self.variables(**(variables or {})),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            timeout=300,
            **options,
        )

    def start(self, *arguments, variables=None):
        """Start the launcher in a process group of its own, as a terminal does."""
        return subprocess.Popen(
            self.command(*arguments),
            cwd=self.root,
            env=self.variables(**(variables or {})),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            start_new_session=True,
            # pytest started in the background ignores Ctrl-C, and children inherit that
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )

    def log(self):
        """What the installers were told and what they said."""
        return (self.venv / "ir50p_lab-setup.log").read_text("utf-8")

    def python(self, code):
        """Run code with the Python of .venv."""
        command = [str(self.interpreter), "-P", "-c", code]
        return subprocess.run(
            command, env=self.variables(), capture_output=True, encoding="utf-8", cwd=self.root / "notebooks"
        )


def one_line(process):
    """The launcher failed with one line on stderr and no traceback; return it."""
    assert process.returncode == 1, process.stdout + process.stderr
    assert "Traceback" not in process.stdout + process.stderr
    lines = process.stderr.strip().splitlines()
    assert len(lines) == 1, process.stderr
    return lines[0]


def repack(folder, name):
    """Write the wheel that an installed distribution came from."""
    distribution = importlib.metadata.distribution(name)
    tag = re.search(r"^Tag: (.+)$", distribution.read_text("WHEEL"), re.MULTILINE)[1]
    with zipfile.ZipFile(folder / f"{name.replace('-', '_')}-{distribution.version}-{tag}.whl", "w") as wheel:
        for file in distribution.files:
            script = f"{name}-{distribution.version}.data/scripts/{file.name}"
            if file.suffix != ".pyc" and file.name not in ("INSTALLER", "REQUESTED"):
                wheel.write(file.locate(), script if ".." in file.parts else str(file))


def write_wheel(folder, name, files):
    """Write a wheel by hand: its files, metadata and the record of both."""
    info = f"{name}-1.0.dist-info"
    files = files | {
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name.replace('_', '-')}\nVersion: 1.0\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: hand\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    record = "".join(f"{path},sha256={_digest(text)},{len(text)}\n" for path, text in files.items())
    with zipfile.ZipFile(folder / f"{name}-1.0-py3-none-any.whl", "w") as wheel:
        for path, text in (files | {f"{info}/RECORD": record + f"{info}/RECORD,,\n"}).items():
            wheel.writestr(path, text)


def _digest(text):
    return base64.urlsafe_b64encode(hashlib.sha256(text.encode()).digest()).rstrip(b"=").decode()
