"""An exercise, the judgement of an answer to it, and what every kind of answer shares; answers that are a choice."""

from dataclasses import dataclass
from functools import cached_property
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

    It has `right`; `wanted`, what is asked for in words, without the answer; and `read(answer)`, which may raise
    NotAnswered or Unreadable.
    """

    @property
    def solution(self):
        """The right answer in usable form."""
        return self.right

    def is_right(self, found) -> bool:
        """Tell whether an answer that was read is the right one."""
        return found == self.right

    def is_slip(self, found, wrong) -> bool:
        """Tell whether an answer that was read is that of a slip."""
        return found == wrong

    def show(self, found) -> str:
        """Repeat an answer that was read."""
        return repr(found)

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


@dataclass(frozen=True, eq=False)
class Choice(Kind):
    """One option out of several, as text: its key or its wording, capitals and spaces do not matter.

    right: key of the right option.
    options: {key: wording}, such as {"a": "the elbow is up", ...} or {"yes": "yes", "no": "no"}.
    """

    right: str
    options: dict[str, str]

    def __post_init__(self):
        """Refuse a right answer that is not among the options."""
        if self.right not in self.options:
            raise ValueError(f"the right answer {self.right!r} is none of {tuple(self.options)}")

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        return "one of " + ", ".join(repr(key) for key in self.options)

    def read(self, answer) -> str:
        """Return the key of the option that was meant; Unreadable where there is none."""
        if isinstance(answer, bool):
            answer = "yes" if answer else "no"
        if not isinstance(answer, str | int):
            raise Unreadable(kind_of(answer))
        said = _plain(str(answer))
        for key, wording in self.options.items():
            if said in (_plain(key), _plain(wording)):
                return key
        raise Unreadable(kind_of(answer) if isinstance(answer, str) else str(answer))


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


def _plain(text: str) -> str:
    return "".join(text.lower().strip(" .()'\"").split())
