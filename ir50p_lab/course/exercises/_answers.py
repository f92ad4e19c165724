"""An exercise, and the grade of an answer to it."""

from dataclasses import dataclass, field
from typing import Any

from ir50p_lab.course.checking.note import Note


class NotAnswered(Exception):  # noqa: N818  (not an error: the stub)
    """The answer is still the stub."""


class Unreadable(Exception):  # noqa: N818  (turned into a sentence, never shown as an error)
    """The answer has the wrong form; the message names what was found."""


@dataclass(frozen=True, eq=False)
class Exercise:
    """A question, its right answer, and the slips that deserve a message of their own.

    name: "pose-1"; task: the question in one line, no full stop at its end; kind: Number or Function,
    with the right answer; why: one line that a right answer earns; slips: {what to say: typical wrong
    answer, or a function that makes it from the right one}, at least three together with the kind's common ones, a
    sentence or two each on what is wrong and where to look, without the answer; hint: said to a wrong answer that is
    no known slip.
    """

    name: str
    task: str
    kind: Any
    why: str
    slips: dict = field(default_factory=dict)
    hint: str = ""


def grade(exercise: Exercise, answer) -> Note:
    """Compare an answer with the exercise; never raises, whatever the answer does.

    The state of the Note is "open" (still the stub), "right", "slip" (a known one), "wrong", or "unreadable".
    """
    kind, more = exercise.kind, ()
    try:
        if answer is Ellipsis:
            raise NotAnswered
        state, text, *more = kind.grade(answer, exercise)
    except NotAnswered:
        state, text = "open", f"not answered yet. To find: {exercise.task}. Expected: {kind.wanted}."
    except Unreadable as problem:
        state, text = "unreadable", f"found {problem}; expected {kind.wanted}."
    except Exception as error:
        reason = f"{type(error).__name__}: {shorten(error)}"
        what = f"an object of type {type(answer).__name__} that cannot be read ({reason})"
        state, text = "unreadable", f"found {what}; expected {kind.wanted}."
    failing = tuple(("one input that fails", example) for example in more if example)
    return Note(state, exercise.name, text.strip(), failing, open_first=True)


def kind_of(value) -> str:
    """Return what a value is, in words a student knows."""
    if value is None:
        return "None (is there a `return` missing?)"
    if isinstance(value, str):
        return f"the text {shorten(value, 40)!r}"
    if isinstance(value, bool) or type(value).__name__ == "bool":
        return str(value)
    if isinstance(value, complex):
        return "a complex number"
    if callable(value):
        name = getattr(value, "__name__", type(value).__name__)
        return f"the function {name}, not what it returns" if name != "<lambda>" else "a function, not what it returns"
    return f"an object of type {type(value).__name__}"


def shorten(text: object, limit: int = 160) -> str:
    """Return the first line of a text, cut to the limit."""
    line = next(iter(str(text).strip().splitlines()), "")
    return line if len(line) <= limit else line[: limit - 3] + "..."
