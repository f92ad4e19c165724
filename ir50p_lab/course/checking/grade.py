"""Try a student's function on many inputs and say in a sentence what was found."""

import copy
import inspect
import re
import time
import warnings
from dataclasses import dataclass
from itertools import chain

import numpy as np

from ir50p_lab.course.checking.cell import written_wrong
from ir50p_lab.course.checking.distortions import distortions, entries, of_results, pairs
from ir50p_lab.course.checking.stops import why_it_stops
from ir50p_lab.course.checking.task import Failed, is_run, shown
from ir50p_lab.course.checking.variants import in_words_of, variants

_PATIENCE = 2.0  # s of computing: the search for a likely mistake ends then


@dataclass(frozen=True)
class Grade:
    """state: "right" or "wrong"; says: one or two sentences; example: one failing input with both answers, or ""."""

    state: str
    says: str
    example: str = ""


def grade(task, function):
    """Return the Grade on a function or class, whatever it does."""
    if task.tried is not None:
        try:
            return Grade("right", task.tried(function))
        except Failed as failed:
            return Grade("wrong", *failed.args)
    cases = task.cases()
    outside = _outside(function)
    try:
        _check_signature(task, function, cases[0])
        returned = [_call(task, function, case) for case in cases]
    except Failed as failed:
        return Grade("wrong", *failed.args)
    expected = [task.right(*copy.deepcopy(case)) for case in cases]
    good = [_agrees(task, one, other) for one, other in zip(returned, expected, strict=True)]
    if all(good):
        return _grade_form(task, cases, returned, expected)
    bad = [k for k, fine in enumerate(good) if not fine]
    says, guess = _known(task, function, cases, returned, expected, bad)
    changed = [name for name, before in outside.items() if _outside(function)[name] != before]
    if changed and not says:
        return Grade(
            "wrong", f"it changes `{changed[0]}`, made once outside it: the next call or helper finds it changed"
        )
    stopped = [one for one in returned if isinstance(one, Failed)]
    if stopped and not says:
        return Grade("wrong", *stopped[0].args)
    readings = () if says else (_common, _usual, _mostly, _symptom)
    for read in readings:
        if says := read(task, cases, returned, expected):
            if read in (_common, _symptom):
                bad = _shown_by(read, says, task, cases, returned, expected, bad)
            if read is _symptom and guess:
                says = f"{guess}; {says}"
            break
    by_count = f"it is right for {sum(good)} of {len(good)} inputs: try the one below with pencil and paper"
    visible = (_example(task, cases[k], expected[k], returned[k]) for k in bad)
    return Grade("wrong", says or guess or by_count, next(filter(None, visible), ""))


def _known(task, function, cases, returned, expected, bad):
    """The sentence of the mistake that gives these answers, or ""; and one that says too little, or ""."""
    if says := written_wrong(function):
        return says, ""
    stopped = sum(isinstance(one, Failed) for one in returned)
    if stopped == len(bad) or 2 * stopped >= len(cases) or all(one is None for one in returned):  # nothing to compare
        return "", ""
    order = [*bad, *sorted(set(range(len(cases))) - set(bad))]
    both = pairs(task) if any(map(_has_numbers, returned)) else ()
    usual = _while_patient(chain(distortions(task), variants(task), both))
    for slip in chain(task.slips, usual):
        if not all(_is_slip(task, slip, cases[k], returned[k]) for k in order):
            continue
        if not slip.of_code:
            return slip.says, ""
        words, complete = in_words_of(function, slip.says)
        where = "" if stopped or task.same else entries(task, cases, returned, expected)
        if where:
            words = words.partition(": look at")[0] if complete else ""
            if where.count("wrong sign") == 1 and words.endswith("wrong sign"):  # its use is wrong, not the number
                words = ""
            return f"{where}: {words}" if words else where, ""
        return (words, "") if complete else ("", words)
    return "", ""


def _has_numbers(result):
    try:
        return np.isfinite(np.asarray(result, dtype=float)).any()
    except (TypeError, ValueError):
        return False


def _outside(function):
    """The lists, dicts and arrays that stand beside a function in its cell, as text."""
    found = getattr(inspect.unwrap(function), "__globals__", {})
    return {
        name: repr(one) for name, one in found.items() if isinstance(one, list | dict | np.ndarray) and name[0] != "_"
    }


def _shown_by(read, says, task, cases, returned, expected, bad):
    """The cases that show by themselves what is said of all, those with the very same numbers first."""
    says_of = {k: read(task, *([many[k]] for many in (cases, returned, expected))) for k in bad}
    return sorted(
        (k for k in bad if _without_numbers(says_of[k]) == _without_numbers(says)), key=lambda k: says_of[k] != says
    )


def _without_numbers(says):
    return re.sub(r"-?\d[\d.]*", "", says)


def _while_patient(slips):
    """The slips that can be tried in a given time; the processor's, not that of the clock, decides."""
    end = time.thread_time() + _PATIENCE
    for slip in slips:
        yield slip
        if time.thread_time() > end:
            return


def _check_signature(task, function, case):
    try:
        inspect.signature(function).bind(*case)
    except TypeError:
        found = ", ".join(inspect.signature(function).parameters)
        wanted = ", ".join(task.signature)
        raise Failed(f"it takes ({found}); it will be called with ({wanted}), in this order") from None


def _call(task, function, case):
    """What it returns; Failed, returned as well, where it stops."""
    given = copy.deepcopy(case)
    try:
        result = guarded(lambda: function(*given), lambda: _given(task, case))
    except Failed as stopped:
        if isinstance(stopped.__cause__, KeyboardInterrupt):
            raise
        return stopped
    for name, one, other in zip(task.signature, case, given, strict=True):
        if not _untouched(one, other):
            says = f"it changes what it was given, `{name}`: work on a copy (`np.array(x)` makes one)"
            raise Failed(says, _given(task, case))
    return result


def guarded(do, given=str):
    """What `do` gives; given: function that names the case, called only when it fails. Raises Failed from the error."""
    try:
        with np.errstate(all="ignore"):
            return do()
    except KeyboardInterrupt as stop:
        raise Failed("it was stopped: does a loop in it never end?", given()) from stop
    except Exception as error:
        raise Failed(why_it_stops(error), given()) from error


def _untouched(before, after):
    return callable(before) or np.array_equal(np.asarray(before), np.asarray(after))


def _agrees(task, returned, expected):
    try:
        return task.agrees(returned, expected)
    except (TypeError, ValueError):
        return False


def _is_slip(task, slip, case, returned):
    """Tell whether a slip gives the same answer, or stops as this one does."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
            wrong = slip.wrong(*copy.deepcopy(case))
    except Exception as error:
        return isinstance(returned, Failed) and type(returned.__cause__) is type(error)
    return _agrees(task, returned, wrong)


def _grade_form(task, cases, returned, expected):
    """The numbers are right; what the next functions need is an array, too."""
    for case, one, other in zip(cases, returned, expected, strict=True):
        if task.form is not None and (says := task.form(one)):
            return Grade("wrong", says, _example(task, case, other, one))
        if np.size(one) and isinstance(other, np.ndarray) and not isinstance(one, np.ndarray):
            kind = type(one).__name__
            return Grade(
                "wrong",
                f"the numbers are right, but it returns a {kind}: later functions will slice it, so "
                "return an array, `np.array(...)`",
            )
    return Grade("right", "")


def _usual(task, cases, returned, expected):
    """What numbers alone tell, whatever the function."""
    if task.same is not None:
        return ""
    return _alone(returned) or _nearly(returned, expected) or entries(task, cases, returned, expected)


def _mostly(task, cases, returned, expected):
    """A mistake, of the task's own or of the result's form, that explains many of the wrong answers."""
    wrong = [k for k in range(len(cases)) if not _agrees(task, returned[k], expected[k])]
    right = sorted(set(range(len(cases))) - set(wrong))
    for slip in (*task.slips, *of_results(task)):
        if not all(_is_slip(task, slip, cases[k], returned[k]) for k in right):
            continue
        share = sum(returned[k] is not None and _is_slip(task, slip, cases[k], returned[k]) for k in wrong)
        if share >= max(3, len(wrong) / 2):
            says = slip.says.removesuffix(", the rest is right")
            return f"{says} (that explains {share} of {len(wrong)} wrong answers; something else is wrong, too)"
    return ""


def _symptom(task, cases, returned, expected):
    return task.symptom(cases, returned, expected) if task.symptom else ""


def _common(task, cases, returned, expected):
    """Mistakes that look alike in every function: nothing returned, another kind of thing, another shape."""
    if all(one is None for one in returned) and not any(one is None for one in expected):
        return "it returns nothing: is there a `return`, and is it reached in every case?"
    pairs = [(one, other) for one, other in zip(returned, expected, strict=True) if other is not None]
    found = (no_numbers(one, other) for one, other in pairs if task.same is None)
    return next(filter(None, chain(found, (_kind(one) for one in returned if one is not None))), "")


def no_numbers(returned, expected):
    """Why something is not what is expected before its numbers are looked at, or ""."""
    if returned is None:
        return "it returns nothing for some inputs: is its `return` reached in every case?"
    if says := _kind(returned):
        return says
    array, wanted = np.asarray(returned, dtype=float), np.shape(expected)
    if array.shape != wanted:
        if array.size == np.size(expected) and np.allclose(array.ravel(), np.ravel(expected)):
            return f"the numbers are right, their shape is not: {array.shape}, expected is {wanted}"
        if array.shape[1:] == wanted and array.ndim > 1:
            return f"it returns {len(array)} arrays where one is asked for"
        return f"it returns an array of shape {array.shape}; expected is {wanted}"
    if not np.isfinite(array).all() and np.isfinite(np.asarray(expected, dtype=float)).all():
        return "it returns a number that is not finite (nan or inf): a division by zero, a root of less than nothing?"
    return ""


def _kind(returned):
    """Why something cannot be read as numbers, or ""."""
    if callable(returned):
        return f"it returns the function {getattr(returned, '__name__', '')}, not what that gives: add its arguments"
    try:
        np.asarray(returned, dtype=float)
    except (TypeError, ValueError):
        kind = type(returned).__name__
        if isinstance(returned, tuple | list):
            return f"it returns a {kind} of {len(returned)} things that make no array: one array is asked for"
        return f"it returns {kind} that cannot be read as an array of numbers: {str(returned)[:60]!r}"
    return ""


def _alone(returned):
    """What no right answer is like: the same for every input, or whole numbers."""
    if all(np.array_equal(one, returned[0]) for one in returned):
        return f"it returns the same for every input: {shown(returned[0])}"
    if all(np.array_equal(one, np.round(one)) for one in returned):
        return "it holds whole numbers only: what was put in was cut off (an array of integers?)"
    return ""


def _nearly(returned, expected):
    """Rounded, or made with a number written by hand."""
    gap = max(np.abs(np.asarray(one) - other).max() for one, other in zip(returned, expected, strict=True))
    if gap < 0.01 * max(np.abs(one).max() for one in expected):
        return f"it is nearly right, the numbers are off by {gap:.1g}: is one rounded, or written by hand (3.14)?"
    return ""


def _given(task, case):
    named = sorted(zip(task.signature, case, strict=True), key=lambda one: is_run(one[1]))  # long ones at the end
    return "for " + ", ".join(f"{name} = {shown(value)}" for name, value in named)


def _example(task, case, expected, returned):
    if isinstance(returned, Failed):
        return returned.args[1]
    unit = f" {task.unit}" if task.unit else ""
    both = shown(expected), shown(returned)
    return f"{_given(task, case)}\nexpected{unit}: {both[0]}\nyours: {both[1]}" if both[0] != both[1] else ""
