"""A1 is a dictionary of every mistake of the thesis: `data/errata.csv` lists them, A1 has an entry for each.

The list: place (as it is named in the entry), slip, chapter, kind, the notebook that meets it (may be empty), and the
heading of A1 under which its check stands.
"""

import ast
import builtins
import csv
import re
from collections import Counter

import index_of_equations as index
import stripped
from notebook_runner import FOLDER, ROOT
from test_structure import imported_names

A1, A2 = FOLDER / "A1_errata.ipynb", FOLDER / "A2_further_on.ipynb"
CELLS = stripped.read(A1).cells
NUMBER, RIGHT = "reference or name", "looks wrong, is right"

with (ROOT / "data" / "errata.csv").open(encoding="utf-8", newline="") as file:
    ERRATA = list(csv.DictReader(file))


def entries():
    """{heading: (its text, its code cells)} of A1, sections and entries."""
    found, heading = {}, ""
    for cell in CELLS:
        if mark := re.match(r"##+ (.+)", cell.source):
            heading = mark[1]
        found.setdefault(heading, ([], []))[cell.cell_type == "code"].append(cell.source)
    return {heading: ("\n".join(texts), codes) for heading, (texts, codes) in found.items()}


ENTRIES = entries()


def plain(text):
    """A text without what typesetting puts into it: $M_{112}$ is M112."""
    return re.sub(r"[\\${}_^\s]", "", text)


def test_every_slip_has_its_entry():
    for slip in ERRATA:
        (text, codes), place = ENTRIES[slip["check"]], slip["place"]
        named = place.startswith("(") and place.strip("()") in index.equations(text)
        assert named or plain(place) in plain(text), f"{slip['check']} does not name {place}"
        assert any("claim(" in code for code in codes) or slip["kind"] == NUMBER or "*Experiment: " in text, place


def test_the_list_is_complete():
    """Each place once; the counts are those of the study of the thesis, and of what was found since."""
    assert len({slip["place"] for slip in ERRATA}) == len(ERRATA)
    assert Counter(slip["chapter"] for slip in ERRATA) == {"1": 86, "2": 33, "3": 13, "4": 27}
    assert {slip["kind"] for slip in ERRATA} == {
        "equation", "index or sign", "number", "words", NUMBER, RIGHT
    }  # fmt: skip
    named = {slip["check"] for slip in ERRATA}
    assert named == {heading for heading, (text, _) in ENTRIES.items() if text.startswith("### ")} | {
        "Looks wrong and is right", "Only a number or a name"
    }  # fmt: skip


def test_entries_are_short():
    for heading, (text, codes) in ENTRIES.items():
        if not text.startswith("### "):
            continue
        assert "| printed | how would you notice? | right |" in text, heading
        for code in codes:
            lines = [line for line in code.splitlines() if line and not re.match("from|import", line)]
            assert len(lines) <= 6, f"{heading}: {code}"


def test_sections_run_by_themselves():
    """No cell of an appendix reads a name that only another section has made; A2's first cell is for all."""
    for path in (A1, A2):
        first, bound = None, set()
        for cell in stripped.read(path).cells:
            if cell.source.startswith("## "):
                first, bound = (bound if first is None else first), set()
            if cell.cell_type == "code":
                nodes = list(ast.walk(ast.parse(cell.source)))
                names = [node for node in nodes if isinstance(node, ast.Name)]
                bound |= imported_names(cell.source) | {n.id for n in names if not isinstance(n.ctx, ast.Load)}
                bound |= {node.name for node in nodes if isinstance(node, ast.FunctionDef)}
                bound |= {node.arg for node in nodes if isinstance(node, ast.arg)}
                assert {n.id for n in names} <= bound | (first or set()) | set(dir(builtins)), cell.source


def test_links_lead_both_ways():
    """A notebook that meets a slip links to A1's section, and what A1 calls an experiment meets that slip."""
    for number in sorted({slip["notebook"] for slip in ERRATA} - {""}):
        (path,) = FOLDER.glob(f"{number}_*.ipynb")
        assert "A1_errata.ipynb#" in path.read_text(encoding="utf-8"), f"{path.name} has no link to A1"
    for heading, (text, _) in ENTRIES.items():
        met = {slip["notebook"] for slip in ERRATA if slip["check"] == heading} | {"A2"}
        for number, section in re.findall(r"\*Experiment: \[(\w\w)\]\([^)]*\), (?:section|case) (\w+)", text):
            assert number in met, f"{heading}: {number} meets none of it"
            assert section in index.sections(number) or section == "C", f"{heading}: {number} has no section {section}"


def test_links_name_headings_that_are_there():
    headings = {path.name: headings_of(path) for path in FOLDER.glob("[0-9A][0-9]_*.ipynb")}
    for path in FOLDER.glob("[0-9A][0-9]_*.ipynb"):
        for target, anchor in re.findall(r"\]\(([^)#]+\.ipynb)#([^)]+)\)", path.read_text(encoding="utf-8")):
            assert anchor in headings[target], f"{path.name} links to {target}#{anchor}"


def headings_of(path):
    """The headings of a notebook as a link names them: blanks as hyphens."""
    texts = [cell.source for cell in stripped.read(path).cells if cell.cell_type == "markdown"]
    return {line.lstrip("# ").replace(" ", "-") for text in texts for line in text.splitlines() if line[:1] == "#"}


def test_equation_numbers_are_read():
    assert index.equations("(1.5)") == {"1.5"}
    assert index.equations("(1.101)-(1.103), (1.7) and (1.11) to (1.13)") == {
        "1.101", "1.102", "1.103", "1.7", "1.11", "1.12", "1.13"
    }  # fmt: skip
    assert "1.80" not in index.equations("(1.75)-(1.99)")
    assert "1.1" not in index.equations("(1.11)")
