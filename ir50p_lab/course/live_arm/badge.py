"""Whose code moves an arm, as found from the function that is given to a view."""

import inspect

from ir50p_lab.course import my_robot
from ir50p_lab.course.checking.judge_text import is_open
from ir50p_lab.course.robot.catalogue import ORDER, stays

_WEAKEST_FIRST = ("not written yet", "the course's", "on loan", "yours")


def badge_of(function, given=()):
    """Return whose code a view runs: "not written yet", "the course's", "on loan" or "yours".

    Of all the functions on which the view rests, the first of these that applies to one of them is returned.

    function: what draws or moves the arm, or None: "the course's". What it calls is looked up in the notebook and in
    `my_robot`; a function or table in which dots still stand is "not written yet".
    given: functions that the notebook gives, and that no badge counts.
    """
    found = set(_owners(function, set(map(id, given))))
    return next((words for words in _WEAKEST_FIRST if words in found), "the course's")


def _owners(thing, seen):
    """Yield the owner ("yours", "on loan", ...) of every function and table that a function uses."""
    thing = getattr(thing, "__func__", thing)  # of a method
    if id(thing) in seen:
        return
    seen.add(id(thing))
    if isinstance(thing, list | tuple):
        if any(one is ... for row in thing for one in (row if isinstance(row, list | tuple) else [row])):
            yield "not written yet"
    elif inspect.isfunction(thing):
        yield from _of_function(thing, seen)


def _of_function(function, seen):
    package = (function.__module__ or "").partition(".")[0]
    reached = [cell.cell_contents for cell in function.__closure__ or ()]
    if package == "my_robot":
        yield my_robot.whose(function.__name__)
        return
    if package == "ir50p_lab" and (function.__qualname__ in ORDER or stays(function.__qualname__)):
        yield "the course's"
        return
    if package != "ir50p_lab":
        yield "not written yet" if is_open(function) else "yours"
        names = _names(function.__code__)
        robots = names.intersection(ORDER) if "my_robot" in names else set()
        yield from map(my_robot.whose, robots)
        reached += [function.__globals__.get(name) for name in names - robots]
    for one in reached:
        yield from _owners(one, seen)


def _names(code):
    """All names that a code looks up outside itself, those of functions within it, too."""
    inner = [one for one in code.co_consts if hasattr(one, "co_names")]
    return set(code.co_names).union(*map(_names, inner))
