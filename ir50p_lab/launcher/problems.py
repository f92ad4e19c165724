"""Every way in which the set-up can fail, as one line that says what to do next, by the table in problems.toml."""

import os
import platform
import re
import sys
import sysconfig
import tomllib
from pathlib import Path

_PYTHON = "py" if os.name == "nt" else "python3"
COMMAND = f"{_PYTHON} -m ir50p_lab"
#: Variables that tell pip and uv where and how to download, and folders where their files lie on the three systems.
_SETTINGS = r"(UV|PIP)_|(HTTPS?|ALL|NO)_PROXY$|SSL_CERT_(FILE|DIR)$|(REQUESTS|CURL)_CA_BUNDLE$"
_ROOTS = ("/etc", "/etc/xdg", "/Library/Application Support")
_HOME_ROOTS = ("", ".config", ".pip", "Library/Application Support")


class SetUpError(Exception):
    """Something that the person at the keyboard can put right; its text says how."""


class NoWheelError(SetUpError):
    """The index or the wheel folder answered, but has no file that fits this machine."""


def from_error(error, folder):
    """Turn an OSError or ImportError of the launcher itself into a SetUpError."""
    text = str(error).partition(": ")[0]  # without the path: that may have any words in it
    file = getattr(error, "filename", None) or ".venv"
    return _known(f"{type(error).__name__}: {text}", folder, file) or SetUpError(
        f"The operating system refused: {error}. Put that right, then run '{COMMAND}' again."
    )


def from_output(output, code, folder, log):
    """Turn what a failed installer or venv printed into a SetUpError."""
    # an index that lacks a package says so with 404; the next one may have it
    lines = [line.strip() for line in output.splitlines() if line.strip() and "404 Client Error" not in line]
    errors = [line for line in lines if re.match(r"(ERROR|error|Error|\w*Error):", line)]
    said = re.sub(r"^(ERROR|error|Error): *", "", (errors or lines or ["no output"])[-1]).rstrip(".")
    problem = _known("\n".join([*lines, f"exit code {code}"]), folder) or SetUpError(
        f"The set-up failed: {said}. All that was printed is in {log}; then run '{COMMAND}' again."
    )
    address = r"https?://[^\s'\"`<>),]+"
    addresses = re.findall(address, "\n".join(errors)) or re.findall(address, "\n".join(lines))
    tried = f" Address tried last: {_without_password(addresses[-1])}." if addresses else ""
    return type(problem)(f"{problem}{tried}{in_force(folder)}")


def in_force(folder):
    """Return a sentence on the settings and files of pip, uv and proxies that are in force; "" if there are none."""
    found = [
        f"{name}={_without_password(value)}"
        for name, value in sorted(os.environ.items())
        if value and re.match(_SETTINGS, name, re.IGNORECASE)
    ]
    roots = [os.environ.get("APPDATA", ""), os.environ.get("PROGRAMDATA", "")]
    roots += [os.environ.get("XDG_CONFIG_HOME", ""), os.environ.get("XDG_CONFIG_DIRS", "")]
    roots = [Path(root) for root in os.pathsep.join([*roots, *_ROOTS]).split(os.pathsep) if root]
    roots += [Path.home() / root for root in _HOME_ROOTS]
    files = [Path(folder, "uv.toml")]
    files += [root / name for root in roots for name in ("uv/uv.toml", "pip/pip.conf", "pip/pip.ini", "pip.conf")]
    found += [str(file) for file in dict.fromkeys(files) if file.is_file()]
    return f" Settings in force that could be the cause: {', '.join(found)}." if found else ""


def _without_password(text):
    return re.sub(r"//[^/@\s]+@", "//...@", text)


def _python_that_fits():
    """Which Python to use instead, "" if this one is right and something else is the cause."""
    machine = platform.machine().lower()
    if sys.maxsize < 2**32:
        return "This Python is a 32-bit one: use a 64-bit Python 3.11 to 3.14 from https://www.python.org/downloads/."
    if (platform.system(), machine) == ("Windows", "arm64"):
        return "On Windows on ARM use the x86-64 installer from https://www.python.org/downloads/."
    newest = (3, 13) if (platform.system(), machine) == ("Darwin", "x86_64") else (3, 14)
    if sys.version_info[:2] > newest:
        return f"Use Python 3.11 to {newest[0]}.{newest[1]} from https://www.python.org/downloads/."
    return "The set-up needs the packages of PyPI, or an index that has all of them."


def _known(text, folder, file=".venv"):
    """The error for the first problem of the table that shows in the text, or None."""
    for problem in tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))["problem"]:
        found = re.search("|".join(problem["signs"]), text)
        if found:
            advice = problem["advice"].format(
                folder=folder,
                file=file,
                name=found[found.lastindex or 0],
                fitting=_python_that_fits(),
                python=_PYTHON,
                command=COMMAND,
                version=sysconfig.get_python_version(),
                machine=f"Python {platform.python_version()} on {platform.system()} {platform.machine()}",
                wheels=os.environ.get("PIP_FIND_LINKS", "find-links of pip.conf"),
            )
            return NoWheelError(advice) if "no_wheel" in problem else SetUpError(advice)
    return None
