"""A hand-in as one text: `unknown_arm` and everything on which it rests, out of the cells of the notebook."""

import ast
import inspect
import re
from types import ModuleType

import numpy as np

from ir50p_lab import home
from ir50p_lab.course.checking.cell import cell_text, globals_of
from ir50p_lab.course.checking.judge_text import is_open
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.course.unknown import robot
from ir50p_lab.errors import InputError

NAME = "unknown_arm"


def hand_in(function):
    """Write `results/unknown_arm.py`, which is handed in and judged, and return its Path.

    function: of the notebook, called unknown_arm; what it calls comes along. Raises InputError if dots are left
    in it, or if it needs a thing that is neither a function nor plain numbers.
    """
    path = home.home() / "results" / f"{NAME}.py"
    path.parent.mkdir(parents=True, exist_ok=True)
    home.replace_text(path, text_of_hand_in(function))
    return path


def text_of_hand_in(function):
    """Return the text that `hand_in` writes."""
    if not inspect.isfunction(function) or function.__name__ != NAME:
        raise InputError(f"a hand-in is a function called `{NAME}`, of the bench; this is {function!r:.60}")
    if is_open(function):
        raise InputError(f"there are still dots in `{NAME}`: write it first")
    found, left = {}, {NAME: function}
    while left:
        name, value = left.popitem()
        found[name], needed = _written(name, value)
        left |= {one: needed[one] for one in needed if one not in found}
    return "\n\n".join(sorted(found.values(), key=lambda text: not text.startswith(("import", "from")))) + "\n"


def lent(text, folder):
    """Return the names of the functions in a race that are the course's, sorted: tuple of str.

    text: the hand-in, whose imports name those of the notebook. folder: where its `my_robot` lies; what the hand-in or
    the given code calls of it, and what is not there or on loan, is the course's.
    """
    given = re.findall(r"^from ir50p_lab\.course\.unknown\.notebook_functions import (\w+)", text, re.M)
    called = set(re.findall(r"\bmy_robot\.(\w+)", text + inspect.getsource(robot))) & set(ORDER)
    files = {name: folder / "my_robot" / f"_{name}.py" for name in called}
    theirs = {name for name, file in files.items() if file.is_file() and not file.read_bytes().startswith(b"# on loan")}
    return tuple(sorted({*given, *called} - theirs))


def _written(name, value):
    """The text that makes a name of the notebook, and what it needs of the notebook: {name: value}."""
    if isinstance(value, ModuleType):
        return f"import {value.__name__} as {name}", {}
    if inspect.isfunction(value) or inspect.isclass(value):
        if value.__module__ != "__main__":
            return f"from {value.__module__} import {value.__qualname__} as {name}", {}
        return _of_the_notebook(name, value)
    plain = value.tolist() if isinstance(value, np.ndarray) else value
    try:
        ast.literal_eval(repr(plain))
    except (ValueError, SyntaxError):
        raise InputError(
            f"`{NAME}` needs `{name}`, {value!r:.60}: hand it over as an argument, or make it inside"
        ) from None
    return f"{name} = np.array({plain!r})" if isinstance(value, np.ndarray) else f"{name} = {plain!r}", {}


def _of_the_notebook(name, value):
    function = next(filter(inspect.isfunction, vars(value).values())) if inspect.isclass(value) else value
    text = cell_text(value if inspect.isfunction(value) else function)
    kinds = ast.FunctionDef | ast.ClassDef
    node = [one for one in ast.parse(text).body if isinstance(one, kinds) and one.name == value.__name__][-1]
    known = function.__globals__
    needed = {one: known[one] for one in globals_of(node) if one in known}
    alias = "" if name == value.__name__ else f"\n\n\n{name} = {value.__name__}"
    return ast.get_source_segment(text, node) + alias, needed
