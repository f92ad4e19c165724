"""The examples in docstrings (`>>>`) run, and give what they say."""

import doctest
import importlib

import pytest

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
