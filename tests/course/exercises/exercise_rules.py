"""What must hold for every exercise of every module; `problems(exercise)` lists what does not."""

import re
import warnings

import numpy as np
import sympy

from ir50p_lab.course.exercises import Function, Number, grade

SEED = 20261121


def problems(exercise):
    """Return what is wrong with an exercise, as a list of sentences (empty: all is well)."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return [*_shape(exercise), *_right(exercise), *_stubs(exercise), *_slips(exercise), *_wrong(exercise)]


def _shape(exercise):
    if not re.fullmatch(r"[a-z]+-[1-9]\d*", exercise.name):
        yield f"name {exercise.name!r} is not prefix-number"
    for what, text in (("task", exercise.task), ("why", exercise.why)):
        if not text.strip() or "\n" in text or len(text) > 220:
            yield f"{what} is not one line"
    if exercise.task.endswith((".", "?")):
        yield "the task ends in a full stop"
    for message in _messages(exercise):
        if not 15 <= len(message) <= 260 or message[-1] not in ".?:":
            yield f"message {message!r} is not one or two sentences"
    for text in (exercise.task, exercise.hint, exercise.kind.wanted, *_messages(exercise)):
        for secret in secrets(exercise):
            if secret in text and secret not in exercise.task:
                yield f"{text!r} gives the answer away: {secret}"


def _right(exercise):
    for form in right_forms(exercise):
        verdict = grade(exercise, form)
        if verdict.state != "right" or exercise.why not in verdict.text:
            yield f"right answer {form!r} is {verdict.state}: {verdict.text}"


def _stubs(exercise):
    for stub in stubs(exercise):
        verdict = grade(exercise, stub)
        if verdict.state != "open" or "not answered yet" not in verdict.text or exercise.task not in verdict.text:
            yield f"stub {stub!r} is {verdict.state}: {verdict.text}"


def _messages(exercise):
    """What is said to the author's slips and to those that all exercises of the kind know."""
    return list(exercise.slips | _common(exercise.kind))


def _common(kind):
    return kind.common_slips if isinstance(kind, Number) else {}


def _slips(exercise):
    if len(_messages(exercise)) < 3:
        yield f"only {len(_messages(exercise))} slips"
    for message, wrong in exercise.slips.items():
        verdict = grade(exercise, wrong_answer(exercise.kind, wrong))
        if verdict.state != "slip" or not verdict.text.endswith(message):
            yield f"slip {message!r} is answered by {verdict.state}: {verdict.text}"
    for message, wrong in _common(exercise.kind).items():  # one of the author's may say more of the same answer
        verdict = grade(exercise, wrong_answer(exercise.kind, wrong))
        if verdict.state not in ("slip", "right"):  # 0 is right with either sign
            yield f"slip {message!r} is answered by {verdict.state}: {verdict.text}"


def _wrong(exercise):
    verdict = grade(exercise, random_wrong(exercise.kind))
    if verdict.state != "wrong" or exercise.kind.wanted not in verdict.text:
        yield f"a random wrong answer is {verdict.state}: {verdict.text}"
    for junk in JUNK:
        verdict = grade(exercise, junk)
        if verdict.state not in ("unreadable", "wrong", "slip"):
            yield f"{junk!r} is {verdict.state}"
        if not 10 < len(verdict.text) < 700 or "Traceback" in verdict.text:
            yield f"{junk!r} gets {verdict.text!r}"
        if any(secret in verdict.text and secret not in exercise.task for secret in secrets(exercise)):
            yield f"{junk!r} is told the answer: {verdict.text!r}"


class Hostile:
    """An object that raises whatever is done with it."""

    def __getattr__(self, name):
        raise RuntimeError("no")

    __call__ = __array__ = __iter__ = __float__ = __len__ = __repr__ = __str__ = __eq__ = __getattr__
    __hash__ = object.__hash__


def _raises(*_):
    raise ZeroDivisionError("my bug")


JUNK = (
    None,
    "what?",
    "",
    [],
    {},
    set(),
    np.nan,
    np.inf,
    [np.nan] * 3,
    [1, [2, 3]],
    np.full((4, 4), np.nan),
    np.zeros((2, 3, 5)),
    1 + 2j,
    object(),
    int,
    print,
    _raises,
    lambda: 1,
    lambda *a: a.clear() if not isinstance(a, tuple) else None,
    lambda *a: "text",
    lambda *a: a,
    sympy.Symbol("bogus"),
    sympy.Eq(sympy.Symbol("a"), 1),
    [1, ..., 3],
    Hostile(),
)


def stubs(exercise):
    """Return what the student has before answering."""

    def dots(*args): ...

    def described(*args):
        """Return nothing yet."""

    if isinstance(exercise.kind, Function):
        return [..., dots, described]
    return [..., (..., ...), [..., ..., ...]]


def right_forms(exercise):
    """Return the right answer in all the forms that must be accepted."""
    right, kind = solution_of(exercise.kind), exercise.kind
    return [right, *_FORMS[type(kind)](kind, right)]


def solution_of(kind):
    """Return the right answer as `solution` does."""
    return kind.right if callable(kind.right) else kind.right[()]


def _number_forms(kind, right):
    array = np.asarray(right)
    forms = [array, array.tolist(), sympy.sympify(array.tolist()), np.float64(right) if array.ndim == 0 else right]
    if array.ndim == 1:
        forms += [tuple(array), array[:, None], array[None, :], sympy.Matrix(array)]
        forms += [[sympy.Float(entry, 30) for entry in array]]
    if array.ndim == 2:
        forms += [sympy.Matrix(array), [list(row) for row in array], tuple(map(tuple, array))]
    if array.ndim == 0:
        forms += [[right], sympy.Float(right, 30)]
    if np.all(array == np.round(array)):
        forms.append(array.astype(int))
    if kind.angle:
        forms += [array + 2 * np.pi, array - 4 * np.pi]
    return forms


def _function_forms(kind, right):
    forms = [lambda *args: right(*args), lambda *args: np.asarray(right(*args)).tolist()]
    return [*forms, lambda *args: np.asarray(right(*args))[..., None], lambda *args: tuple(np.ravel(right(*args)))][
        : 4 if np.ndim(right(*kind._inputs[0])) == 1 else 3
    ]


_FORMS = {Number: _number_forms, Function: _function_forms}


def wrong_answer(kind, wrong):
    """Return the student's answer that belongs to a slip."""
    return wrong(kind.right[()]) if callable(wrong) and isinstance(kind, Number) else wrong


def random_wrong(kind):
    """Return an answer of the right form that is wrong in no known way."""
    rng = np.random.default_rng(SEED)

    def moved(value):
        return np.asarray(value) + rng.uniform(3.3, 3.9, np.shape(value)) * (1 + np.abs(value))

    if isinstance(kind, Number):
        return moved(kind.right)
    return lambda *args: moved(kind.right(*args))


def secrets(exercise):
    """Return texts that no message may contain: the answer, where it is long enough to be recognised."""
    if not isinstance(exercise.kind, Number):
        return set()
    texts = {f"{abs(x):.{digits}g}" for x in np.ravel(exercise.kind.right) for digits in (3, 4, 5)}
    return {text for text in texts if len(text.replace(".", "").strip("0")) >= 3}
