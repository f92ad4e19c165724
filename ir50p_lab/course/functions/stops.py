"""Why a student's function stopped: the line it stopped in, and the usual reason in plain words."""

import ast
import linecache
import re
import traceback

import numpy as np

from ir50p_lab.errors import LabError

ROOM = "<my_robot"  # the file name of what is tried begins so

_REASONS = (  # kind of error, what its message holds, the usual reason
    ("TypeError", "NoneType", "something in it is None: does a helper lack its `return`?"),
    ("ValueError", "has 0, gufunc", "a single number or None stands in a matrix product: does a helper lack `return`?"),
    ("TypeError", "bitwise_xor", "`^` is no power in Python; `**` is"),
    ("TypeError", "'^'", "`^` is no power in Python; `**` is"),
    ("TypeError", "array() takes", "the rows need brackets round them all: one list of lists"),
    ("TypeError", "dot() takes", "`np.dot` takes two factors: chain them with `@`"),
    ("TypeError", "converted to Python scalar", "a function of one number (`math`) is given an array: take NumPy's"),
    ("TypeError", "not callable", "what stands before the brackets is no function: is a `*` or a comma missing?"),
    ("TypeError", "not subscriptable", "what stands before the square brackets has no parts"),
    (
        "ValueError",
        "truth value",
        "`if` asks one question, here are three joints: np.where decides for each, np.all or np.any for all together",
    ),
    ("TypeError", "multiply sequence by", "one number times a tuple: three belong there, or an array"),
    ("TypeError", "real number, not 'tuple'", "it is three numbers, one a joint, and is read as one"),
    ("TypeError", "'tuple'", "a tuple cannot be calculated with: `np.array` makes an array of it"),
    ("UFuncTypeError", "Cannot cast ufunc", "an array of whole numbers takes no fractions: np.zeros makes another"),
    ("ValueError", "inhomogeneous", "rows of different lengths make no array"),
    ("ValueError", "array element with a sequence", "a whole array is put where one number belongs"),
    ("ValueError", "mismatch in its core dimension", "two arrays in a product do not fit together"),
    ("ValueError", "not aligned", "two arrays in a product do not fit together"),
    ("ValueError", "broadcast", "two arrays do not fit together"),
    ("IndexError", "with size 0", "the array is empty: for this input nothing fits its condition"),
    ("IndexError", "", "one place too far: places are counted from 0, so the last of n is n - 1"),
    ("ZeroDivisionError", "", "a division by zero"),
    ("ValueError", "math domain error", "a root of less than nothing, or an arccos of more than 1"),
    ("LinAlgError", "ingular", "the matrix has no inverse there: the arm is stretched, a direction is lost"),
    ("LinAlgError", "at least two-dim", "`np.linalg` is given a row where a matrix belongs: in `solve` it comes first"),
    ("ValueError", "empty", "the smallest or largest of nothing: what is to come back where the list is empty?"),
    ("LinAlgError", "square", "only a square matrix has an inverse"),
    ("UnboundLocalError", "", "a name is used before it gets its value: is that only set inside an `if` or a loop?"),
    ("RecursionError", "", "it calls itself without an end"),
)


def why_it_stops(error):
    """A sentence on an error: the line, the usual reason, what did not fit together, and Python's own words."""
    line, operands, empty = _where(error)
    said = f"Python says {type(error).__name__}: {error}"
    reason = next((why for kind, part, why in _REASONS if kind == type(error).__name__ and part in str(error)), "")
    if empty and "NoneType" in str(error):
        reason = f"in the first step {empty} is still None. Is it asked first, `if {empty} is not None:`?"
    if isinstance(error, LabError):
        reason = "an earlier function is given what it cannot take: are its arguments in their order?"
    if isinstance(error, IndexError) and re.search(r"\[[^]]*:[^]]*\]\[", line):
        reason = "a slice leaves rows, and the next bracket counts rows again: row and column stand in one bracket"
    if line.startswith("raise"):
        reason = "it is asked for an answer there, too, not for an error"
    place = f" in `{line}`" if line else ""
    if not reason:
        return f"it stops{place}. {said}"
    return f"it stops{place}: {ended(reason + operands)} {said if 'gufunc' not in said else ''}".rstrip()


def ended(says):
    """A sentence with its full stop; a question has its mark already."""
    return says if says.endswith(("?", ".")) else f"{says}."


def _where(error):
    """The student's line, the two operands that do not go together, and what of `self` is None there."""
    for frame, number in reversed(list(traceback.walk_tb(error.__traceback__))):
        file = frame.f_code.co_filename
        if file.startswith(ROOM):
            line = linecache.getline(file, number).strip()
            return line, _operands(line, frame), _empty(line, frame)
    return "", "", ""


def _empty(line, frame):
    """What the controller remembers, if it is None and stands in the line."""
    memory = getattr(frame.f_locals.get("self"), "__dict__", {})
    names = (f"self.{name}" for name, value in memory.items() if value is None)
    return next((name for name in names if re.search(rf"{name}\b", line)), "")


def _operands(line, frame):
    try:
        operations = [node for node in ast.walk(ast.parse(line)) if _is_operation(node)]
    except SyntaxError:  # a part of a longer line
        return ""
    for node in reversed(operations):
        parts = node.args if isinstance(node, ast.Call) else (node.left, node.right)
        try:
            named = [_named(one, frame) for one in parts]
        except Exception:  # the one that fails lies deeper
            continue
        try:
            _value(node, frame)
        except Exception:
            return "; ".join(["", *named])
    return ""


def _is_operation(node):
    return isinstance(node, ast.BinOp) or (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute))


def _value(node, frame):
    return eval(compile(ast.Expression(node), "<part>", "eval"), frame.f_globals, frame.f_locals)


def _named(node, frame):
    value = _value(node, frame)
    kind = f"has the shape {value.shape}" if isinstance(value, np.ndarray) else f"is {str(value)[:30]}"
    if isinstance(value, list):
        kind = f"is a list of {len(value)}"
    return f"`{ast.unparse(node)}` {kind}"
