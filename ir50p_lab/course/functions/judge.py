"""Try a student's function on many inputs and say in a sentence what was found."""

import copy
import inspect
from dataclasses import dataclass

import numpy as np

from ir50p_lab.course.functions.task import Failed, shown


@dataclass(frozen=True)
class Verdict:
    """state: "right" or "wrong"; says: one or two sentences; example: one failing input with both answers, or ""."""

    state: str
    says: str
    example: str = ""


def judge(task, function):
    """Return the Verdict on a function or class, whatever it does."""
    if task.tried is not None:
        try:
            return Verdict("right", task.tried(function))
        except Failed as failed:
            return Verdict("wrong", *failed.args)
    cases = task.cases()
    try:
        _check_signature(task, function, cases[0])
        returned = [_call(task, function, case) for case in cases]
    except Failed as failed:
        return Verdict("wrong", *failed.args)
    expected = [task.right(*copy.deepcopy(case)) for case in cases]
    good = [_agrees(task, one, other) for one, other in zip(returned, expected, strict=True)]
    if all(good):
        return _judge_type(task, returned, expected)
    first = good.index(False)
    example = _example(task, cases[first], expected[first], returned[first])
    for slip in task.slips:
        if all(_is_slip(task, slip, case, one) for case, one in zip(cases, returned, strict=True)):
            return Verdict("wrong", slip.says, example)
    says = no_numbers(returned[first], expected[first]) or (task.symptom and task.symptom(cases, returned, expected))
    return Verdict("wrong", says or _which(task, cases, good), example)


def _check_signature(task, function, case):
    try:
        inspect.signature(function).bind(*case)
    except TypeError:
        found = ", ".join(inspect.signature(function).parameters)
        wanted = ", ".join(task.signature)
        raise Failed(f"it takes ({found}); it will be called with ({wanted}), in this order") from None


def _call(task, function, case):
    given = copy.deepcopy(case)
    try:
        with np.errstate(all="ignore"):
            result = function(*given)
    except KeyboardInterrupt:
        raise Failed("it was stopped: does a loop in it never end?", _given(task, case)) from None
    except Exception as error:
        raise Failed(f"it stops with {type(error).__name__}: {error}", _given(task, case)) from None
    if not all(_untouched(one, other) for one, other in zip(case, given, strict=True)):
        raise Failed("it changes what it was given: work on a copy (`np.array(x)` makes one)", _given(task, case))
    return result


def _untouched(before, after):
    return callable(before) or np.array_equal(np.asarray(before), np.asarray(after))


def _agrees(task, returned, expected):
    try:
        return task.agrees(returned, expected)
    except (TypeError, ValueError):
        return False


def _is_slip(task, slip, case, returned):
    try:
        with np.errstate(all="ignore"):
            wrong = slip.wrong(*copy.deepcopy(case))
        return task.agrees(returned, wrong)
    except Exception:
        return False


def _judge_type(task, returned, expected):
    """The numbers are right; what the next functions need is an array, too."""
    for one, other in zip(returned, expected, strict=True):
        if isinstance(other, np.ndarray) and not isinstance(one, np.ndarray):
            kind = type(one).__name__
            return Verdict(
                "wrong",
                f"the numbers are right, but it returns a {kind}: later functions will slice it, so "
                "return an array, `np.array(...)`",
            )
    return Verdict("right", "")


def no_numbers(returned, expected):
    """Mistakes that look alike in every function: nothing returned, another kind of thing, another shape."""
    if returned is None and expected is not None:
        return "it returns nothing: is there a `return`, and is it reached in every case?"
    if expected is None or returned is None:
        return ""
    if returned is Ellipsis:
        return "the dots are still in it"
    if callable(returned):
        return f"it returns the function {getattr(returned, '__name__', '')}, not what that gives: add its arguments"
    try:
        array = np.asarray(returned, dtype=float)
    except (TypeError, ValueError):
        return (
            f"it returns {type(returned).__name__} that cannot be read as an array of numbers: {str(returned)[:60]!r}"
        )
    wanted = np.shape(expected)
    if array.shape != wanted and len(wanted) and wanted[0]:
        return f"it returns an array of shape {array.shape}; expected is {wanted}"
    if not np.isfinite(array).all() and np.isfinite(np.asarray(expected, dtype=float)).all():
        return "it returns a number that is not finite (nan or inf): a division by zero, a root of less than nothing?"
    return ""


def _which(task, cases, good):
    """Say how often it is right, and whether the others have something in common."""
    bad = [case for case, fine in zip(cases, good, strict=True) if not fine]
    fine = [case for case, fine in zip(cases, good, strict=True) if fine]
    for words, is_such in task.where.items():
        if all(is_such(*case) for case in bad) and not any(is_such(*case) for case in fine):
            return f"it goes wrong exactly where {words}; everywhere else it is right"
    for words, is_such in task.where.items():
        if fine and all(is_such(*case) for case in bad):
            return f"it is right for {len(fine)} of {len(cases)} inputs; all the wrong ones have {words}"
    return f"it is right for {len(fine)} of {len(cases)} inputs" if fine else "not yet"


def _given(task, case):
    return "for " + ", ".join(f"{name} = {shown(value)}" for name, value in zip(task.signature, case, strict=True))


def _example(task, case, expected, returned):
    unit = f" {task.unit}" if task.unit else ""
    return f"{_given(task, case)}\nexpected{unit}: {shown(expected)}\nyours: {shown(returned)}"
