"""Every way the set-up can fail, as one line that says what to do next: by the table in problems.toml."""

import os
import platform
import re
import sysconfig
import tomllib
from pathlib import Path

_PYTHON = "py" if os.name == "nt" else "python3"
COMMAND = f"{_PYTHON} -m ir50p_lab"


class SetUpError(Exception):
    """Something the person at the keyboard can put right; its text says how."""


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
    return _known("\n".join([*lines, f"exit code {code}"]), folder) or SetUpError(
        f"The set-up failed: {said}. All that was printed is in {log}; then run '{COMMAND}' again."
    )


def _known(text, folder, file=".venv"):
    """The error for the first problem of the table that shows in the text, or None."""
    for problem in tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))["problem"]:
        found = re.search("|".join(problem["signs"]), text)
        if found:
            advice = problem["advice"].format(
                folder=folder,
                file=file,
                name=found[found.lastindex or 0],
                python=_PYTHON,
                command=COMMAND,
                version=sysconfig.get_python_version(),
                machine=f"Python {platform.python_version()} on {platform.system()} {platform.machine()}",
                wheels=os.environ.get("PIP_FIND_LINKS", "find-links of pip.conf"),
            )
            return NoWheelError(advice) if "no_wheel" in problem else SetUpError(advice)
    return None
