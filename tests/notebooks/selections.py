"""Selections of the course, section by section: `minutes.py` writes the table into docs/instructor.md.

What a session needs, gives and takes is read from the notebooks.
"""

import re

import minutes
import nbformat
from notebook_runner import NOTEBOOKS

from ir50p_lab.course.robot.catalogue import function_of, is_function

START, END = "<!-- selections -->\n", "<!-- end of selections -->\n"
WHOLE = (1, 99)  # all sections, and the closing
#: Of each selection its sessions; of a session the sections of the core of a notebook, from the first to the last.
SELECTIONS = {
    "Four hours": ({"00": WHOLE}, {"08": (1, 5)}),
    "Two days": ({"00": WHOLE, "01": WHOLE, "02": WHOLE}, {"08": WHOLE, "09": WHOLE}),
    "A term on dynamics": tuple({number: WHOLE} for number in ("03", "04", "05", "06", "07")),
    "The whole order in fourteen sessions": (
        {"00": WHOLE},
        {"01": (1, 6)},
        {"02": (1, 4)},
        {"05": (1, 7)},
        {"06": (1, 4)},
        {"06": (8, 10), "07": (1, 3)},
        {"07": (6, 12)},
        {"08": (1, 3)},
        {"08": (4, 5)},
        {"12": (1, 5)},
        {"12": (6, 8), "13": (1, 4)},
        {"14": (1, 5)},
        {"14": (6, 8), "15": (1, 3)},
        {"17": (1, 1), "18": (1, 3)},
    ),
}


def cells_of(number, first, last):
    """(cells of the core, cells of more) of the sections from the first to the last; the first has the opening with it."""
    (path,) = (path for path in NOTEBOOKS if path.name.startswith(number))
    cells, section, found = nbformat.read(path, as_version=4).cells, 0, []
    for cell in cells:
        if heading := re.match(r"## (?:(\d+) |What you know now)", cell.source):
            section = int(heading[1] or 99)
        found += [cell] if (section or first) in range(first, last + 1) and (section or first == 1) else []
    core = {cell.id for cell in minutes.core_of(cells)}
    return [one for one in found if one.id in core], [one for one in found if one.id not in core]


def rows(sessions):
    """(sections, what they call that nobody has written yet, what they give, minutes of the core, of more) of each."""
    written = set()
    for session in sessions:
        both = [cells_of(number, *sections) for number, sections in session.items()]
        core, more = ([cell for one in both for cell in one[part]] for part in (0, 1))
        code = "\n".join(cell.source for cell in core if cell.cell_type == "code")
        gives = [name for name in re.findall(r'^check\("([\w.]+)"', code, re.M) if is_function(name)]
        calls = {name for name in re.findall(r"my_robot\.(\w+)", code) if is_function(name)}
        needs = sorted(calls - written - set(map(function_of, gives)))
        written |= set(gives)
        where = "; ".join(f"{number}: {_to(*sections)}" for number, sections in session.items())
        yield where, needs, gives, sum(minutes.counted(one[0]) for one in both), minutes.counted(more)


def _to(first, last):
    if (first, last) == WHOLE:
        return "its core"
    return str(first) if first == last else f"{first} to {last}"


def table():
    """The table as Markdown."""
    lines = ["| | sections | stands in | the students write | minutes | *more* |", "|---|---|---|---|---|---|"]
    for name, sessions in SELECTIONS.items():
        lines.append(f"| **{name}** | | | | | |")
        for number, (where, needs, gives, core, more) in enumerate(rows(sessions), 1):
            named = [", ".join(f"`{one}`" for one in names) or "-" for names in (needs, gives)]
            lines.append(f"| {number} | {where} | {named[0]} | {named[1]} | {core} | {more} |")
    return "\n".join(lines) + "\n"


def filled(page):
    """The page with the table as it is."""
    before, _, rest = page.partition(START)
    return before + START + "\n" + table() + "\n" + END + rest.partition(END)[2]
