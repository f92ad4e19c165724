"""No known mistake of the thesis is forgotten: each is named in a 'Thesis check' cell, with an assert below.

`errata.csv` lists those that notebooks meet so far: notebook, equation or place, what is wrong in a line, and words that
name it if it has no number of its own: a regular expression for the text of the Thesis check or the code below it.
"""

import csv
import itertools
import re
from collections import Counter
from pathlib import Path

import stripped
from notebook_runner import NOTEBOOKS, REWRITTEN

WIDEST_RANGE = 10  # "(1.101-1.110)" names ten equations; a wider range names none of them


def thesis_checks(path):
    """Return (text from 'Thesis check' on, code below) of a notebook."""
    found = []
    cells = stripped.read(path).cells
    for text, code in itertools.pairwise(cells):
        if text.cell_type == "markdown" and "**Thesis check (" in text.source:
            found.append((text.source[text.source.index("**Thesis check (") :], code))
    return found


def equations(text):
    """Return the equation numbers in a text, such as 1.5, with narrow ranges written out."""
    numbers = set(re.findall(r"(?<![\d.])\d\.\d+(?:\.\d+[a-z]?)?", text))
    for chapter, first, last in re.findall(r"(\d)\.(\d+)\)?\s*[-\u2013]\s*\(?\1\.(\d+)(?![.\d])", text):
        if int(first) < int(last) < int(first) + WIDEST_RANGE:
            numbers |= {f"{chapter}.{i}" for i in range(int(first), int(last) + 1)}
    return numbers


def names(check, place, words):
    text, code = check
    return re.search(words, f"{text}\n{code.source}") is not None if words else place in equations(text)


with Path(__file__).with_name("errata.csv").open(encoding="utf-8", newline="") as file:
    ERRATA = list(csv.DictReader(file))


def test_every_mistake_is_checked(path):
    checks = thesis_checks(path)
    for mistake in ERRATA:
        if path.name.startswith(mistake["notebook"]):
            found = [code for text, code in checks if names((text, code), mistake["place"], mistake["words"])]
            assert found, f"no Thesis check of {path.name} names {mistake['place']} ({mistake['mistake']})"
            assert any(code.cell_type == "code" and re.search("assert|claim", code.source) for code in found)


def test_thesis_checks_run_and_assert(path):
    checks = thesis_checks(path)
    assert checks or path.name[:2] in (*REWRITTEN, "A2")  # theirs stand in A1
    for text, code in checks:
        assert code.cell_type == "code" and re.search("assert|claim", code.source), text.splitlines()[0]


def test_the_list_is_complete():
    """Every number once; the counts are those of the study of the thesis that the list comes from."""
    counts = {"A1": 117, "16": 8, "18": 2}
    assert Counter(mistake["notebook"] for mistake in ERRATA) == counts
    assert set(counts) <= {path.name[:2] for path in NOTEBOOKS}
    assert len({(mistake["notebook"], mistake["place"]) for mistake in ERRATA}) == len(ERRATA)


def test_equation_numbers_are_read():
    assert equations("(1.5)") == {"1.5"}
    assert equations("(1.101-1.103), (1.7) and (1.11)-(1.13)") == {
        "1.101", "1.102", "1.103", "1.7", "1.11", "1.12", "1.13"
    }  # fmt: skip
    assert "1.80" not in equations("(1.75-1.99)")
    assert equations("1.5.3c") == {"1.5.3c"}
    assert "1.1" not in equations("1.11")
