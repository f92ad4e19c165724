"""Habits of a translation, once mended, stay out of notebooks, README, docs, what `check` says, docstrings and messages."""

import ast
import re
from functools import cache

import nbformat
import pytest
from notebook_runner import NOTEBOOKS, ROOT

HABITS = (
    r"\b(mm|cm|px|mrad|deg|degrees|metres|centimetres|millimetres) beside\b",  # off
    r"\bhow (far|many \w+( rms)?) beside\b",
    r"\bhow many per ?cent\b",  # what percentage
    r"\bshall\b",  # has to, is to
    r"\bsay it first\b|\bsay first\b|\bsay it, then\b",  # answer first
    r"\bless (half|the|what|holding)\b",  # minus
    r"\binterval is marked\b|\bfor an interval\b",  # break
    r"\bfrom [\w.]+( %)? on\b(?<!from here on)(?<!from now on)(?<!from then on)",  # from 3 upwards
    r"\b(?-i:but for)\b",  # except for
    r"\bone (would|asks|calls|looks|needs|wants|notices|has to)\b",  # you
    r"(?<=[.:?!] )Who (wants|works|has|says|looks|stands|drives|compares|divides|must|cannot|skips)\b[^?]*(?=\.)",
    r"\bmay change places\b|\bchange places\.",
    r"\bturned round\b|\bturn the (question|equation) round\b",
    r", for (it|he|nobody|no|in|there|they|both|hardly|edges|what) (is|are|was|has|have|does|the|a|longer|any)\b",  # because
    r"\b(one|a row|a column) a (joint|link|row|sample|try|term)\b",  # one for each
    r"\beverybody, one sentence\b",
    r"\bthesis'(?!s)",
    r"\ball else\b",  # everything else
    r"[;:] asked(?: for)? (?:is|are)\b",  # ... is wanted
    r"\bbelongs? into\b|\b(the port|everything) free\b",
)
TABLES = re.compile(r"<!-- predictions -->.*<!-- end of predictions -->", re.S)  # written by a program


@cache
def texts():
    return tuple(_texts())


def _texts():
    for path in NOTEBOOKS:
        if path.name.startswith("A1"):
            continue  # its entries are those of data/errata.csv
        for cell in nbformat.read(path, as_version=4).cells:
            yield f"{path.name}, {cell.id}", cell.source
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        if path.name != "index_of_equations.md":
            yield path.name, TABLES.sub("", path.read_text("utf-8"))
    for path in sorted((ROOT / "ir50p_lab").rglob("functions/*.txt")):
        yield path.name, path.read_text("utf-8")
    for path in sorted((ROOT / "ir50p_lab").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield f"{path.name}, line {node.lineno}", node.value


@pytest.mark.parametrize("habit", HABITS)
def test_no_sentence_sounds_translated(habit):
    found = [f"{where}: {match[0]}" for where, text in texts() for match in re.finditer(habit, text, re.I)]
    assert not found, "\n".join(found)
