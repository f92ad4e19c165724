"""How a student's function is called: it gets copies, its errors become sentences, and a changed input is noticed."""

import copy
import inspect

import numpy as np

from ir50p_lab.course.checking.explain_error import why_it_stops
from ir50p_lab.course.checking.shape_checks import no_numbers
from ir50p_lab.course.checking.task import Failed, is_run, short_text


def check_signature(task, function, case):
    """Raise Failed if a function cannot be called with the arguments of a case."""
    try:
        inspect.signature(function).bind(*case)
    except TypeError:
        found = ", ".join(inspect.signature(function).parameters)
        wanted = ", ".join(task.signature)
        raise Failed(f"it takes ({found}); it will be called with ({wanted}), in this order") from None


def call(task, function, case):
    """Return what a function returns for a case. Raises Failed, which says why, if it stops or changes its input."""
    mine = copy.deepcopy(case)
    try:
        result = call_or_fail(lambda: function(*mine), lambda: case_in_words(task, case))
    except Failed as stopped:
        if isinstance(stopped.__cause__, KeyboardInterrupt):
            raise
        return stopped
    for name, one, other in zip(task.signature, case, mine, strict=True):
        if not (callable(one) or np.array_equal(np.asarray(one), np.asarray(other))):
            says = f"it changes what it was given, `{name}`: work on a copy (`np.array(x)` makes one)"
            raise Failed(says, case_in_words(task, case))
    return result


def call_or_fail(do, case=str):
    """Return what `do()` returns; raise Failed from its error. case: function that names the case, called only then."""
    try:
        with np.errstate(all="ignore"):
            return do()
    except Failed:
        raise
    except KeyboardInterrupt as stop:
        raise Failed("it was stopped: does a loop in it never end?", case()) from stop
    except Exception as error:
        raise Failed(why_it_stops(error), case()) from error


def array_like(expected, function, *arguments, **named):
    """Return what a function in a view returns, as an array like the expected one; dots count as 0. Raises Failed."""
    returned = call_or_fail(lambda: function(*arguments, **named))
    if isinstance(returned, np.ndarray) and returned.dtype == object:
        returned = np.where(returned == ..., 0, returned)
    if says := no_numbers(returned, expected):
        raise Failed(f"{getattr(function, '__name__', 'your function')}: {says}")
    return np.array(returned, dtype=float)


def case_in_words(task, case):
    """Return the arguments of a case in words."""
    named = sorted(zip(task.signature, case, strict=True), key=lambda one: is_run(one[1]))  # long ones at the end
    return "for " + ", ".join(f"{name} = {short_text(value)}" for name, value in named)
