"""Right answers spoilt in all the usual ways: a wrong answer is recognised by the numbers it shares with one."""

import math
from functools import cache

import numpy as np

from ir50p_lab.course.checking.task import Mistake, nth_result, table

_MANY = 6  # longer ones are runs: no part of them has a meaning of its own


@cache
def _changes(name):
    """A table with expressions in x: pairs (words, function)."""
    names = {"np": np, "with_turn": _with_turn}
    return [(says, eval(f"lambda x: {expression}", names)) for says, (expression,) in table(name)]


def distortions(task):
    """Yield the usual Mistakes in a task: results misplaced, arguments misread."""
    yield from _of_results(task)
    yield from _of_arguments(task)


def _of_arguments(task):
    case = task.cases()[0]
    for k, (name, value) in enumerate(zip(task.signature, case, strict=True)):
        if callable(value) or isinstance(value, str):
            continue
        for says, change in _readings(name, np.asarray(value)):
            yield Mistake(_reading(task, k, change), says)
        one = f"{name} = {value}" if np.ndim(value) == 0 else f"one {name}"
        yield Mistake(_reading(task, k, lambda _, value=value: value), f"{one} is built in, whatever is passed in")
    for k in range(len(case)):
        for m in range(k):
            if np.shape(case[k]) == np.shape(case[m]) and not (callable(case[k]) or callable(case[m])):
                says = f"{task.signature[m]} and {task.signature[k]} have changed places"
                order = [k if one == m else m if one == k else one for one in range(len(case))]
                yield Mistake(lambda *case, order=order: task.reference(*(case[one] for one in order)), says)


def _readings(name, value):
    """Pairs (words, change) for one argument."""
    if value.ndim > 1:
        return [(says.format(name), change) for says, change in _changes("of_tables")]
    found = [(says.format(name), change) for says, change in _changes("of_numbers")]
    if value.ndim == 1 and len(value) <= _MANY:
        parts = [f"{name}[{j}]" for j in range(len(value))]
        for j, part in enumerate(parts):
            found += [(says.format(part), _on_part(j, change)) for says, change in _changes("of_numbers")]
            for i in range(j):
                found += [(f"{parts[i]} and {part} have changed places", _swapped(i, j))]
                for sign, word in ((1, "+"), (-1, "-")):
                    says = f"{part} counts as {part} {word} {parts[i]}: from where is it measured?"
                    found += [(says, _on_part([i, j], lambda x, sign=sign: x @ [[1, sign], [0, 1]]))]
    return found


def _of_results(task):
    """Yield Mistakes: what is right is returned in another form, place, sign or unit."""
    if task.results:
        yield from _of_order(task)
        return
    for says, change in _changes("of_results"):
        yield Mistake(_result(task, change), says)
    shape = np.shape(next(one for one in (task.reference(*case) for case in task.cases()) if one is not None))
    if not shape:
        return
    parts = task.entry_names or [f"{'column' if len(shape) > 1 else 'number'} {j + 1}" for j in range(shape[-1])]
    for j, part in enumerate(parts[:_MANY]):
        for says, change in _changes("of_parts"):
            yield Mistake(_result(task, _on_part(j, change)), says.format(part))
        for i in range(j):
            yield Mistake(_result(task, _swapped(i, j)), f"{parts[i]} and {part} have changed places")
        yield Mistake(_result(task, lambda y, j=j: y[..., j]), f"it returns {part} alone")
        yield Mistake(_result(task, lambda y, j=j: np.delete(y, j, axis=-1)), f"{part} is missing")
    for i in range(min(shape[0], _MANY)) if len(shape) > 1 and task.compare is None else ():
        for says, change in _changes("of_parts") if len(shape) == 2 else ():
            yield Mistake(_result(task, _on_rows(_on_part(i, change))), says.format(f"row {i + 1}"))
        for j in range(i):
            yield Mistake(_result(task, _on_rows(_swapped(i, j))), f"rows {j + 1} and {i + 1} have changed places")


def _of_order(task):
    """Yield Mistakes: of several results two in each other's place, or one alone."""
    names = task.results
    for j, name in enumerate(names):
        yield Mistake(nth_result(task.reference, j), f"it returns {name} alone: {', '.join(names)} are asked for")
        for i in range(j):
            order = [j if one == i else i if one == j else one for one in range(len(names))]
            yield Mistake(_in_order(task, order), f"{names[i]} and {name} have changed places")


def _in_order(task, order):
    def wrong(*case):
        right = task.reference(*case)
        return tuple(right[k] for k in order)

    return wrong


def _reading(task, k, change):
    return lambda *case: task.reference(*case[:k], change(case[k]), *case[k + 1 :])


def _result(task, change):
    def wrong(*case):
        right = task.reference(*case)
        return right if right is None or np.size(right) == 0 else change(np.asarray(right, dtype=float))

    return wrong


def _on_part(j, change):
    """A change of column j, or of a list of columns."""

    def edit(value):
        value = np.array(value, dtype=float)
        value[..., j] = change(value[..., j])
        return value

    return edit


def _swapped(i, j):
    return _on_part([i, j], lambda x: x[..., ::-1])


def _on_rows(change):
    return lambda value: np.moveaxis(change(np.moveaxis(value, 0, -1)), -1, 0)


def _with_turn(y, turned):
    y = y.copy()
    y[..., :3, :3] = turned[..., :3, :3]
    return y


# ------------------------------------------------------------------------------------------- what needs no suspicion
def entries(task, cases, returned, expected):
    """Return a sentence on the entries that are wrong, if they are few and always the same; else ""."""
    shape = np.shape(expected[0])
    if not shape or any(np.shape(one) != shape for one in (*returned, *expected)):
        return ""
    found, right = np.array(returned, dtype=float), np.array(expected, dtype=float)
    wrong = [place for place in np.ndindex(shape) if not _alike(task, found[:, *place], right[:, *place])]
    if not 0 < len(wrong) <= min(3, math.prod(shape) // 3):
        return ""
    if len(wrong) == 2 and all(_alike(task, found[:, *a], right[:, *b]) for a, b in (wrong, wrong[::-1])):
        return f"all is right except that {_name(task, wrong[0])} and {_name(task, wrong[1])} have changed places"
    return "all is right except that " + "; ".join(_entry(task, place, cases, found, right) for place in wrong)


def _entry(task, place, cases, found, right):
    numbers, name = found[:, *place], _name(task, place)
    if _alike(task, numbers, -right[:, *place]):
        return f"{name} has the wrong sign"
    if np.ptp(numbers) == 0:
        return f"{name} is always {numbers[0]:g}"
    belonging = {f"what belongs in {_name(task, other)}": right[:, *other] for other in np.ndindex(right.shape[1:])}
    for what, values in (_arguments(task, cases) | belonging).items():
        for sign, words in ((1, ""), (-1, "minus ")):
            if _alike(task, numbers, sign * values):
                return f"{name} holds {words}{what}"
    return f"{name} is wrong"


def _arguments(task, cases):
    """{name: its values} of the numbers that come in one by one."""
    given = zip(task.signature, zip(*cases, strict=True), strict=True)
    return {name: np.array(values) for name, values in given if np.ndim(values[0]) == 0}


def _name(task, place):
    if task.entry_names and len(place) == 1:
        return task.entry_names[place[0]]
    words = ("row", "column") if len(place) < 3 else ("number", "row", "column")
    return ", ".join(f"{word} {k + 1}" for word, k in zip(words, place, strict=False))


def _alike(task, a, b):
    return np.allclose(a, b, atol=task.tolerance, rtol=0)
