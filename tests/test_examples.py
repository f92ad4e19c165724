"""The examples in docstrings (`>>>`) run, and give what they say."""

import doctest
import importlib
import re

import pytest
from code_lines import folder_lines

from ir50p_lab.home import PROJECT

PATHS = sorted(
    path.relative_to(PROJECT) for path in (PROJECT / "ir50p_lab").rglob("*.py") if ">>> " in path.read_text("utf-8")
)


@pytest.mark.parametrize("path", PATHS, ids=str)
def test_examples_give_what_they_say(path):
    module = importlib.import_module(".".join(path.with_suffix("").parts))
    failed, tried = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert tried and not failed


def test_those_that_others_call_have_one():
    texts = [(PROJECT / path).read_text("utf-8") for path in PATHS]
    assert sum(text.count(">>> from ir50p_lab.") for text in texts) >= 20


@pytest.mark.parametrize("name", ["README.md", "docs/developing.md"])
def test_the_two_sums_are_told(name):
    """Of the package, seven subjects, and of the course, with the launcher: within 400 lines."""
    lines = folder_lines()
    course = lines["course"] + lines["course/publishing"] + lines["course/grading"] + lines["launcher"]
    package = sum(lines.values()) - course - lines["root"]
    text = (PROJECT / name).read_text("utf-8")
    told = [int(found.replace(",", "")) for found in re.findall(r"\b\d+,\d{3}(?=\s+(?:lines|more))", text)]
    assert len(told) == 2 and abs(told[0] - package) < 400 and abs(told[1] - course) < 400, (package, course)
