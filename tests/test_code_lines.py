"""What counts as a code line."""

from code_lines import BUDGETS, FOLDERS, STILL, count_all, javascript_lines, python_lines, too_large

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
    assert sum(FOLDERS.values()) == BUDGETS["all"]
    assert all(STILL[what] > BUDGETS[what] for what in STILL)  # what is within its budget leaves the list
    lines = count_all()
    assert list(too_large(lines)) == []
    said = too_large(lines | {"root": 999, "signals": 381, "a new one": 1})
    assert [one.split(":")[0] for one in said] == ["signals", "root", "a new one"]
