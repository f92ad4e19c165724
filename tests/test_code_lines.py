"""What counts as a code line."""

from code_lines import (
    BUDGET_OF_ALL,
    BUDGET_OF_TESTS,
    BUDGETS,
    TESTS,
    folder_lines,
    javascript_lines,
    python_lines,
    too_large,
)

PYTHON = '''\
"""Docstring
of two lines."""

import os  # counts once


# a comment
def f(a):
    """One line."""
    text = """
    a string that is used
    """
    return (
        a,
        text,
    )
'''


def test_python():
    assert python_lines(PYTHON) == 9


def test_javascript():
    assert javascript_lines("/* a\n b */\n// c\n\nconst a = 1; // d\n  f(a);\n") == 2


def test_nothing_has_more_lines_than_it_may():
    assert sum(BUDGETS.values()) == BUDGET_OF_ALL
    product, tests = folder_lines(), folder_lines(TESTS)
    assert list(too_large(product, tests)) == []
    said = too_large(product | {"root": 999}, tests | {"more": BUDGET_OF_TESTS})
    assert [one.split(":")[0] for one in said] == ["root", "all", "tests"]
