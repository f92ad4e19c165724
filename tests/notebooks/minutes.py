"""How long a notebook takes: ``PYTHONPATH=. python tests/notebooks/minutes.py`` prints it and fills
README, the instructor's guide and the openings.

Sections are marked: who does the core alone needs less.

words/100 + 3 a prediction + 2 a panel + 6, 15 or 40 a function by its size + code lines/2, in steps of five minutes.
"""

import ast
import re
from itertools import pairwise

import nbformat
from notebook_runner import FOLDER, REWRITTEN, ROOT

from ir50p_lab.course.checking.tasks import of_notebook, task
from ir50p_lab.course.robot.catalogue import function_of, is_function, stays

README, INSTRUCTOR = ROOT / "README.md", ROOT / "docs" / "instructor.md"
SESSION = 90  # minutes
PANEL = re.compile(r"^(?:\w+\.)?(?:live|LiveArm|\w*(?:panel|slider)\w*)\(", re.M)


def minutes(path):
    """Minutes of a notebook, a multiple of five."""
    return counted(nbformat.read(path, as_version=4).cells)


def core(path):
    """Minutes of the core of a notebook: of all but the sections marked more."""
    return counted(core_of(nbformat.read(path, as_version=4).cells))


def core_of(cells):
    """The cells of the core: a mark holds until the next heading that has one; opening and closing belong to it."""
    mark, kept = "core", []
    for cell in cells:
        if cell.source.startswith("## What you know now"):
            mark = "core"
        for tag in ("core", "more"):
            mark = tag if tag in cell.metadata.get("tags", []) else mark
        if mark == "core":
            kept.append(cell)
    return kept


def counted(cells):
    """Minutes of some cells, a multiple of five."""
    text = "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
    code = "\n".join(cell.source for cell in cells if cell.cell_type == "code")
    checked = re.findall(r'\bcheck\("([\w.]+)"', code)
    functions = [name for name in checked if is_function(name)]
    here = [name for name in checked if stays(name)]
    lines = sum(bool(line.strip()) for line in code.splitlines())
    predictions, panels = len(re.findall(r"^predict\(", code, re.M)), len(PANEL.findall(code))
    sizes = {name: _size(task(name).solution_text) - _size(task(name).given) for name in functions}
    before = {name: sizes[one] for one, name in pairwise(functions) if function_of(one) == function_of(name)}
    written = sum(_writing(size - before.get(name, 0)) for name, size in sizes.items())
    written += sum(_writing(_size(of_notebook(name).solution_text)) for name in here)
    return 5 * round((len(text.split()) / 100 + 3 * predictions + 2 * panels + written + lines / 2) / 5)


def _size(solution):
    """Statements of a plain solution; what a stage has in common with the one before it is not written again."""
    return sum(isinstance(node, ast.stmt) for node in ast.walk(ast.parse(solution)))


def _writing(statements):
    """Minutes for a function of so many statements."""
    return 6 if statements <= 4 else 15 if statements <= 14 else 40


def rewritten():
    """The notebooks whose minutes are counted."""
    return [path for path in sorted(FOLDER.glob("[0-9A][0-9]_*.ipynb")) if path.name[:2] in REWRITTEN]


def _said(path):
    return f"{minutes(path)}, core {core(path)} ({sessions(path)})"


def sessions(path):
    """Sessions that the core of a notebook fills, in words."""
    number = -(-core(path) // SESSION)
    return "1 session" if number == 1 else f"{number} sessions"


def filled(text):
    """The text of README with its hours and the minutes of its table as counted."""
    paths = rewritten()
    for path in paths:
        text = re.sub(rf"(\| \[`{path.stem}`\].*\| )\d+[^|]*( \|)$", rf"\g<1>{_said(path)}\2", text, flags=re.M)
    numbers = {
        rf"(00 to {paths[-1].name[:2]} are )\d+( hours)": round(sum(map(minutes, paths)) / 60),
        r"(their core )\d+(\.)": round(sum(map(core, paths)) / 60),
        r"(a session is )\d+( of)": SESSION,
    }
    return _with(numbers, text)


def _before(path, words):
    """Minutes of the core of a notebook up to the cell that has these words."""
    cells = core_of(nbformat.read(path, as_version=4).cells)
    (end,) = [number for number, cell in enumerate(cells) if words in cell.source]
    return counted(cells[: end + 1])


def planned(text):
    """The text of docs/instructor.md with its hours and minutes as counted."""
    paths = rewritten()[:12]
    cores = [core(path) for path in paths]
    numbers = {
        r"(00 to 11 are )\d+( hours)": round(sum(map(minutes, paths)) / 60),
        r"(their core )\d+(; it)": round(sum(cores) / 60),
        r"(its core, )\d+( minutes)": cores[0],
        r"(on the first \()\d+( minutes)": sum(cores[:3]),
        r"(on the second \()\d+(\))": sum(cores[8:10]),
        r"(week \()\d+( to \d+ minutes of core)": min(cores[3:8]),
        r"(week \(\d+ to )\d+( minutes of core)": max(cores[3:8]),
        r"(sections 1 to 5 \()\d+( minutes)": _before(paths[8], "second good place for a break"),
        r"(so a session of )\d+( minutes)": SESSION,
    }
    return _with(numbers, text)


def _with(numbers, text):
    """The text with each number in its place: what stands before and behind it occurs once."""
    for place, number in numbers.items():
        text, found = re.subn(place, rf"\g<1>{number}\2", text)
        assert found == 1, place
    return text


def opening(path):
    """The text of a notebook's file with its minutes as counted."""
    text = path.read_text(encoding="utf-8")
    return re.sub(
        r"about \d+ minutes(, the core \d+( \(\d sessions?\))?)?",
        f"about {minutes(path)} minutes, the core {core(path)} ({sessions(path)})",
        text,
        count=1,
    )


if __name__ == "__main__":
    import selections

    for one in rewritten():
        print(f"{one.stem}: {_said(one)} min")
        one.write_text(opening(one), encoding="utf-8", newline="\n")
    README.write_text(filled(README.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
    page = selections.filled(planned(INSTRUCTOR.read_text(encoding="utf-8")))
    INSTRUCTOR.write_text(page, encoding="utf-8", newline="\n")
