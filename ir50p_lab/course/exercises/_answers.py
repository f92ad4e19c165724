"""What every kind of answer shares: slips, and the two ways in which an answer cannot be judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


class NotAnswered(Exception):  # noqa: N818  (not an error: the stub)
    """The answer is still the stub."""


class Unreadable(Exception):  # noqa: N818  (turned into a sentence, never shown as an error)
    """The answer has the wrong form; the message names what was found."""


@dataclass(frozen=True, eq=False)
class Slip:
    """A typical wrong answer and what to say to it.

    wrong: the wrong answer itself, or (for numbers and expressions) a function that makes it from the right
        one, such as np.negative; for a function exercise the wrong function.
    message: what is wrong and where to look, one or two sentences, without the right answer.
    """

    wrong: Any
    message: str


def worth_having(slips, kind) -> tuple[Slip, ...]:
    """Return the slips whose wrong answer differs from the right one (the sign of zero is no slip)."""
    return tuple(slip for slip in slips if not kind.is_right(kind.read_wrong(slip.wrong)))


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
