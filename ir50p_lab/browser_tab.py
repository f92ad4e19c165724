"""The course in a browser tab (Pyodide, a Python without threads, processes and ports): what is different there.

The page's own drive keeps files, but a look at it takes 5 ms: the student's folder lies in memory, with a copy there.
"""

import functools
import logging
import shutil
import sys
from pathlib import Path

from ir50p_lab.errors import LabError

IN_BROWSER = sys.platform == "emscripten"
_LACKING = {
    "cv2": "measures pictures",
    "serial": "speaks to a board",
    **dict.fromkeys(("loky", "numba"), "makes sweeps quick"),
}


class NotInABrowserError(LabError, ImportError):
    """What a browser tab cannot do; the message says what can."""


def needs_more(what):
    """Raise the error of something that a tab cannot do."""
    raise NotInABrowserError(f"A browser tab cannot do this: {what}. On your machine, 'python3 -m ir50p_lab' can.")


class Lacking:
    """Asked last for a module: names what it would have been for."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        """None for a module that is merely not there."""
        if name in _LACKING:
            needs_more(f"{name}, which {_LACKING[name]}, is not loaded")
        if name in ("pandas", "sympy"):
            raise NotInABrowserError(f"Write 'import {name}' at the top of this cell and run it again.")


@functools.cache
def quick_home(drive):
    """The student's folder in memory, filled from the drive's once."""
    quick = Path.home() / "student"
    for name in ("results", "my_robot"):
        if (drive / name).is_dir():
            shutil.copytree(drive / name, quick / name, dirs_exist_ok=True)
    quick.mkdir(parents=True, exist_ok=True)
    return quick


if IN_BROWSER:
    sys.meta_path.append(Lacking)
    logging.getLogger("matplotlib.font_manager").setLevel("ERROR")  # it lists its fonts each time, in red
