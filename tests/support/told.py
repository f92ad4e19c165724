"""What `check` says of a reference solution, spoilt, and of a function with a body of one's own."""

import solutions
from cells import cell

from ir50p_lab.course import check
from ir50p_lab.course.checking.tasks import task


def told(capsys, name, old="", new=""):
    """What check says of the reference solution with some words replaced."""
    text = solutions.source(name)
    assert old in text
    return told_of(capsys, name, text.replace(old, new))


def told_of_body(capsys, name, body):
    """What check says of a function with this body."""
    return told_of(capsys, name, f"def {name}({', '.join(task(name).signature)}):\n    {body}")


def told_of(capsys, name, text):
    """What check says of a function with this text."""
    check(name, cell(text, name))
    return capsys.readouterr().out.split("one input that fails")[0]
