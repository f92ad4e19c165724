"""Why a picture was not used for a calibration: a closed list on which programs can act, with a text for the reader."""

from dataclasses import dataclass
from enum import StrEnum


class Reason(StrEnum):
    """Why a picture is left out; each value is the wording.

    They are tested in this order, and a picture gets the first that applies.
    """

    UNREADABLE = "unreadable"  # missing, empty, or no picture
    OTHER_SIZE = "other size"  # not the size of the other pictures
    NO_BOARD = "no board"  # nothing like a checkerboard in it
    WRONG_BOARD = "wrong board"  # a checkerboard with another number of corners
    CROPPED = "cropped"  # part of the board is outside the picture or covered
    BLURRED = "blurred"  # edges too soft to say where a corner is
    DUPLICATE = "duplicate"  # the board is where it was in an earlier picture
    OUTLIER = "outlier"  # its corners fit no camera that fits the others


@dataclass(frozen=True)
class Rejected:
    """A picture that was not used.

    name: file name or "picture 3"; index: its place among the given pictures; reason: Reason; detail: what was found,
    with numbers, and what to do.
    """

    name: str
    index: int
    reason: Reason
    detail: str

    def __str__(self):
        return f"{self.name}: {self.reason} ({self.detail})"


class NotUsable(Exception):  # noqa: N818 - inside the package: becomes a Rejected
    """A picture turns out not to be usable; has the Reason and the detail.

    seen: (columns, rows) of the board that was found, if it is another one, or a part of it.
    """

    def __init__(self, reason, detail, seen=None):
        super().__init__(f"{reason}: {detail}")
        self.reason, self.detail, self.seen = reason, detail, seen
