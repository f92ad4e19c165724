"""One line of a table of targets, and how such a table is printed beside the thesis."""

from dataclasses import dataclass

_MARKS = {True: "met", False: "MISSED", None: ""}


@dataclass(frozen=True)
class Row:
    """What was asked, what came out, and what the thesis reports; all but `ok` are text for the reader."""

    what: str  # 'centre of the ball, median (1000 scenes)'
    target: str  # '<= 0.5 px'
    measured: str  # '0.12 px'
    thesis: str = "-"  # '18 px radius, no error given'; '-' where it says nothing
    ok: bool | None = None  # True: target met; False: missed; None: no target, for information


def table(rows, title=""):
    """The rows as one text table: columns as wide as their widest entry."""
    head = ("what", "target", "measured", "thesis", "")
    lines = [head, *((r.what, r.target, r.measured, r.thesis, _MARKS[r.ok]) for r in rows)]
    width = [max(len(line[i]) for line in lines) for i in range(len(head))]
    text = ["  ".join(cell.ljust(w) for cell, w in zip(line, width, strict=True)).rstrip() for line in lines]
    text.insert(1, "-" * (sum(width) + 2 * (len(width) - 1)))
    return "\n".join(([title, ""] if title else []) + text)
