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


class Kind:
    """A kind of answer that is read, and then compared with the right one and with those of the slips.

    It has `solution`, the right answer in usable form; `wanted`, what is asked for in words, without the answer;
    `read(answer)`, which may raise NotAnswered or Unreadable; `is_right(found)`, `is_slip(found, wrong)` and
    `show(found)` of what was read.
    """

    @property
    def solution(self):
        """The right answer in usable form."""
        return self.right

    def check_form(self, found) -> None:
        """Raise Unreadable if an answer that was read has not the form of the right one."""

    def read_wrong(self, wrong):
        """Return a slip's answer, read."""
        return self.read(wrong)

    def remark(self, found) -> str:
        """Say how far a wrong answer is right, without giving the answer away."""
        return ""

    def common_slips(self) -> tuple[Slip, ...]:
        """Slips that every exercise of this kind knows."""
        return ()

    def judge(self, answer, exercise) -> tuple[str, str, str]:
        """Return the state, what to say, and one input that fails or "": see Verdict."""
        found = self.read(answer)
        if self.is_right(found):
            return "right", "", ""
        for slip in exercise.all_slips:
            if self.is_slip(found, self.read_wrong(slip.wrong)):
                return "slip", f"not yet, found {self.show(found)}. {slip.message}", ""
        self.check_form(found)  # after the slips: a slip may have another shape
        extra = " ".join(filter(None, (self.remark(found), exercise.hint)))
        return "wrong", f"not yet, found {self.show(found)}; expected {self.wanted}: {exercise.task}. {extra}", ""


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
