"""The reference solutions of tests/solutions, one file a function, loaded into one namespace as a student's would be."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.robot.catalogue import ORDER

FOLDER = Path(__file__).parents[1] / "solutions"


def source(name):
    """The text of one solution; of a stage on the way to one, the course's."""
    if "." in name:
        return task(name).solution_text
    return (FOLDER / f"{name}.py").read_text(encoding="utf-8")


def load():
    """All solutions, each with NumPy, math and those before it."""
    names = {"np": np, "math": math}
    for name in ORDER:
        exec(compile(source(name), f"{name}.py", "exec"), names)
    return SimpleNamespace(**{name: names[name] for name in ORDER})
