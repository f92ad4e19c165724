"""A student's circle(t) in notebook 11: as it is right, and as it goes wrong."""

import re

from ir50p_lab.course.checking.tasks import of_notebook

_NO_CIRCLE_YET = re.compile(r"^    \.\.\..*\n    return \.\.\.\n", re.M)
#: What in it, by what, words of what its cell says then.
WRONG = [
    ("v = radius * rate", "v = rate", "a metre for each radian"),
    ("v = radius * rate", "v = radius", "quintic returns that, too"),
    ("frames(q", "frames(first", "belongs to another pose"),
]


def written(cell, old="", new=""):
    """The cell that asks for it, with the right lines in place of the dots, or with a mistake in them."""
    right = of_notebook("circle").solution_text.partition("turned, rate, _ = ")[2].partition("\n")[2] + "\n"
    assert len(_NO_CIRCLE_YET.findall(cell)) == 1 and old in right
    return _NO_CIRCLE_YET.sub(lambda _: right.replace(old, new) if old else right, cell)
