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
    assert list(too_large(folder_lines(), folder_lines(TESTS))) == []


def test_what_is_over_budget_is_said():
    assert sum(BUDGETS.values()) == BUDGET_OF_ALL
    full = {"all tests": BUDGET_OF_TESTS}
    assert list(too_large(BUDGETS, full)) == []
    for folder, lines in BUDGETS.items():
        one, all_of_it = too_large(BUDGETS | {folder: lines + 3}, full)
        assert one.startswith(f"{folder}: {lines + 3} code lines, 3 more") and all_of_it.startswith("all: ")
    assert [text[:9] for text in too_large(BUDGETS | {"course": 0, "another": 1}, full)] == ["another: "]
    (sentence,) = too_large(BUDGETS, {"some": BUDGET_OF_TESTS, "more": 2})
    assert sentence.startswith("tests: ")
