"""What this Python has: its packages compared with a lock file, which of them can be imported, serial ports.

It also runs as a script inside .venv: ``python inventory.py LOCK_FILE`` prints all of it as JSON. The imports compile
the bytecode of what the course uses, so that the first notebook need not.
"""

import contextlib
import importlib.metadata
import json
import pkgutil
import platform
import re
import sys
import tomllib
from pathlib import Path

#: Imported beside the direct dependencies: what JupyterLab and its kernels start with.
_STARTED = ("jupyterlab.labapp", "ipykernel.kernelapp")


def packages(lock):
    """Return the packages that the lock file asks of this Python: name, wanted and installed version (or None).

    uv is left out: it is for the set-up only and does not exist for every machine.
    """
    found = []
    for line in Path(lock).read_text("utf-8").splitlines():
        match = re.match(r"([A-Za-z0-9._-]+)==([^\s;]+)\s*(?:;\s*(.*))?$", line)
        if match and match[1] != "uv" and _applies(match[3]):
            found.append({"name": match[1], "wanted": match[2], "installed": installed_version(match[1])})
    return found


def installed_version(name):
    """Return the version of an installed package, or None if it is not there."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def direct_dependencies(root):
    """Return the names of the packages that pyproject.toml asks for."""
    with open(Path(root) / "pyproject.toml", "rb") as file:
        dependencies = tomllib.load(file)["project"]["dependencies"]
    return [re.split(r"[<>=!~ ]", dependency)[0] for dependency in dependencies if not dependency.startswith("uv")]


def broken_imports(distributions):
    """Import what the distributions hold, and every module of the lab book: {module: why it cannot be imported}.

    The modules are imported only if everything else can be; otherwise what they need is named already.
    """
    names = [
        name
        for name, sources in importlib.metadata.packages_distributions().items()
        if set(sources) & set(distributions) and not name.startswith("_")
    ]
    broken = {}
    for name in [*names, *_STARTED]:
        _try_import(name, broken)
    for module in pkgutil.walk_packages([] if broken else _try_import("ir50p_lab", broken), "ir50p_lab."):
        if not module.name.endswith("__main__"):
            _try_import(module.name, broken)
    return broken


def _try_import(name, broken):
    """Import a module; return where its submodules are."""
    try:
        return getattr(importlib.import_module(name), "__path__", [])
    except BaseException as error:  # whatever a damaged package raises
        broken[name] = f"{type(error).__name__}: {error}".splitlines()[0]
        return []


def serial_ports():
    """Return the serial ports as pyserial describes them (device, vid, pid...), or None if pyserial is missing."""
    try:
        from serial.tools import list_ports
    except ImportError:
        return None
    return [vars(port) for port in sorted(list_ports.comports())]


def _applies(marker):
    """Whether an environment marker ('sys_platform == "win32"') holds here; without pip to ask: assume so."""
    try:
        from pip._vendor.packaging.markers import Marker
    except ImportError:
        return True
    return not marker or Marker(marker).evaluate()


if __name__ == "__main__":
    lock = Path(sys.argv[1])
    with contextlib.redirect_stdout(sys.stderr):  # whatever an import prints
        found = {
            "python": platform.python_version(),
            "project": installed_version("ir50p-lab"),
            "packages": packages(lock),
            "broken": broken_imports(direct_dependencies(lock.parent)),
            "ports": serial_ports(),
        }
    json.dump(found, sys.stdout)
