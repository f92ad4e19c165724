"""A process group of its own for each student, inside bubblewrap where the system has it."""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from ir50p_lab.home import PROJECT, VARIABLE
from ir50p_lab.jit import cache_folder

STATES = "right", "wrong", "loan", "open"
SECONDS = 120  # for one student, by the clock
_WITH_CACHE = 'mkdir ~/.cache; cp -r "$0" ~/.cache; exec "$@"'  # into its empty home
ENDED = "its process ended, or did not end in time: an endless loop, or more memory than it may have?"


def isolation():
    """Return the sentence that says how the functions of the class are run."""
    if bubblewrap():
        return "Each student's functions run inside bubblewrap: no network, nothing of this machine written, limits."
    limits = "a limit of time" if os.name == "nt" else "limits of time, memory, processes and files"
    return f"bubblewrap is not available here: each student's functions run in a process of their own, with {limits}."


def bubblewrap(room=PROJECT):
    """Return the words that, put before a command, shut it in; [] if bubblewrap is missing or may not work.

    It reads all but the user's files, of which it reads this room alone. It has its own copy of the compiled code.
    """
    program = shutil.which("bwrap")
    if program is None:
        return []
    paths = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    shown = {sys.prefix, sys.base_prefix, str(PROJECT), str(room), *paths} - {""}
    words = [program, "--ro-bind", "/", "/", "--tmpfs", "/tmp", "--tmpfs", str(Path.home())]
    for path in sorted(map(os.path.realpath, shown)):
        words += ["--ro-bind", path, path]
    words += ["--dev", "/dev", "--proc", "/proc", "--unshare-all", "--die-with-parent", "--new-session"]
    words += ["sh", "-c", _WITH_CACHE, str(cache_folder())]
    return words if subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0 else []


def verdicts(functions, before, seconds=SECONDS):
    """Return {name: (state, sentence)} of {name: text}; before: the words of bubblewrap.

    A function that ends its process, or runs out of time, is wrong; those after it get a process of their own.
    """
    found, left = {}, dict(functions)
    while left:
        told = _run(left, before, seconds)
        found |= told
        left = {name: text for name, text in left.items() if name not in told}
        if left:
            name = next(iter(left))
            found[name] = ("wrong", ENDED)
            del left[name]
    return found


def _run(functions, before, seconds):
    """What a process says until it ends or is ended: {name: (state, sentence)}."""
    child = started(before, "inside", os.devnull)
    try:
        said, _ = child.communicate(json.dumps(functions).encode() + b"\n", timeout=seconds)
    except subprocess.TimeoutExpired:
        end(child)
        said, _ = child.communicate()  # what it said until then
    finally:
        end(child)
    try:
        lines = map(json.loads, said.splitlines())
        return {name: (state, says) for name, state, says in lines if name in functions and state in STATES}
    except (ValueError, TypeError):  # none of ours: it wrote into the channel of the verdicts
        return {}


def started(before, module, home, **more):
    """Return a module's process in a group of its own, with this home and one thread; it hears and speaks by pipes."""
    command = [*before, sys.executable, "-P", "-m", f"ir50p_lab.course.grading.{module}"]
    variables = os.environ | {VARIABLE: str(home), "OPENBLAS_NUM_THREADS": "1"}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    return subprocess.Popen(command, env=variables, start_new_session=True, **pipes, **more)


def end(child):
    """End a process and everything that it started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):  # it is gone already
        os.killpg(child.pid, signal.SIGKILL) if hasattr(os, "killpg") else child.kill()
