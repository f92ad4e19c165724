"""A function taken out of the notebook: its own lines and the helpers of its cell, ready to stand in a file."""

import ast
import builtins
import dis
import importlib
import inspect
import linecache
import math
import re

import numpy as np

from ir50p_lab.course.checking.explain_error import ROOM
from ir50p_lab.course.checking.judge_text import CannotTake, check_allowed, plain_function
from ir50p_lab.course.checking.tasks import task as task_of_name
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.course.robot.source import GIVEN, Source

_BACK_DOORS = {"__import__", "eval", "exec", "compile", "open", "input", "getattr", "setattr", "globals", "vars"}


def extract(thing, name, earlier, given="", function_arguments=()):
    """Return the Source of a function or class as its cell has it.

    name: what it has to be called; earlier: names of the functions of `my_robot` that it may use. Lines of the cell
    that it does not need are left behind; given: text of helpers that it may use; function_arguments: names of the
    arguments that are functions. Raises CannotTake, which says why: another name, a variable or an import from
    elsewhere.
    """
    thing = inspect.unwrap(thing)
    called = getattr(thing, "__name__", "?")
    if str(getattr(thing, "__module__", "")).startswith("ir50p_lab"):
        raise CannotTake(f"this `{called}` is the course's own: write yours, with `def {name}(...)`")
    if called not in (name, "<lambda>"):
        raise CannotTake(f"the function has to be called `{name}`, yours is called `{called}`")
    notebook = getattr(plain_function(thing), "__globals__", {})
    return cut(cell_text(thing), name, earlier, given, function_arguments, notebook)


def cut(text, name, earlier, given="", function_arguments=(), notebook=()):
    """Return the Source of a function, cut out of the text of its cell or file, which is not run. See `extract`.

    notebook: variables of the notebook, {name: value}. Raises CannotTake.
    """
    text = given + re.sub(rf"\bmy_robot\.(?!{name}\b)(\w+)", r"\1", text)
    tree = ast.parse(text)
    offered = _definitions(tree)
    if name not in offered:
        raise CannotTake(f"the cell has to define `{name}`, with `def {name}(...)`")
    wanted, calls, queue = [], set(), [name]
    while queue:
        one = queue.pop(0)
        if one in offered:
            if offered[one] not in wanted:
                wanted.append(offered[one])
                queue += globals_of(offered[one])
        elif one in earlier:
            calls.add(one)
        elif one == "my_robot":
            raise CannotTake(f"it calls `my_robot.{name}`: that is the function you are about to write")
        elif one in ORDER:
            raise CannotTake(f"it calls `{one}`: this function has to do without it")
        elif one in _BACK_DOORS:
            raise CannotTake(f"it uses `{one}`: your robot stands on plain functions and NumPy alone")
        elif one not in GIVEN and not hasattr(builtins, one):
            notebook = dict(notebook)
            used = {part.id for part in ast.walk(offered[name]) if isinstance(part, ast.Name)}
            unused = [argument for argument in function_arguments if argument not in used]
            if unused and callable(notebook.get(one)):
                raise CannotTake(
                    f"it calls `{one}` of the notebook: it gets the function as its argument `{unused[0]}`"
                )
            raise CannotTake(_stranger(one, notebook, text))
    patches = [one for one in tree.body if re.match(r"(np|numpy|math)\.\w+ = ", ast.unparse(one))]
    check_allowed([*wanted, *patches])
    wanted.sort(key=lambda node: node.lineno)
    return Source(name, "\n\n\n".join(_lines(text, node) for node in wanted), tuple(sorted(calls)))


def compile_source(source, task):
    """Return the function of a Source, which sees NumPy, math and the earlier functions, not the notebook."""
    room = {"np": np, "numpy": np, "math": math}
    for name in source.calls:
        room[name] = student_package.load(name) if student_package.is_there(name) else task_of_name(name).reference
    file = f"{ROOM} {task.name}>"
    linecache.cache[file] = (len(source.text), None, source.text.splitlines(keepends=True), file)
    exec(compile(source.text, file, "exec"), room)
    return room[task.function]


def cell_text(thing):
    """Return the text of the cell in which a function was defined. Raises CannotTake."""
    code = getattr(plain_function(thing), "__code__", None)
    text = "".join(linecache.getlines(code.co_filename)) if code else ""
    if not text:
        raise CannotTake("its text cannot be found: define it in a cell of the notebook, with `def`")
    return text


def _definitions(tree):
    """The last definition of each name at the top of the cell: functions, classes, constants, imports."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            names = [one for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)]
            found |= {one.id: node for one in names}
        elif isinstance(node, ast.Import | ast.ImportFrom):
            found |= {alias.asname or alias.name.partition(".")[0]: node for alias in node.names}
            if node.names[0].name == "*" and node.module in GIVEN:
                found |= dict.fromkeys(dir(importlib.import_module(node.module)), node)
    return {name: node for name, node in found.items() if name not in GIVEN}


def globals_of(node):
    """Return the names that a definition looks up outside itself, as the compiler sees them."""
    names, codes = {}, [compile(ast.Module([node], []), "cell", "exec")]
    while codes:
        code = codes.pop()
        codes += [constant for constant in code.co_consts if hasattr(constant, "co_names")]
        names |= {
            step.argval: None for step in dis.get_instructions(code) if step.opname in ("LOAD_GLOBAL", "LOAD_NAME")
        }
    own = {getattr(node, "name", None), "__name__", "__module__", "__qualname__"}
    return [name for name in names if name not in own]


def _stranger(name, notebook, text):
    if name == "self":
        return "it uses `self` where it is not an argument: each function of a class begins with it"
    if re.search(rf"\bself\.{name}\b", text):
        return f"it uses `{name}` by itself: only what stands in `self` lasts from one function of a class to the next"
    value = notebook.get(name)
    if value is None and name not in notebook:
        return f"it uses `{name}`, which is defined nowhere"
    module = (getattr(value, "__module__", None) or getattr(value, "__name__", "")).partition(".")[0]
    if module == "numpy" or module == "math":
        return f"it uses `{name}` from another cell: write `np.{name}`, which is always there"
    if callable(value) and module == "ir50p_lab":
        return f"it calls `{name}`, the course's own: write that part yourself, with your earlier functions"
    if callable(value) or hasattr(value, "__file__"):
        return f"it uses `{name}` of the notebook: put it into the same cell, or write that part yourself"
    return f"it uses `{name}`, a variable of the notebook: a function takes what it needs as arguments"


def _lines(text, node):
    first = min([node.lineno, *(decorator.lineno for decorator in getattr(node, "decorator_list", []))])
    return "\n".join(text.splitlines()[first - 1 : node.end_lineno])
