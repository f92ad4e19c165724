"""One function that the student writes: what is asked, on what it is tried, and how it is wrong when it is wrong."""

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy import allclose  # bound here: a cell may put another into `np`

_LONG = 12  # numbers: of a longer row the first and last three are shown


class Failed(Exception):  # noqa: N818  (becomes a sentence)
    """What the student wrote does not do what it has to; args: sentence, and one input that fails or nothing."""


@dataclass(frozen=True)
class Mistake:
    """A typical mistake.

    wrong: a function with the task's arguments that makes this mistake. says: the symptom in the student's numbers and
    where to look, never the corrected expression. of_code: it is a change of the course's solution, told in its names.
    """

    wrong: Callable
    says: str
    of_code: bool = False


def text_of(*functions):
    """Functions as a student would write them: their text without the docstring."""
    texts = (re.sub(r'\n    """.*?"""', "", inspect.getsource(one), count=1, flags=re.DOTALL) for one in functions)
    return "\n\n".join(texts).rstrip()


def changed(text, changes, names):
    """What a text defines, over `names`, with changes in it: "old -> new". Raises ValueError where no old is."""
    for old, new in (map(str.strip, change.split("->")) for change in changes):
        text.index(old)  # a change that would change nothing
        text = text.replace(old, new)
    names = dict(names)
    exec(text, names)
    return names


@cache
def table(name, beside=__file__):
    """A table of mistakes, NAME.txt beside a module: pairs (what to say, lines), most specific first.

    A paragraph each: the sentence, and indented below it what it is said of; of a solution that is its changes.
    """
    paragraphs = Path(beside).with_name(f"{name}.txt").read_text(encoding="utf-8").strip().split("\n\n")
    rows = (paragraph.split("\n    ") for paragraph in paragraphs)
    return [(says.replace("\n", " "), lines) for says, *lines in rows]


def wrong_one(function, changes):
    """The function with these changes in its text."""
    return changed(text_of(function), changes, {"np": np, **function.__globals__})[function.__name__]


def mistakes(function):
    """The mistakes in the table of a function."""
    rows = table(function.__name__, inspect.getfile(function))
    return [Mistake(wrong_one(function, changes), says) for says, changes in rows]


@dataclass(frozen=True)
class Task:
    """A function of `my_robot`.

    name: of the function; asks: one line, what it returns; right: the course's own answer, a function of the same
    arguments; signature: their names.
    cases: tuples of arguments, edge cases among them; leans_on: earlier functions it may call.
    slips: mistakes with a sentence of their own, most specific first; the usual ones need none (`distortions`);
    routes: other solutions, as text; parts: names of what stands beside each other in the answer.
    symptom: function of (cases, returned, expected), lists of equal length, that returns a sentence about a mistake no
    slip covers, or ""; the example shown is a case that gives the same sentence alone.
    form: function of one right answer; a sentence if later functions cannot use it as it is, or "".
    hints: two, opened on demand; loan: a plain solution, as text, whose names are words.
    same: compares what came back with what was expected; None: equal within tolerance. unit: of what comes back.
    A class has no cases; tried: function of it, raises `Failed` or returns a remark on a right answer ("": none);
    test: its small test, as text; right: the class that stands in.
    """

    name: str
    asks: str
    right: Callable
    loan: str
    cases: Callable | None = None
    leans_on: tuple = ()
    slips: tuple = ()
    routes: tuple = ()
    parts: tuple = ()
    symptom: Callable | None = None
    form: Callable | None = None
    hints: tuple = ("", "")
    same: Callable | None = None
    tolerance: float = 1e-9
    unit: str = ""
    tried: Callable | None = None
    test: str = ""
    signature: tuple = ()

    def __post_init__(self):
        """Take the names of the arguments from the right answer; further options are the course's own affair."""
        found = inspect.signature(self.right).parameters.values()
        names = tuple(one.name for one in found if one.kind != one.VAR_KEYWORD)
        object.__setattr__(self, "signature", self.signature or names)

    @property
    def function(self):
        """Name of the function or class; a stage of it has a longer one."""
        return self.name.partition(".")[0]

    def agrees(self, returned, expected):
        """Tell whether what came back is what was expected."""
        if self.same is not None:
            return self.same(returned, expected)
        returned, expected = np.asarray(returned, dtype=float), np.asarray(expected, dtype=float)
        return returned.shape == expected.shape and bool(
            allclose(returned, expected, 0, self.tolerance, equal_nan=True)
        )


def is_run(value):
    """Tell whether a value is a run of many samples."""
    return np.ndim(value) == 1 and len(value) > _LONG


def shown(value):
    """A value as a student writes it, short."""
    if value is None:
        return "None"
    if callable(value):
        return getattr(value, "__name__", "a function")
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        return str(value)[:80]
    if array.dtype == object:
        return str(value)[:80]
    threshold = _LONG if array.ndim == 1 else array.size
    text = np.array2string(
        array, precision=4, suppress_small=True, separator=", ", max_line_width=100, threshold=threshold
    )
    return text if array.ndim < 2 else "\n" + text
