"""What counts as a code line."""

from code_lines import BUDGETS, STILL_OVER, folder_lines, javascript_lines, python_lines, too_large

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


def test_no_folder_has_more_lines_than_it_may():
    assert list(too_large(folder_lines())) == []


def test_what_is_over_budget_is_said():
    full = BUDGETS | STILL_OVER
    assert list(too_large(full)) == []
    for folder, lines in full.items():
        (sentence,) = too_large(full | {folder: lines + 3})
        assert sentence.startswith(f"{folder} has {lines + 3} code lines, 3 more")
    (sentence,) = too_large(full | {"another": 1})
    assert "another has 1 code lines" in sentence
