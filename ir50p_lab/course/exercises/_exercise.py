"""One exercise, and the judgement of an answer to it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ir50p_lab.course.exercises._answers import NotAnswered, Slip, Unreadable, shorten


@dataclass(frozen=True, eq=False)
class Exercise:
    """A question, its right answer, and the slips that deserve a message of their own.

    name: "pose-1"; task: the question in one line, no full stop at its end; kind: Number, Function,
    Expression or Choice, with the right answer; why: one line that a right answer earns; slips: at least three
    together with the kind's common ones; hint: said to a wrong answer that is no known slip; forms: other right
    answers, for the tests.
    """

    name: str
    task: str
    kind: Any
    why: str
    slips: tuple[Slip, ...] = ()
    hint: str = ""
    forms: tuple = ()

    @cached_property
    def all_slips(self) -> tuple[Slip, ...]:
        """The author's slips, then the common ones that none of them covers."""
        wrong = [self.kind.read_wrong(slip.wrong) for slip in self.slips]
        common = [
            slip
            for slip in self.kind.common_slips()
            if not any(self.kind.is_slip(self.kind.read_wrong(slip.wrong), one) for one in wrong)
        ]
        return (*self.slips, *common)


@dataclass(frozen=True)
class Verdict:
    """What to say to an answer.

    state: "open" (still the stub), "right", "slip" (a known one), "wrong", or "unreadable" (wrong form).
    text: one or two sentences.
    """

    state: str
    text: str


def grade(exercise: Exercise, answer) -> Verdict:
    """Compare an answer with the exercise; never raises, whatever the answer does."""
    kind = exercise.kind
    if answer is Ellipsis:
        return _not_answered(exercise)
    try:
        found = kind.read(answer)
        if kind.is_right(found):
            return Verdict("right", f"right. {exercise.why}")
        for slip in exercise.all_slips:
            if kind.is_slip(found, kind.read_wrong(slip.wrong)):
                return Verdict("slip", f"not yet, found {kind.show(found)}. {slip.message}")
        kind.check_form(found)  # after the slips: a slip may have another shape
        extra = " ".join(filter(None, (kind.remark(found), exercise.hint)))
        text = f"not yet, found {kind.show(found)}; expected {kind.wanted}: {exercise.task}. {extra}"
        return Verdict("wrong", text.strip())
    except NotAnswered:
        return _not_answered(exercise)
    except Unreadable as problem:
        return Verdict("unreadable", f"found {problem}; expected {kind.wanted}.")
    except Exception as error:
        reason = f"{type(error).__name__}: {shorten(error)}"
        what = f"an object of type {type(answer).__name__} that cannot be read ({reason})"
        return Verdict("unreadable", f"found {what}; expected {kind.wanted}.")


def _not_answered(exercise: Exercise) -> Verdict:
    return Verdict("open", f"not answered yet. To find: {exercise.task}. Expected: {exercise.kind.wanted}.")
