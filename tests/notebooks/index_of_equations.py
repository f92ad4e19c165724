"""Where each numbered equation, table and figure of the thesis is taught: `docs/index_of_equations.md`.

`python tests/notebooks/index_of_equations.py` writes it anew, from `docs/thesis_contents.csv` (what the thesis has and
what else is worth teaching, its home, and, where no number names it, the section or why it is left out), the texts of the
notebooks, and the docstrings of the package. A mention that disappears changes the file, and a test says so.
"""

import ast
import csv
import json
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
INDEX = ROOT / "docs" / "index_of_equations.md"


def equations(text):
    """Numbers of equations in a text, ranges of up to fourteen written out: {"1.4", ...}.

    A number, or several, in brackets of their own: (1.4), (1.5, lost), (1.34, 1.37); 1.4 m or (0.2, 1.4) is none.
    """
    numbers = set()
    for group in re.findall(r"\(([1-4]\.\d+(?:(?:, | and |; )[1-4]\.\d+)*)(?:,? [a-z][^()]*)?\)", text):
        numbers |= set(re.findall(r"\d\.\d+", group))
    for chapter, first, last in re.findall(r"\((\d)\.(\d+)\)?\s*(?:-|\u2013|to)\s*\(?\1\.(\d+)", text):
        if int(first) < int(last) <= int(first) + 14:
            numbers |= {f"{chapter}.{k}" for k in range(int(first), int(last) + 1)}
    return numbers


def labels(text):
    """Tables and figures named in a text: {"Table 1.1", "Figure 1.8", ...}."""
    found = set()
    number = r"\d(?:\.\d+)?[a-z]?"
    for kind, group in re.findall(
        rf"(Table|Fig(?:ure)?)s? ({number}(?:(?:, | and | to |,|-)(?:{number}|[a-z]\b))*)", text
    ):
        kind = "Table" if kind == "Table" else "Figure"
        found |= {f"{kind} {one}" for one in re.findall(r"\d(?:\.\d+)?", group)}
        for chapter, first, last in re.findall(r"(\d)\.(\d+)(?:-| to )\1\.(\d+)", group):
            found |= {f"{kind} {chapter}.{k}" for k in range(int(first), int(last) + 1)}
    return found


def tags(text):
    """All of both."""
    return equations(text) | labels(text)


def notebook_mentions():
    """{tag: [notebook, section]} from the texts of all notebooks; where a link leads is no mention."""
    found = {}
    for path in sorted((ROOT / "notebooks").glob("[0-9A][0-9]_*.ipynb")):
        section = ""
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            text = re.sub(r"\]\([^)]*\)", "]", "".join(cell["source"]))
            if cell["cell_type"] != "markdown":
                continue
            for part in re.split(r"(?m)^(?=## )", text):
                heading = re.match(r"## (\d\S*|[^\n*(]+)", part)
                section = heading[1].strip() if heading else section
                for tag in tags(part):
                    found.setdefault(tag, []).append(f"{path.name[:2]} {section}".strip())
    return found


@cache
def docstring_mentions():
    """{tag: [function]} from the docstrings of the package."""
    found = {}
    for path in sorted((ROOT / "ir50p_lab").rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in [tree, *ast.walk(tree)]:
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                name = getattr(node, "name", path.stem)
                for tag in tags(ast.get_docstring(node) or ""):
                    found.setdefault(tag, []).append(name)
    return found


@cache
def sections(number):
    """The numbers of the sections of a notebook: {"1", "2", ...}."""
    (path,) = (ROOT / "notebooks").glob(f"{number}_*.ipynb")
    return set(re.findall(r'"## (\d[\d.]*) ', path.read_text(encoding="utf-8")))


def rows():
    """(thesis, what, home, where or why, notebooks, functions) for each row of the contents."""
    mentions = notebook_mentions(), docstring_mentions()
    with (ROOT / "docs" / "thesis_contents.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            wanted = tags(row["thesis"] + " ")
            places = [sorted({place for tag in wanted for place in found.get(tag, [])}) for found in mentions]
            yield row["thesis"], row["what"], row["home"], row["where_or_why"], *places


def text():
    """The index as Markdown."""
    lines = [
        "# Where everything of the thesis is taught",
        "",
        "Made by `python tests/notebooks/index_of_equations.py` from the texts of the notebooks and the docstrings. *Home* is the",
        "notebook in which it belongs. Where no notebook names a number, the section stands in italics, or why it is left out.",
        "The rows at the end are not from the thesis.",
        "",
        "| thesis | what | home | notebook and section | functions |",
        "|---|---|---|---|---|",
    ]
    for thesis, what, home, reason, *places in rows():
        shown = [", ".join(place) for place in places]
        shown[0] = shown[0] or (f"*{reason}*" if reason else "")
        lines.append(f"| {thesis} | {what} | {home} | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    INDEX.write_text(text(), encoding="utf-8")
    print(INDEX)
