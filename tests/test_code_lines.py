"""What counts as a code line."""

from code_lines import javascript_lines, python_lines

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
