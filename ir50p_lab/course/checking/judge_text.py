"""What the text of a function tells before it runs: what it may not do, what is still open, what is written wrong."""

import ast
import inspect
import linecache
import textwrap
from types import ModuleType

import numpy as np

from ir50p_lab.course.checking.explain_error import ROOM

_ALLOWED = {"numpy", "math", "cmath", "collections", "dataclasses", "functools", "itertools", "operator", "typing"}
#: Names that lead out of the allowed modules, or out of a function: to other modules, or to its frame.
_DOORS = {name for name, value in vars(np).items() if isinstance(value, ModuleType)}
_DOORS -= {"linalg", "random", "fft", "polynomial", "typing"}
_DOORS |= {"os", "sys", "_sys", "builtins", "inspect", "types", "contextlib", "warnings", "attrgetter", "methodcaller"}
_DOORS |= {"get_type_hints", "ForwardRef", "make_dataclass"}  # they evaluate texts
_DOORS |= {"save", "savez", "savez_compressed", "savetxt", "tofile", "dump", "memmap", "DataSource"}  # files
_DOORS |= {"load", "loadtxt", "genfromtxt", "fromfile", "fromregex"}
_DOORS |= {"gi_frame", "cr_frame", "tb_frame", "f_back", "f_builtins", "f_globals"}


class CannotTake(Exception):  # noqa: N818  (a sentence for the student, never shown as an error)
    """The cell cannot stand alone; the message says why and what to do."""


def check_allowed(definitions):
    """Raise CannotTake if a definition imports or opens what it may not, or changes what is not its own."""
    for node in definitions:
        _refuse_imports(node)
        _refuse_doors(node)
        _refuse_changes(node)


def plain_function(thing):
    """Return the function itself, or the first method of a class; None if there is none."""
    if hasattr(thing, "__code__"):
        return thing
    return next((value for value in vars(thing).values() if hasattr(value, "__code__")), None)


def has_dots(text):
    """Return the lines in which dots still stand where the answer should be (those of `a[..., 0]` do not count)."""
    tree = ast.parse(text)
    indices = {id(one) for node in ast.walk(tree) if isinstance(node, ast.Subscript) for one in ast.walk(node.slice)}
    dots = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and node.value is ...]
    return [text.splitlines()[node.lineno - 1].strip() for node in dots if id(node) not in indices]


def written_wrong(function):
    """Say what is wrong in a function's lines: an argument overwritten, `==` for `=`, an array of many names; or ""."""
    code = getattr(plain_function(inspect.unwrap(function)), "__code__", None)
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


def is_open(function):
    """Return True if dots still stand in a function of the notebook; of one typed into a console nothing is known."""
    try:
        return bool(has_dots(textwrap.dedent(inspect.getsource(function))))
    except (OSError, TypeError, SyntaxError):
        return False


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


def _refuse_doors(node):
    """Refuse the inner modules of NumPy and of others (`np.lib`), and names of Python's own in a text."""
    docstrings = {id(one.value) for one in ast.walk(node) if isinstance(one, ast.Expr)}
    for one in ast.walk(node):
        match one:
            case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
                names = {part for alias in aliases for part in alias.name.split(".")}
            case ast.Attribute(attr=name, value=value) if ast.unparse(value) != "self":
                names = {name}
            case ast.Constant(value=str(text)) if "__" in text and id(one) not in docstrings:
                raise CannotTake("a text in it holds `__`: names of Python's own are not for a robot")
            case _:
                continue
        for name in sorted(names & _DOORS):
            raise CannotTake(f"it uses `{name}`: your robot stands on plain functions and NumPy alone")


def _refuse_changes(node):
    """Refuse code that assigns to, or reads dunder names of, anything but `self`: `np.allclose = ...`."""
    for one in ast.walk(node):
        if not isinstance(one, ast.Attribute):
            continue
        root = ast.unparse(one).partition(".")[0].partition("[")[0]
        pythons_own = one.attr.startswith("__") and one.attr.endswith("__")
        opens = one.attr.startswith("__") or not isinstance(one.ctx, ast.Load)
        if pythons_own or (root != "self" and opens):
            raise CannotTake(
                f"it changes or opens `{ast.unparse(one)}`: a function returns its answer and leaves the rest"
            )
