"""A function taken out of the notebook: its own lines and the helpers of its cell, able to stand in a file."""

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
from ir50p_lab.course.checking.tasks import task as task_of_name
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.course.robot.source import GIVEN, Source

_ALLOWED = {"numpy", "math", "cmath", "collections", "dataclasses", "functools", "itertools", "operator", "typing"}
_BACK_DOORS = {"__import__", "eval", "exec", "compile", "open", "input", "getattr", "setattr", "globals", "vars"}


class CannotTake(Exception):  # noqa: N818  (a sentence for the student, never shown as an error)
    """The cell cannot stand alone; the message says why and what to do."""


def extract(thing, name, earlier, given=""):
    """Return the Source of a function or class as its cell has it.

    name: what it has to be called; earlier: names of the functions of `my_robot` it may lean on. Lines of the cell that
    it does not need stay behind; given: text of helpers that it may use. Raises CannotTake, saying why: another name, a
    variable or an import from elsewhere.
    """
    thing = inspect.unwrap(thing)
    called = getattr(thing, "__name__", "?")
    if str(getattr(thing, "__module__", "")).startswith("ir50p_lab"):
        raise CannotTake(f"this `{called}` is the course's own: write yours, with `def {name}(...)`")
    if called not in (name, "<lambda>"):
        raise CannotTake(f"the function has to be called `{name}`, yours is called `{called}`")
    text = given + re.sub(rf"\bmy_robot\.(?!{name}\b)(\w+)", r"\1", _cell_text(thing))
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
                queue += _globals_of(offered[one])
        elif one in earlier:
            calls.add(one)
        elif one == "my_robot":
            raise CannotTake(f"it calls `my_robot.{name}`: that is the function you are about to write")
        elif one in ORDER:
            raise CannotTake(f"it calls `{one}`: this function is to do without")
        elif one in _BACK_DOORS:
            raise CannotTake(f"it uses `{one}`: your robot stands on plain functions and NumPy alone")
        elif one not in GIVEN and not hasattr(builtins, one):
            raise CannotTake(_stranger(one, getattr(_plain(thing), "__globals__", {}), text))
    for node in wanted:
        _refuse_imports(node)
    patches = [one for one in tree.body if re.match(r"(np|numpy|math)\.\w+ = ", ast.unparse(one))]
    for node in [*wanted, *patches]:
        _refuse_changes(node)
    wanted.sort(key=lambda node: node.lineno)
    return Source(name, "\n\n\n".join(_lines(text, node) for node in wanted), tuple(sorted(calls)))


def compile_source(source, task):
    """The function of a Source with NumPy, math and the earlier functions, and nothing of the notebook."""
    room = {"np": np, "numpy": np, "math": math}
    for name in source.calls:
        room[name] = student_package.load(name) if student_package.is_there(name) else task_of_name(name).reference
    file = f"{ROOM} {task.name}>"
    linecache.cache[file] = (len(source.text), None, source.text.splitlines(keepends=True), file)
    exec(compile(source.text, file, "exec"), room)
    return room[task.function]


def _cell_text(thing):
    code = getattr(_plain(thing), "__code__", None)
    text = "".join(linecache.getlines(code.co_filename)) if code else ""
    if not text:
        raise CannotTake("its text is not to be found: define it in a cell of the notebook, with `def`")
    return text


def _plain(thing):
    """The function; for a class its first method; None if it has none."""
    if hasattr(thing, "__code__"):
        return thing
    return next((value for value in vars(thing).values() if hasattr(value, "__code__")), None)


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


def _globals_of(node):
    """Names that a definition looks up outside itself, as the compiler sees them."""
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
        return "it uses `self` where it is no argument: each function of a class begins with it"
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


def _refuse_imports(node):
    for one in ast.walk(node):
        if isinstance(one, ast.Import):
            modules = [alias.name for alias in one.names]
        elif isinstance(one, ast.ImportFrom):
            modules = [one.module or "."]
        else:
            continue
        for module in modules:
            if module.partition(".")[0] not in _ALLOWED:
                raise CannotTake(f"it imports {module}: your robot stands on NumPy alone, and this part is yours")


def _refuse_changes(node):
    """Refuse code that assigns to, or reads dunder names of, anything but `self`: `np.allclose = ...`."""
    for one in ast.walk(node):
        if not isinstance(one, ast.Attribute):
            continue
        root = ast.unparse(one).partition(".")[0].partition("[")[0]
        opens = one.attr.startswith("__") or not isinstance(one.ctx, ast.Load)
        if root != "self" and opens:
            raise CannotTake(
                f"it changes or opens `{ast.unparse(one)}`: a function returns its answer and leaves the rest"
            )


def has_dots(text):
    """The lines in which dots still stand where the answer should be (those of `a[..., 0]` do not count)."""
    tree = ast.parse(text)
    indices = {id(one) for node in ast.walk(tree) if isinstance(node, ast.Subscript) for one in ast.walk(node.slice)}
    dots = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and node.value is ...]
    return [text.splitlines()[node.lineno - 1].strip() for node in dots if id(node) not in indices]


def written_wrong(function):
    """What a function's own lines tell: an argument overwritten, `==` for `=`, one array under many names; or ""."""
    code = getattr(_plain(inspect.unwrap(function)), "__code__", None)
    file, given = getattr(code, "co_filename", ""), code.co_varnames[: code.co_argcount] if code else ()
    tree = ast.parse("".join(linecache.getlines(file)) if file.startswith(ROOM) else "")
    for one in [part for function in ast.walk(tree) if isinstance(function, ast.FunctionDef) for part in function.body]:
        match one:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant()) if name in given:
                return f"`{ast.unparse(one)}` overwrites what came in"
            case ast.Expr(value=ast.Compare(ops=[ast.Eq()])):
                return f"`{ast.unparse(one)}` compares and puts nothing anywhere: two equal signs are a question"
            case ast.Assign(value=ast.Call() | ast.List(), targets=[_, _, *_] as names):
                filled = [ast.unparse(name) for name in names if f"\n    {ast.unparse(name)}[" in ast.unparse(tree)]
                if len(filled) > 1:
                    return f"{' and '.join(filled)} are names of one array: what is put into one changes all"
    return ""


def _lines(text, node):
    first = min([node.lineno, *(decorator.lineno for decorator in getattr(node, "decorator_list", []))])
    return "\n".join(text.splitlines()[first - 1 : node.end_lineno])
