"""Try a student's function on many inputs, and say in a sentence what was found."""

import copy
import inspect
import re
import warnings
from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from ir50p_lab.course.checking.calling import call, case_in_words, check_signature
from ir50p_lab.course.checking.cell import compile_source
from ir50p_lab.course.checking.distortions import distortions, entries
from ir50p_lab.course.checking.judge_text import written_wrong
from ir50p_lab.course.checking.shape_checks import kind_of, no_numbers, number_of_results
from ir50p_lab.course.checking.task import Failed, short_text
from ir50p_lab.course.robot.source import Source


@dataclass(frozen=True)
class Grade:
    """The result of grading an answer.

    state: "right" or "wrong"; says: one or two sentences; example: one failing input with both answers, or "".
    """

    state: str
    says: str
    example: str = ""


@dataclass
class _Trial:
    """What a function gave back: returned (Failed where it stopped) and expected, a list each; bad: the wrong cases.

    result: which one of several results is looked at; before: lists and arrays beside the function, as they were;
    example: the case to show.
    """

    task: object
    function: object
    cases: list
    returned: list
    expected: list
    before: dict
    result: int | None = None
    example: int | None = None

    def __post_init__(self):
        good = [self.task.agrees(*both) for both in zip(self.returned, self.expected, strict=True)]
        self.bad = [k for k, fine in enumerate(good) if not fine]

    def of(self, result):
        """The trial of one of several results alone."""
        returned, expected = ([one[result] for one in many] for many in (self.returned, self.expected))
        return replace(self, task=self.task.of(result), returned=returned, expected=expected, result=result)


def grade(task, answer):
    """Return the Grade of a function or class, or of the Source of one. Raises nothing, whatever it does."""
    function = compile_source(answer, task) if isinstance(answer, Source) else answer
    try:
        if task.trial is not None:
            return Grade("right", task.trial(function))
        cases, before = task.cases(), _beside(function)
        check_signature(task, function, cases[0])
        returned = [call(task, function, case) for case in cases]
    except Failed as failed:
        return Grade("wrong", *failed.args)
    expected = [task.expected(copy.deepcopy(case), one) for case, one in zip(cases, returned, strict=True)]
    trial = _Trial(task, function, cases, returned, expected, before)
    if not trial.bad:
        return _grade_use(task, cases, returned, expected)
    says = _read(trial) or _count(trial)
    order = trial.bad if trial.example is None else [trial.example, *trial.bad]
    visible = (_example(task, cases[k], expected[k], returned[k]) for k in order)
    return Grade("wrong", says, next(filter(None, visible), ""))


def _read(trial):
    """The first sentence that a reading gives, or ""."""
    return next(filter(None, (read(trial) for read in READINGS)), "")


def _count(trial):
    good = len(trial.cases) - len(trial.bad)
    return f"it is right for {good} of {len(trial.cases)} inputs: try the one below with pencil and paper"


# ------------------------------------------------------------------------------------------------------- readings
def _written(trial):
    return written_wrong(trial.function) if trial.result is None else ""


def _known(trial):
    task, returned, bad = trial.task, trial.returned, trial.bad
    stopped = sum(isinstance(one, Failed) for one in returned)
    if stopped == len(bad) or 2 * stopped >= len(returned) or all(one is None for one in returned):
        return ""  # nothing to compare
    order = [*bad, *sorted(set(range(len(returned))) - set(bad))]
    for mistake in _mistakes(trial):
        if all(_is_mistake(task, mistake, trial.cases[k], returned[k]) for k in order):
            return mistake.says
    return ""


def _mistakes(trial):
    """Yield those of the task, then the usual ones, all of them: what is said depends on the answer alone."""
    yield from trial.task.mistakes
    if not all(map(_is_zero, trial.returned)):  # zeros say too little to tell one from another
        yield from distortions(trial.task)


def _whole_arguments(trial):
    """Right but where an array of whole numbers comes in: one made from it keeps its kind."""
    whole = [k for k, case in enumerate(trial.cases) if any(map(_is_whole_array, case))]
    if trial.bad != whole or len(whole) == len(trial.cases):
        return ""
    arguments = zip(trial.task.signature, trial.cases[whole[0]], strict=True)
    name = next(name for name, value in arguments if _is_whole_array(value))
    return (
        f"it is right except where `{name}` holds whole numbers: an array made from it (`np.zeros_like({name})`, "
        f"`{name}.copy()`) holds whole numbers only and cuts off what is put in; `np.zeros(3)`, `{name}.astype(float)` "
        "do not"
    )


def _outside(trial):
    now = _beside(trial.function)
    changed = [name for name, before in trial.before.items() if now[name] != before]
    if changed:
        return f"it changes `{changed[0]}`, made once outside it: the next call or helper finds it changed"
    return ""


def _stops(trial):
    trial.example = next((k for k in trial.bad if isinstance(trial.returned[k], Failed)), None)
    return "" if trial.example is None else trial.returned[trial.example].args[0]


def _form(trial):
    task, returned = trial.task, trial.returned
    if all(one is None for one in returned) and not any(one is None for one in trial.expected):
        return "it returns nothing: is there a `return`, and is it reached in every case?"
    for k in trial.bad:
        one, other = returned[k], trial.expected[k]
        if task.results:
            says = number_of_results(task.results, one, other)
        elif task.compare is None and other is not None:
            says = no_numbers(one, other)
        else:
            says = "" if one is None else kind_of(one)
        if says:
            trial.example = k
            return says
    return ""


def _results(trial):
    """The sentence on the first wrong result that has one; else which of them are wrong."""
    parts = {name: trial.of(k) for k, name in enumerate(trial.task.results)}
    wrong = {name: part for name, part in parts.items() if part.bad}
    right = [name for name in parts if name not in wrong]
    intro = f"{_listed(right)} right; " if right else ""
    for name, part in wrong.items():
        if says := _read(part):
            trial.example = part.bad[0] if part.example is None else part.example
            named = len(name) > 2 and name in says  # `t` and `x` stand in every second word
            return says if named else f"{intro}{name}: {says}"
    says = _symptom(trial)
    return says or (f"{intro}{_listed(list(wrong))} not: try the one below with pencil and paper" if intro else "")


def _listed(names):
    """Names with their verb: "slope and offset are"."""
    *first, last = names
    many = first or last.endswith("s")
    return f"{', '.join(first)}{' and ' if first else ''}{last} {'are' if many else 'is'}"


def _numbers(trial):
    """What numbers alone tell, whatever the function: all the same, whole, off by a constant, few of them wrong."""
    task, cases, returned, expected = trial.task, trial.cases, trial.returned, trial.expected
    if task.compare is not None or task.results or any(one is None for one in (*returned, *expected)):
        return ""
    if all(map(_is_zero, returned)):
        return "it is 0 for every input: is what it computes put into what it returns, and after the loop?"
    if all(np.array_equal(one, returned[0]) for one in returned):
        return f"it returns the same for every input: {short_text(returned[0])}"
    if all(map(_is_whole, returned)) and not all(map(_is_whole, expected)):
        return "it holds whole numbers only: what was put in was cut off (an array of integers?)"
    return entries(task, cases, returned, expected) or _by_a_constant(returned, expected)


def _symptom(trial):
    """What the task itself sees; of several sentences the one that most wrong cases give."""
    if trial.task.symptom is None:
        return ""
    said = {k: trial.task.symptom(trial.cases[k], trial.returned[k], trial.expected[k]) for k in trial.bad}
    counts = Counter(_without_numbers(says) for says in said.values() if says)
    if not counts:
        return ""
    most = counts.most_common(1)[0][0]
    alike = [k for k, says in said.items() if _without_numbers(says) == most]
    seen = (
        k for k in alike if short_text(trial.returned[k]) != short_text(trial.expected[k])
    )  # in the digits that are shown
    trial.example = next(seen, alike[0])
    return said[trial.example]


READINGS = (  # of a wrong answer, in this order: the first that has something to say is told
    _written,  # its own lines: an argument overwritten, `==` for `=`, one array under two names
    _known,  # mistakes of the task, results and arguments spoilt in usual ways
    _whole_arguments,  # right, but where whole numbers come in
    _outside,  # a list or array beside it that each call changes
    _stops,  # the line in which it stopped, and why
    _form,  # nothing, another kind of thing, another number of results, another shape
    lambda trial: _results(trial) if trial.task.results else "",  # these readings again, for each of several results
    _numbers,  # the same for every input, whole numbers, few entries wrong, all off by a constant
    _symptom,  # what the task itself sees in one wrong case
)


# ------------------------------------------------------------------------------------------------------ comparing
def _beside(function):
    """The lists, dicts and arrays that stand beside a function in its cell, as text."""
    found = getattr(inspect.unwrap(function), "__globals__", {})
    return {
        name: repr(one) for name, one in found.items() if isinstance(one, list | dict | np.ndarray) and name[0] != "_"
    }


def _is_mistake(task, mistake, case, returned):
    """Tell whether a mistake gives the same answer, or stops as this one does."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
            wrong = mistake.function(*copy.deepcopy(case))
    except Exception as error:
        return isinstance(returned, Failed) and type(returned.__cause__) is type(error)
    return task.agrees(returned, wrong)


# -------------------------------------------------------------------------------------------------------- numbers
def _is_zero(value):
    try:
        return not np.any(np.asarray(value, dtype=float))
    except (TypeError, ValueError):
        return False


def _is_whole(value):
    return np.array_equal(value, np.round(value))


def _is_whole_array(value):
    return isinstance(value, np.ndarray) and value.dtype.kind == "i"


def _by_a_constant(returned, expected):
    """All numbers off by one factor, or by one summand: a constant is another one."""
    one, other = (np.concatenate([np.ravel(value) for value in many]).astype(float) for many in (returned, expected))
    if not np.isfinite([one, other]).all():
        return ""
    factor = one @ other / max(other @ other, 1e-300)
    if np.allclose(one, factor * other, rtol=1e-6, atol=1e-9 * np.abs(other).max()):
        if abs(factor - 1) < 5e-7:
            return ""
        if abs(factor - 1) < 0.01:
            return (
                f"it is nearly right, all is {factor:.6g} times what it should be: is a constant in it rounded, or "
                "written by hand?"
            )
        return f"every number is {factor:.4g} times what it should be: is a factor extra or missing, or a unit another?"
    if np.ptp(one - other) < 1e-9 * np.abs(other).max():
        return f"every number is off by the same {np.mean(one - other):.4g}"
    return ""


def _without_numbers(says):
    return re.sub(r"-?\d[\d.]*", "", says)


# ------------------------------------------------------------------------------------------------- what is shown
def _grade_use(task, cases, returned, expected):
    """The numbers are right; what the next functions need is an array, too."""
    for case, one, other in zip(cases, returned, expected, strict=True):
        if task.check_form is not None and (says := task.check_form(one)):
            return Grade("wrong", says, _example(task, case, other, one))
        for mine, right in zip(one, other, strict=True) if task.results else ((one, other),):
            if isinstance(right, np.ndarray) and not isinstance(mine, np.ndarray) and np.size(mine):
                kind = type(mine).__name__
                return Grade(
                    "wrong",
                    f"the numbers are right, but it returns a {kind}: later functions will slice it, so "
                    "return an array, `np.array(...)`",
                )
    return Grade("right", "")


def _example(task, case, expected, returned):
    if isinstance(returned, Failed):
        return returned.args[1]
    unit = f" {task.unit}" if task.unit else ""
    both = _answer(task, expected), _answer(task, returned)
    return f"{case_in_words(task, case)}\nexpected{unit}: {both[0]}\nyours: {both[1]}" if both[0] != both[1] else ""


def _answer(task, value):
    if not task.results or number_of_results(task.results, value, value):
        return short_text(value)
    return ", ".join(f"{name} = {short_text(one)}" for name, one in zip(task.results, value, strict=True))
