"""The lecturer's table of predictions: `PYTHONPATH=. python tests/notebooks/predictions.py` writes it into docs/instructor.md.

Name, unit and question are the notebooks'; `predictions.csv` holds what they do not say before the run, and the
question (`asked`) where that of the text needs the text around it.
"""

import csv
import re
from pathlib import Path

import nbformat
from notebook_runner import NOTEBOOKS, ROOT

PAGE = ROOT / "docs" / "instructor.md"
START, END = "<!-- predictions -->\n", "<!-- end of predictions -->\n"


def asked():
    """(notebook, name, unit, question) of each prediction of 00 to 11, in their order."""
    for path in NOTEBOOKS[:12]:
        text = ""
        for cell in nbformat.read(path, as_version=4).cells:
            if cell.cell_type == "markdown":
                text = cell.source
            for name, rest in re.findall(r'^predict\("([\w.]+)", \.\.\.(.*)\)$', cell.source, re.M):
                unit = re.match(r', "([^"]*)"', rest)
                yield path.name[:2], name, unit[1] if unit else "", _question(text)


def _question(text):
    """The last question of a text, or its last sentence."""
    sentences = re.split(r"(?<=[.?!])\**\s+", text.replace("\n", " ").replace("*", "").strip())
    questions = [one for one in sentences if "?" in one]
    return (questions or sentences)[-1].replace("|", r"\|")


def table():
    """The table as Markdown."""
    with (Path(__file__).with_name("predictions.csv")).open(encoding="utf-8", newline="") as file:
        known = {row["name"]: row for row in csv.DictReader(file)}
    lines = [
        "| | name | asked | truth | usual wrong guesses | the sentence one hopes for |",
        "|---|---|---|---|---|---|",
    ]
    for number, name, unit, question in asked():
        row = known.pop(name)
        question = row["asked"] or question
        lines.append(
            f"| {number} | `{name}` | {question} | {row['truth']} {unit} | {row['wrong']} | {row['sentence']} |"
        )
    assert not known, f"no notebook asks for {list(known)}"
    return "\n".join(lines) + "\n"


def filled(page):
    """The page with the table as it is."""
    before, _, rest = page.partition(START)
    return before + START + "\n" + table() + "\n" + END + rest.partition(END)[2]


if __name__ == "__main__":
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
