"""What this Python has: packages beside what a lock file asks for, and the serial ports.

Also runs as a script inside .venv, for the doctor: ``python inventory.py LOCK_FILE`` prints all of it as JSON.
"""

import importlib.metadata
import json
import platform
import re
import sys
from pathlib import Path


def packages(lock):
    """List the packages that the lock file asks of this Python: name, wanted and installed version (or None)."""
    found = []
    for line in Path(lock).read_text("utf-8").splitlines():
        match = re.match(r"([A-Za-z0-9._-]+)==([^\s;]+)\s*(?:;\s*(.*))?$", line)
        if match and _applies(match[3]):
            found.append({"name": match[1], "wanted": match[2], "installed": installed_version(match[1])})
    return found


def installed_version(name):
    """Version of an installed package, None if it is not there."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def serial_ports():
    """Serial ports with USB vendor and product, or None when pyserial is not there to look."""
    try:
        from serial.tools import list_ports
    except ImportError:
        return None
    return [
        {
            "device": port.device,
            "usb": None if port.vid is None else f"{port.vid:04X}:{port.pid:04X}",
            "description": port.description or "",
        }
        for port in sorted(list_ports.comports())
    ]


def _applies(marker):
    """Whether an environment marker ('sys_platform == "win32"') holds here; without pip or packaging: assume so."""
    if not marker:
        return True
    try:
        from packaging.markers import Marker
    except ImportError:
        try:
            from pip._vendor.packaging.markers import Marker
        except ImportError:
            return True
    return Marker(marker).evaluate()


def collect(lock):
    """Everything at once, ready for JSON."""
    return {
        "python": platform.python_version(),
        "executable": sys.executable,
        "project": installed_version("ir50p-lab"),
        "packages": packages(lock),
        "ports": serial_ports(),
    }


if __name__ == "__main__":
    json.dump(collect(sys.argv[1]), sys.stdout)
