"""Why a student's function stopped: the line in which it stopped, and the usual reason in plain words."""

import ast
import linecache
import re
import traceback

import numpy as np

from ir50p_lab.course.checking.note import with_full_stop
from ir50p_lab.course.checking.task import table

ROOM = "<my_robot"  # the file name of what is tried begins so
_INSIDE = "inside a function that this line calls. Does it get the right things, in the right order?"


def why_it_stops(error):
    """Return a sentence on an error: the line, the usual reason, what did not fit together, and Python's own words."""
    line, operands, memory = _where(error)
    said = f"Python says {type(error).__name__}: {error}"
    reason = memory or _usual(error)
    if isinstance(error, IndexError) and re.search(r"\[[^],]*:[^],]*\]\[", line) and "size 0" not in str(error):
        reason = "a slice leaves rows, and the next bracket counts rows again: row and column belong in one bracket"
    if line.startswith("raise"):
        reason = "an answer is wanted there, too, not an error"
    place = f" in `{line}`" if line else ""
    if not reason:
        return f"it stops{place}. {said}"
    return f"it stops{place}: {with_full_stop(reason + operands)} {said if 'gufunc' not in said else ''}".rstrip()


def _usual(error):
    """The usual reason in plain words, by the kind of an error and by what its message holds; or ""."""
    for why, signs in table("explain_error"):
        for kind, _, part in (sign.partition(": ") for sign in signs):
            if kind.rstrip(":") == type(error).__name__ and part in str(error):
                return why
    return ""


def _where(error):
    """The student's line, the two operands that do not go together, and what is wrong with its memory."""
    deeper = ""
    for frame, number in reversed(list(traceback.walk_tb(error.__traceback__))):
        file = frame.f_code.co_filename
        if file.startswith(ROOM):
            line = linecache.getline(file, number).strip()
            if deeper and "numpy" not in deeper:
                return line, "", _INSIDE
            return line, _operands(line, frame), _memory(error, line, frame)
        deeper = file
    return "", "", ""


def _memory(error, line, frame):
    """A mistake with what a class remembers: still None, left without `self`, or asked for as a whole; or ""."""
    if "self" not in frame.f_locals:
        return ""
    me, text, says = frame.f_locals["self"], "".join(linecache.getlines(frame.f_code.co_filename)), str(error)
    empty = (f"self.{name}" for name, value in getattr(me, "__dict__", {}).items() if value is None)
    if "NoneType" in says and (one := next((one for one in empty if re.search(rf"{one}\b", line)), "")):
        return f"in the first step {one} is still None. Is that checked first, `if {one} is not None:`?"
    name = next(iter(re.findall(r"'(\w+)'", says)[-1:]), "")
    again = isinstance(error, UnboundLocalError) and hasattr(me, name) and line.startswith(name)
    if again or (getattr(error, "obj", text) is me and re.search(rf"(?m)^\s+{name} = ", text)):
        return f"`{name}` and `self.{name}` are two: without `self.` it is forgotten when its function ends"
    asked = re.search(r"(self\.\w+)( [!=]= None|:| and| or)", line)
    if "truth value" in says and asked and re.search(rf"{asked[1]}\b.*=.*\bNone", text):
        return "a question about three numbers has three answers; `is None` asks whether there is anything yet"
    return ""


def _operands(line, frame):
    try:
        operations = [node for node in ast.walk(ast.parse(line)) if _parts(node)]
    except SyntaxError:  # a part of a longer line
        return ""
    for node in reversed(operations):
        parts = _parts(node)
        try:
            named = [_named(one, frame) for one in parts]
        except Exception:  # the one that fails lies deeper
            continue
        try:
            _value(node, frame)
        except Exception:
            return "; ".join(["", *named])
    return ""


def _parts(node):
    """What an operation is made of: two operands, arguments, or what is in front of square brackets; else ()."""
    if isinstance(node, ast.BinOp):
        return node.left, node.right
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return node.args
    return (node.value,) if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Load) else ()


def _value(node, frame):
    return eval(compile(ast.Expression(node), "<part>", "eval"), frame.f_globals, frame.f_locals)


def _named(node, frame):
    value = _value(node, frame)
    kind = f"has the shape {value.shape}" if isinstance(value, np.ndarray) else f"is {str(value)[:30]}"
    if isinstance(value, list):
        kind = f"is a list of {len(value)}"
    return f"`{ast.unparse(node)}` {kind}"
