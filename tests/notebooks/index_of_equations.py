"""Where each numbered equation, table and figure of the thesis is taught: `docs/index_of_equations.md`.

`python tests/notebooks/index_of_equations.py` writes it anew, from `docs/thesis_contents.csv` (what the thesis has, and which
notebook is its home), the texts of the notebooks, and the docstrings of package and tests. A mention that disappears
changes the file, and a test says so.
"""

import ast
import csv
import json
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
INDEX = ROOT / "docs" / "index_of_equations.md"
REASONS = {  # rows of the rewritten notebooks that are left out on purpose
    "1 History": "origin and definition of the word robot: no part of a lab book",
    "1.2": "a statement of the problem; 01 asks it as a question",
    "1.3.1": "a statement of the problem; 03 asks it as a question",
    "1.4": "a statement of the problem; 02 asks it as a question",
    "3 Objectives, 6 Outline": "00 shows the list of what will be the student's instead",
    "Abbreviations": "a folded list at the end of 00",
    "Notations": "a folded table at the end of 00",
    "Introduction a-e": "folded in 00, section 1",
    "2 IR50P/ROB3i, Fig 1": "folded in 00, section 1; drawn by LiveArm",
    "4 Software": "README, From MATLAB and Simulink",
    "1.1.2b": "the twelve sequences: A2, section 1",
    "(1.7) singularity": "A2, section 2",
    "(energy, Mdot - 2C)": "not in the thesis",
    "2.1": "a statement of the problem; 08 asks it as a task",
    "2.1.1a saturation": "08, sections 4 and 5",
    "ERRATA 2 poses": "tests/modelling",
    "ERRATA 2 states": "tests/modelling",
    "2.2.2 non-parametric": "09, section 4: the answer to a step, and to a blow",
    "2.2.2 tuning": "09, section 4: rules for speed and angle",
    "sweeps elsewhere": "A2, section 5",
    "gain map, FOPDT, rules": "09, sections 4 and 6",
    "kick, windup, delay, friction": "09, section 2",
}


def equations(text):
    """Numbers of equations in a text, ranges of up to ten written out: {"1.4", ...}."""
    numbers = set(re.findall(r"\((\d\.\d+)[^)\d]*(?=[),;\s-])", text))
    for group in re.findall(r"\(([^()]*\d\.\d+[^()]*)\)", text):
        numbers |= set(re.findall(r"(?<![\d.])\d\.\d+(?![\d.])", group))
    for chapter, first, last in re.findall(r"\((\d)\.(\d+)\)?\s*(?:-|\u2013|to)\s*\(?\1\.(\d+)", text):
        if int(first) < int(last) <= int(first) + 14:
            numbers |= {f"{chapter}.{k}" for k in range(int(first), int(last) + 1)}
    return numbers


def labels(text):
    """Tables and figures named in a text: {"Table 1.1", "Figure 1.8", ...}."""
    found = set()
    for kind, first, last in re.findall(
        r"(Table|Fig(?:ure)?)s? (\d(?:\.\d+)?)(?:[a-z](?:,[a-z])?)?(?:-(\d\.\d+))?", text
    ):
        kind = "Table" if kind == "Table" else "Figure"
        found.add(f"{kind} {first}")
        if last:
            chapter, a = first.split(".")
            found |= {f"{kind} {chapter}.{k}" for k in range(int(a), int(last.split(".")[1]) + 1)}
    return found


def tags(text):
    """All of both."""
    return equations(text) | labels(text)


def notebook_mentions():
    """{tag: [notebook, section]} from the texts of all notebooks."""
    found = {}
    for path in sorted((ROOT / "notebooks").glob("[0-9A][0-9]_*.ipynb")):
        section = ""
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            text = "".join(cell["source"])
            if cell["cell_type"] != "markdown":
                continue
            for part in re.split(r"(?m)^(?=##+ )", text):
                heading = re.match(r"##+ (\S+)", part)
                section = heading[1] if heading else section
                for tag in tags(part):
                    found.setdefault(tag, []).append(f"{path.name[:2]} {section}".strip())
    return found


@cache
def docstring_mentions(folder):
    """{tag: [place]} from the docstrings below a folder: of functions for the package, of files for tests."""
    found = {}
    for path in sorted((ROOT / folder).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in [tree, *ast.walk(tree)]:
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                name = getattr(node, "name", path.stem)
                for tag in tags(ast.get_docstring(node) or ""):
                    found.setdefault(tag, []).append(name if folder == "ir50p_lab" else path.stem)
        if folder == "tests":
            for tag in tags(path.read_text(encoding="utf-8")):
                found.setdefault(tag, []).append(path.stem)
    return found


def rows():
    """(thesis, what, home, notebooks, functions, tests) for each row of the contents."""
    in_notebooks, in_package, in_tests = (
        notebook_mentions(),
        docstring_mentions("ir50p_lab"),
        docstring_mentions("tests"),
    )
    with (ROOT / "docs" / "thesis_contents.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            wanted = tags(row["thesis"] + " ")
            places = [
                sorted({p for tag in wanted for p in found.get(tag, [])})
                for found in (in_notebooks, in_package, in_tests)
            ]
            yield row["thesis"], row["what"], row["home"], *places


def text():
    """The index as Markdown."""
    lines = [
        "# Where everything of the thesis is taught",
        "",
        "Made by `python tests/notebooks/index_of_equations.py` from the texts of the notebooks and the docstrings. *Home* is the",
        "notebook in which it belongs; a number without a notebook yet is one to come.",
        "",
        "| thesis | what | home | notebook and section | functions | tests |",
        "|---|---|---|---|---|---|",
    ]
    for thesis, what, home, *places in rows():
        reason = REASONS.get(thesis)
        shown = [", ".join(place[:8]) for place in places]
        shown[0] = shown[0] or (f"*{reason}*" if reason else "")
        lines.append(f"| {thesis} | {what} | {home} | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    INDEX.write_text(text(), encoding="utf-8")
    print(INDEX)
