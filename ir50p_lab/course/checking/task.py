"""One function that the student writes: what is asked, on what it is tried, and how it goes wrong."""

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy import allclose  # bound here: a cell may put another into `np`

_LONG = 12  # numbers: of a longer row the first and last three are shown


class Failed(Exception):  # noqa: N818  (becomes a sentence)
    """What the student wrote does not do what it has to; args: a sentence, and one input that fails or nothing."""


@dataclass(frozen=True)
class Mistake:
    """A typical mistake.

    function: has the task's arguments and makes this mistake. says: the symptom in the student's numbers and
    where to look, never the corrected expression.
    """

    function: Callable
    says: str


def text_of(*functions):
    """Return functions as a student would write them: their text without docstrings."""
    texts = (re.sub(r'\n    """.*?"""', "", inspect.getsource(one), count=1, flags=re.DOTALL) for one in functions)
    return "\n\n".join(texts).rstrip()


def apply_changes(text, changes, names):
    """Run a text with changes "old -> new" made in it; return {name: what it defines}, `names` included.

    Raises ValueError if an old part is not in the text.
    """
    for old, new in (map(str.strip, change.split("->")) for change in changes):
        text.index(old)  # a change that would change nothing
        text = text.replace(old, new)
    names = dict(names)
    exec(text, names)
    return names


def _rows(text):
    rows = (paragraph.split("\n    ") for paragraph in text.strip().split("\n\n") if paragraph)
    return [(says.replace("\n", " "), lines) for says, *lines in rows]


@cache
def table(name, beside=__file__):
    """Return the paragraphs of NAME.txt beside a module: pairs (what to say, lines indented below it)."""
    return _rows(Path(beside).with_name(f"{name}.txt").read_text(encoding="utf-8"))


@cache
def sections(name, beside):
    """Return the parts of NAME.txt beside a module: {heading: text}; a heading is a line that begins with "# "."""
    text = Path(beside).with_name(f"{name}.txt").read_text(encoding="utf-8")
    _, *parts = re.split(r"^# (.+)\n", text, flags=re.MULTILINE)
    return {heading: part.strip() for heading, part in zip(parts[::2], parts[1::2], strict=True)}


def sentences(name, beside):
    """Return what is said if no mistake of the table fits: {key: sentence}, from lines "key: sentence"."""
    lines = re.sub(r"\n +", " ", sections(name, beside).get("otherwise", "")).splitlines()
    return dict(line.split(": ", 1) for line in lines)


def changes_of(text):
    """Yield pairs (sentence, changes) from a table of mistakes, most specific first.

    Below each sentence, indented, is what makes the mistake out of the solution: its changes, "old  ->  new", one per
    line. A line that begins with "or:" starts another way to make it.
    """
    for says, lines in _rows(text):
        for way in "\n".join(lines).split("\nor: "):
            yield says, way.split("\n")


def wrong_one(function, changes):
    """Return the function with these changes made in its text."""
    return apply_changes(text_of(function), changes, {"np": np, **function.__globals__})[function.__name__]


def mistakes(function):
    """Return the Mistakes in the table of a function."""
    return _made(function, sections(function.__name__, inspect.getfile(function)).get("mistakes", ""))


def _made(function, table):
    return tuple(Mistake(wrong_one(function, changes), says) for says, changes in changes_of(table))


def nth_result(function, result):
    """Return a function that gives one of several results of another function."""
    return lambda *case: function(*case)[result]


@dataclass(frozen=True)
class Task:
    """A function of `my_robot`, as an exercise.

    name: of the function; returns: one line, what it gives back; reference: the course's own answer, a function of the
    same arguments; signature: their names.
    cases: gives tuples of arguments, edge cases among them; leans_on: earlier functions that it may call.
    mistakes: those with a sentence of their own, most specific first; the usual ones need none (`distortions`);
    also_right: other functions, of several results, that are right as well;
    entry_names: names of the entries of the answer.
    results: names, if several things are returned; each is then graded by itself, and `tolerance` and `compare` may be
    tuples, with one for each.
    symptom: function of (case, returned, expected) that returns a sentence about what no mistake covers, or "".
    check_form: function of one right answer; returns a sentence if later functions cannot use it as it is, or "".
    hints: two, opened on demand; solution_text: a plain solution, whose names are words; it is what is lent.
    compare: tells whether what came back is what was expected; None: equal within tolerance. unit: of what comes back.
    test: its small test, as text; needed if an argument is a function.
    A class, or a function of keywords alone, has no cases. Then trial is a function of it that raises `Failed` or
    returns a remark on a right answer ("": none), and reference is what stands in.
    """

    name: str
    returns: str
    reference: Callable
    solution_text: str
    cases: Callable | None = None
    leans_on: tuple = ()
    mistakes: tuple = ()
    also_right: tuple = ()
    entry_names: tuple = ()
    results: tuple = ()
    symptom: Callable | None = None
    check_form: Callable | None = None
    hints: tuple = ("", "")
    compare: Callable | tuple | None = None
    tolerance: float | tuple = 1e-9
    unit: str = ""
    trial: Callable | None = None
    test: str = ""
    signature: tuple = ()
    given: str = ""  # text of helpers that the notebook shows: a student need not write them
    function: str = ""  # its name; that of a stage is longer
    result: int | None = None  # which of several results it is about, in a trial of one alone

    def __post_init__(self):
        """Take the names of the arguments from the right answer, and keep the cases once they are made.

        Further options of the right answer are the course's own affair.
        """
        found = inspect.signature(self.reference).parameters.values()
        names = tuple(one.name for one in found if one.kind != one.VAR_KEYWORD)
        object.__setattr__(self, "signature", self.signature or names)
        object.__setattr__(self, "function", self.name.partition(".")[0])
        object.__setattr__(self, "cases", self.cases and cache(self.cases))  # some draw pictures

    @property
    def function_arguments(self):
        """Names of the arguments that are functions."""
        case = self.cases()[0] if self.cases else ()
        return tuple(name for name, value in zip(self.signature, case, strict=False) if callable(value))

    def of(self, result):
        """Return the task of one of several results alone."""
        mistakes = tuple(replace(one, function=nth_result(one.function, result)) for one in self.mistakes)
        return replace(
            self,
            reference=nth_result(self.reference, result),
            mistakes=mistakes,
            compare=self._of_each(self.compare)[result],
            tolerance=self._of_each(self.tolerance)[result],
            also_right=(),
            results=(),
            symptom=None,
            result=result,
        )

    def agrees(self, returned, expected):
        """Return True if what came back is what was expected; what is no answer at all is not."""
        try:
            if not self.results:
                return _is_same(returned, expected, self.compare, self.tolerance)
            each = zip(returned, expected, self._of_each(self.compare), self._of_each(self.tolerance), strict=True)
            return all(_is_same(*one) for one in each)
        except (TypeError, ValueError):
            return False

    def expected(self, case, returned):
        """Return the right answer to a case; of several (`also_right`) the one that came back, result by result."""
        right = self.reference(*case)
        for other in self.also_right:
            also = other(*case)
            try:
                each = zip(returned, right, also, self._of_each(self.tolerance), strict=True)
                right = tuple(b if _is_same(one, b, None, within) else a for one, a, b, within in each)
            except (TypeError, ValueError):  # what came back is no answer
                return right
        return right

    def _of_each(self, option):
        return option if isinstance(option, tuple) else (option,) * len(self.results)


def task_of(right, *, helpers=(), **options):
    """Return the Task of a function of the course: its text is the loan, all sentences about it are in NAME.txt.

    helpers: functions that it calls and that a student has to write as well; options: what else a Task has.
    """
    name, file = right.__name__, inspect.getfile(right)
    options = {"mistakes": mistakes(right)} | words(name, file) | options
    return Task(name=name, reference=right, solution_text=text_of(*helpers, right), **options)


def words(name, beside):
    """Return options of a Task from NAME.txt: what it returns, two hints, its small test if it has one."""
    text = sections(name, beside)
    hints = tuple(hint.replace("\n", " ") for hint in text["hints"].split("\n\n"))
    test = text["test"] + "\n" if "test" in text else ""
    return {"returns": text["returns"].replace("\n", " "), "hints": hints, "test": test}


def notebook_tasks(beside, **asked):
    """Return the Tasks of functions that stay in their notebook, {name: Task}.

    asked: NAME=(right, cases, what it returns, a dict of other options if there are any).

    Their texts, in the names of the notebook, are in notebook_functions.txt beside the module, each below its name;
    below "NAME: mistakes" is the table of mistakes, which are made out of the course's own function.
    """
    texts, tasks = sections("notebook_functions", beside), {}
    for name, (right, cases, asks, *options) in asked.items():
        known = _made(right, texts.get(f"{name}: mistakes", ""))
        tasks[name] = Task(name, asks, right, texts[name], cases, mistakes=known, **dict(*options))
    return tasks


def _is_same(returned, expected, same, tolerance):
    if same is not None:
        return same(returned, expected)
    returned, expected = np.asarray(returned, dtype=float), np.asarray(expected, dtype=float)
    return returned.shape == expected.shape and bool(allclose(returned, expected, 0, tolerance, equal_nan=True))


def is_run(value):
    """Return True if a value is a run of many samples."""
    return np.ndim(value) == 1 and len(value) > _LONG


def short_text(value):
    """Return a value as a student would write it, in short."""
    if value is None:
        return "None"
    if isinstance(value, tuple):
        return "(" + ", ".join(map(short_text, value)) + ")"
    if callable(value):
        meaning = (inspect.getdoc(value) or "").partition("\n")[0]
        return f"the function {getattr(value, '__name__', '')}" + (f" ({meaning})" if meaning else "")
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
