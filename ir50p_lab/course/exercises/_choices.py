"""Answers that are one of a few options."""

from __future__ import annotations

from dataclasses import dataclass

from ir50p_lab.course.exercises._answers import Kind, Unreadable, kind_of


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

    def is_right(self, found) -> bool:
        """Tell whether the key is that of the right option."""
        return found == self.right

    def is_slip(self, found, wrong) -> bool:
        """Tell whether the key is that of the slip."""
        return found == wrong

    def show(self, found) -> str:
        """Repeat the option that was chosen."""
        return repr(found)


def _plain(text: str) -> str:
    return "".join(text.lower().strip(" .()'\"").split())
