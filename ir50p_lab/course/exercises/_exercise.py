"""One exercise, and the judgement of an answer to it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ir50p_lab.course.exercises._answers import NotAnswered, Slip, Unreadable, shorten


@dataclass(frozen=True, eq=False)
class Exercise:
    """A question, its right answer, and the slips that deserve a message of their own.

    name: "pose-1"; task: the question in one line, no full stop at its end; kind: Number, Function
    or Choice, with the right answer; why: one line that a right answer earns; slips: at least three
    together with the kind's common ones; hint: said to a wrong answer that is no known slip.
    """

    name: str
    task: str
    kind: Any
    why: str
    slips: tuple[Slip, ...] = ()
    hint: str = ""

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
    text: one or two sentences. example: an input that fails, of a function, or "".
    """

    state: str
    text: str
    example: str = ""


def grade(exercise: Exercise, answer) -> Verdict:
    """Compare an answer with the exercise; never raises, whatever the answer does."""
    kind = exercise.kind
    try:
        if answer is Ellipsis:
            raise NotAnswered
        state, text, example = kind.judge(answer, exercise)
        return Verdict(state, f"right. {exercise.why}" if state == "right" else text.strip(), example)
    except NotAnswered:
        return Verdict("open", f"not answered yet. To find: {exercise.task}. Expected: {kind.wanted}.")
    except Unreadable as problem:
        return Verdict("unreadable", f"found {problem}; expected {kind.wanted}.")
    except Exception as error:
        reason = f"{type(error).__name__}: {shorten(error)}"
        what = f"an object of type {type(answer).__name__} that cannot be read ({reason})"
        return Verdict("unreadable", f"found {what}; expected {kind.wanted}.")
