"""The course in a browser tab (Pyodide, a Python without threads, processes and ports): what is different there.

The page's own drive keeps files, but a look at it takes 5 ms. So the student's folder is in memory, with a copy there.
"""

import asyncio
import functools
import importlib
import logging
import os
import secrets
import sys
import warnings
from importlib.machinery import PathFinder
from pathlib import Path

from ir50p_lab.errors import LabError

IN_BROWSER = sys.platform == "emscripten"
_LACKING = {
    "cv2": "measures pictures",
    "serial": "speaks to a board",
    **dict.fromkeys(("loky", "numba"), "makes sweeps quick"),
}
_TAKES_LONG = """<style>@keyframes ir50p-appears { to { max-height: 4em } }</style>
<div style="max-height: 0; overflow: hidden; animation: ir50p-appears 0s 10s forwards"><progress></progress>
This takes more than 10 s: a browser tab computes about fifty times more slowly than Python on your machine.
To stop the cell, choose <i>Kernel &gt; Restart Kernel</i>; what you wrote stays.</div>"""
WHEN_NEEDED = ("scipy", "pandas", "sympy")  # packages that the page fetches at their first import
_KEPT = ("results/**/*", "my_robot/**/*", "progress.json")


class NotInABrowserError(LabError, ModuleNotFoundError):
    """Something that a browser tab cannot do; the message says what can."""


def needs_more(what, module=None):
    """Raise the error for something that a tab cannot do. module: the one that would be needed."""
    said = f"A browser tab cannot do this: {what}. On your machine, 'python3 -m ir50p_lab' can."
    raise NotInABrowserError(said, name=module)


class Lacking:
    """An import hook, asked last: it fetches modules that can be fetched, and says for what the others are needed."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        """Return None for a module that is merely not there."""
        if name in _LACKING:
            needs_more(f"{name}, which {_LACKING[name]}, is not loaded", name)
        return _fetch_package(name) if name in WHEN_NEEDED else None


def _fetch_package(name):
    """Wait for a package of the page's; raises NotInABrowserError in a browser that cannot wait inside a cell."""
    try:
        from pyodide.ffi import can_run_sync, run_sync
    except ImportError:
        can_run_sync = bool
    if not can_run_sync():
        raise NotInABrowserError(f"Write 'import {name}' at the top of this cell and run it again.")
    run_sync(_loading(name))
    importlib.invalidate_caches()
    return PathFinder.find_spec(name)


def _loading(name):
    import pyodide_js

    return pyodide_js.loadPackage(name)


def _fetch_behind(result):
    """After the first cell: the largest package, which the first notebook does without."""
    _shell().events.unregister("post_run_cell", _fetch_behind)
    asyncio.get_event_loop().call_later(2, _loading, "scipy")  # s: what the cell shows comes first


def _show_while_it_runs(info):
    """Under the cell that begins: a bar that appears after 10 s, as nothing can be drawn while Python computes."""
    from IPython.display import HTML, display

    shown = display(HTML(_TAKES_LONG), display_id=True)

    def take_away(result):
        _shell().events.unregister("post_run_cell", take_away)
        shown.update(HTML(""))

    _shell().events.register("post_run_cell", take_away)


def _shell():
    return sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None


class Drive:
    """The page's drive next to the student's folder in memory; other notebooks, and the next visit, read the drive."""

    def __init__(self, drive, memory):
        self.drive, self.memory = drive, memory
        self.stamp, self.same = None, {}  # of the last writing seen; {file: its time in memory when both were equal}

    def fetch(self):
        """Copy to memory what another notebook has written; one look at the drive if there is nothing new."""
        mark = self.drive / ".written"
        stamp = mark.read_text("utf-8") if mark.is_file() else ""
        if stamp == self.stamp:
            return
        self.stamp = stamp
        for source in _files(self.drive):
            target = self.memory / source.relative_to(self.drive)
            content = source.read_bytes()
            if not target.is_file() or target.read_bytes() != content:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
            self.same[target] = target.stat().st_mtime_ns

    def keep(self):
        """Copy to the drive what is new in memory."""
        new = [path for path in _files(self.memory) if self.same.get(path) != path.stat().st_mtime_ns]
        for path in new:
            self.same[path] = path.stat().st_mtime_ns
            self._write(path.relative_to(self.memory), path.read_bytes())
        if new:
            self.stamp = secrets.token_hex(8)
            self._write(".written", self.stamp.encode())

    def _write(self, name, content):
        """In one step: writing over a file of the drive can hang."""
        target = self.drive / name
        target.parent.mkdir(parents=True, exist_ok=True)
        beside = target.with_name(f".{target.name}.new")
        beside.write_bytes(content)
        os.replace(beside, target)


def _files(folder):
    found = (path for pattern in _KEPT for path in folder.glob(pattern))
    return [path for path in found if path.is_file() and path.suffix != ".pyc" and path.name[0] != "."]


@functools.cache
def quick_home(drive):
    """Return the student's folder in memory, made equal to the drive's before each cell and copied back after it."""
    memory = Path.home() / "student"
    memory.mkdir(parents=True, exist_ok=True)
    copies = Drive(drive, memory)
    copies.fetch()
    if shell := _shell():
        shell.events.register("pre_run_cell", lambda info: copies.fetch())
        shell.events.register("post_run_cell", lambda result: copies.keep())
    return memory


if IN_BROWSER:
    sys.meta_path.append(Lacking)
    if shell := _shell():
        shell.events.register("post_run_cell", _fetch_behind)
        shell.events.register("pre_run_cell", _show_while_it_runs)
    logging.getLogger("matplotlib.font_manager").setLevel("ERROR")  # it lists its fonts each time, in red
    warnings.filterwarnings("ignore", "tqdm:disabling monitor")  # it is a thread; the bar moves without it
