"""The folder `my_robot`: a plain Python package with what the student has written, importable without this one."""

import importlib.util
import sys
from datetime import datetime
from pathlib import Path

import cloudpickle
import numpy as np

from ir50p_lab import home
from ir50p_lab.course.robot.catalogue import ORDER, function_of
from ir50p_lab.course.robot.source import Source
from ir50p_lab.errors import LabError

_LOAN = "# on loan from the course"
_STAGE = ", stage "
_PACKAGE = "my_robot"
_import_state = {"stamp": None}
lookup_cache = {}  # what `my_robot` has just looked up; empty when a function was kept or put aside


def folder() -> Path:
    """Return where the student's functions are: `my_robot` in the student's folder."""
    return home.home() / "my_robot"


def path_of(name) -> Path:
    """Return the file of one function, whatever its stage; the underscore keeps module and function apart."""
    return folder() / f"_{function_of(name)}.py"


def read(path):
    """Return the text of a function's file. Raises LabError if another program has saved it in another encoding."""
    return home.read_text(path, LabError)


def is_there(name):
    """Return True if a function, or this stage of one, is in the folder, whether it is the student's or on loan."""
    if not path_of(name).exists():
        return False
    first = read(path_of(name)).partition("\n")[0]
    return first.partition(_STAGE)[2].split(":")[0] == (name if "." in name else "")


def whose(name):
    """Return whose a function is, or this stage of one: "yours", "on loan" or, if it is not there, "the course's"."""
    if not is_there(name):
        return "the course's"
    return "on loan" if read(path_of(name)).startswith(_LOAN) else "yours"


def keep(source, task, find, *, loan=""):
    """Write a function with its small test, and the list of what there is. What was there before goes to `old`.

    Functions that it calls and that are not there yet come along on loan; find: returns the Task of one by its name.
    Returns their names. Raises OSError; either all files of a function are written, or none.
    """
    folder().mkdir(parents=True, exist_ok=True)
    lent = []
    for name in source.calls:
        if not is_there(name):
            lent += [name, *lend(find(name), find)]
    stage = f"{_STAGE}{task.name}" if "." in task.name else ""
    head = f"{loan or '# yours'}{stage}: the next you write takes its place\n" if loan or stage else ""
    module, test, package = path_of(source.name), folder() / f"test_{source.name}.py", folder() / "__init__.py"
    texts = {module: head + source.module, test: task.test or _small_test(task), package: _exports(source.name)}
    before = {path: read(path) for path in texts if path.is_file()}
    try:
        for path, text in texts.items():
            _write(path, text)
        if module in before and before[module] != texts[module]:
            _lay_by(source.name, before[module])
    except OSError:
        for path in texts:
            _put_back(path, before.get(path))
        raise
    lookup_cache.clear()
    return lent


def lend(task, find):
    """Write the course's solution of a function, marked as on loan. Returns what else came along."""
    return keep(Source(task.function, task.solution_text, _calls(task)), task, find, loan=_LOAN)


def put_aside(name):
    """Move a function's file to `old`, with the time in its name; nothing is lost. Raises OSError."""
    path, name = path_of(name), function_of(name)
    if not path.exists():
        return
    _lay_by(name, read(path))
    path.unlink()
    (folder() / f"test_{name}.py").unlink(missing_ok=True)
    _write(folder() / "__init__.py", _exports())
    lookup_cache.clear()


def _lay_by(name, content):
    old = folder() / "old"
    old.mkdir(exist_ok=True)
    (old / f"{name}_{datetime.now():%Y-%m-%d_%H%M%S_%f}.py").write_text(content, encoding="utf-8")


def _put_back(path, content):
    """Make a file again what it was, None: not there."""
    if content is not None:
        path.write_text(content, encoding="utf-8")
    elif path.is_file():
        path.unlink()


def load(name):
    """Return the function from the folder, read again if a file has changed. Raises what is wrong in a file."""
    files = sorted(folder().glob("_*.py"))
    stamp = tuple((path.name, path.stat().st_mtime_ns, path.stat().st_size) for path in files)
    if _import_state["stamp"] != (folder(), stamp):
        for path in files:
            read(path)  # Python's own error would not name the file
        for module in [one for one in sys.modules if one.partition(".")[0] == _PACKAGE]:
            del sys.modules[module]
        spec = importlib.util.spec_from_file_location(
            _PACKAGE, folder() / "__init__.py", submodule_search_locations=[str(folder())]
        )
        package = importlib.util.module_from_spec(spec)
        sys.modules[_PACKAGE] = package
        spec.loader.exec_module(package)
        cloudpickle.register_pickle_by_value(package)  # another process has no such module
        _import_state["stamp"] = (folder(), stamp)
    return getattr(sys.modules[_PACKAGE], name)


def _calls(task):
    import re

    return tuple(sorted(one for one in task.leans_on if re.search(rf"\b{one}\(", task.solution_text)))


def _exports(more=""):
    names = [name for name in ORDER if name == more or path_of(name).exists()]
    return '"""My robot: the functions I wrote."""\n\n' + "".join(f"from ._{name} import {name}\n" for name in names)


def _small_test(task):
    """A test of one case, in plain numbers."""
    cases = task.cases()
    case = cases[min(1, len(cases) - 1)]
    arguments = ", ".join(_plain(value) for value in case)
    compared = (
        "    for one, other in zip(found, expected, strict=True):\n"
        "        np.testing.assert_allclose(one, other, atol=1e-6)\n"
        if task.results
        else "    found, expected = sorted(np.atleast_2d(found).tolist()), sorted(np.atleast_2d(expected).tolist())\n"
        "    np.testing.assert_allclose(found, expected, atol=1e-6)\n"
    )
    return (
        f"import numpy as np\nfrom numpy import array, inf, nan\n\nfrom my_robot import {task.name}\n\n\n"
        f"def test_{task.name}():\n    found = {task.name}({arguments})\n"
        f"    expected = {_plain(task.reference(*case))}\n{compared}"
    )


def _plain(value):
    """A value as Python reads it."""
    if isinstance(value, tuple):
        return "(" + "".join(f"{_plain(one)}, " for one in value) + ")"
    kind = f", dtype={str(value.dtype)!r}" if getattr(value, "dtype", float) not in (float, int, bool) else ""
    plain = repr(np.asarray(value).tolist())
    return f"array({plain}{kind})" if isinstance(value, np.ndarray) else plain


def _write(path, text):
    """Write a file in one step; Windows may hold the old one open for a moment."""
    import time

    for attempt in range(5):
        try:
            return home.replace_text(path, text)
        except PermissionError:
            if attempt == 4:
                raise
            time.sleep(0.05)
