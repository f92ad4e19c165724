"""An exercise, the grade of an answer to it, and what every kind of answer shares; answers that are a choice."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from ir50p_lab.course.exercises._display import Note


class NotAnswered(Exception):  # noqa: N818  (not an error: the stub)
    """The answer is still the stub."""


class Unreadable(Exception):  # noqa: N818  (turned into a sentence, never shown as an error)
    """The answer has the wrong form; the message names what was found."""


class Kind:
    """A kind of answer that is read, and then compared with the right one and with those of the slips.

    It has `right`; `wanted`, what is asked for in words, without the answer; `read(answer)`, which may raise
    NotAnswered or Unreadable; and `common_slips`, which every exercise of this kind knows.
    """

    common_slips: ClassVar = {}

    @property
    def solution(self):
        """The right answer in usable form."""
        return self.right

    def is_right(self, found) -> bool:
        """Tell whether an answer that was read is the right one."""
        return self.is_slip(found, self.right)

    def is_slip(self, found, wrong) -> bool:
        """Tell whether an answer that was read is that of a slip, read as well."""
        return found == wrong

    def show(self, found) -> str:
        """Repeat an answer that was read."""
        return repr(found)

    def read_wrong(self, wrong):
        """Return a slip's answer, read."""
        return self.read(wrong)

    def remark(self, found) -> str:
        """Say how far a wrong answer is right, without giving it away. Raises Unreadable where its form is wrong."""
        return ""

    def grade(self, answer, exercise) -> tuple[str, ...]:
        """Return the state, what to say, and one input that fails, if it is a function's."""
        found = self.read(answer)
        if self.is_right(found):
            return "right", f"right. {exercise.why}"
        for message, wrong in (exercise.slips | self.common_slips).items():
            if self.is_slip(found, self.read_wrong(wrong)):
                return "slip", f"not yet, found {self.show(found)}. {message}"
        # only now: the answer of a slip may have another shape, at which `remark` stops
        extra = " ".join(filter(None, (self.remark(found), exercise.hint)))
        return "wrong", f"not yet, found {self.show(found)}; expected {self.wanted}: {exercise.task}. {extra}"


@dataclass(frozen=True, eq=False)
class Choice(Kind):
    """One option out of several, as text: its key or its wording, capitals and spaces do not matter.

    right: key of the right option.
    options: {key: wording}, such as {"a": "the elbow is up", ...}.
    """

    right: str
    options: dict[str, str]

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        return "one of " + ", ".join(repr(key) for key in self.options)

    def read(self, answer) -> str:
        """Return the key of the option that was meant; Unreadable where there is none."""
        for key, wording in self.options.items():
            if _plain(str(answer)) in (_plain(key), _plain(wording)):
                return key
        raise Unreadable(str(answer) if isinstance(answer, int) else kind_of(answer))


@dataclass(frozen=True, eq=False)
class Exercise:
    """A question, its right answer, and the slips that deserve a message of their own.

    name: "pose-1"; task: the question in one line, no full stop at its end; kind: Number, Function
    or Choice, with the right answer; why: one line that a right answer earns; slips: {what to say: typical wrong
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


def _plain(text: str) -> str:
    return "".join(text.lower().strip(" .()'\"").split())
