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
OWN = ("start.eleven_volts", "fk.bent")  # measured once the student has put in a push that hits, another table


def asked():
    """(notebook, name, unit, question, tolerance) of each prediction of 00 to 19, in their order."""
    for path in NOTEBOOKS[:20]:
        text = ""
        for cell in nbformat.read(path, as_version=4).cells:
            if cell.cell_type == "markdown":
                text = cell.source
            for name, rest in re.findall(r'^predict\("([\w.]+)", \.\.\.(.*)\)$', cell.source, re.M):
                unit = re.match(r', "([^"]*)"', rest)
                within = re.search(r"within=([\d.]+)", rest)
                tolerance = 0 if "choices=" in rest else float(within[1]) if within else 0.1
                yield path.name[:2], name, unit[1] if unit else "", _question(text), tolerance


def _question(text):
    """The last question of a text, or its last sentence."""
    sentences = re.split(r"(?<=[.?!])\**\s+", text.replace("\n", " ").replace("*", "").strip())
    questions = [one for one in sentences if "?" in one]
    return (questions or sentences)[-1].replace("|", r"\|")


def _known():
    """{name: row} of predictions.csv."""
    with (Path(__file__).with_name("predictions.csv")).open(encoding="utf-8", newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def contradictions(notebook, said):
    """A sentence for each truth of a notebook ("09") that its run, which printed `said`, has measured otherwise."""
    known, found = _known(), dict(re.findall(r"^([\w.]+): (-?[\d.]+(?:e[+-]\d+)?)(?: |$)", said, re.M))
    for number, name, _, _, tolerance in asked():
        if number == notebook and (name in found or name not in OWN):
            truth, value = known[name]["truth"], float(found.get(name, "nan"))
            low, *more = (float(one) for one in re.findall(r"-?[\d.]+", truth.partition(":")[0]))
            room = tolerance * abs(value) + 1e-9
            if not low - room <= value <= (more or [low])[0] + room:
                yield f"{name}: the table says {truth}, measured is {value:g}"


def table():
    """The table as Markdown."""
    known = _known()
    lines = [
        "| | name | asked | truth | usual wrong guesses | the sentence one hopes for |",
        "|---|---|---|---|---|---|",
    ]
    for number, name, unit, question, _ in asked():
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
