"""Where exercises are found: one module a notebook, imported when its prefix is asked for."""

import difflib
import importlib
import pkgutil
from pathlib import Path

from ir50p_lab.course.exercises._answers import Exercise
from ir50p_lab.errors import InputError

_PACKAGE = __name__.rpartition(".")[0]


def prefixes() -> tuple[str, ...]:
    """Return the prefixes of all exercises, one per module of this folder, without importing any."""
    here = str(Path(__file__).parent)
    return tuple(info.name for info in pkgutil.iter_modules([here]) if not info.name.startswith("_"))


def module_of(prefix: str):
    """Import and return the module of a prefix."""
    return importlib.import_module(f"{_PACKAGE}.{prefix}")


def find(name: object) -> Exercise:
    """Return the exercise of this name; InputError names the nearest ones."""
    if not isinstance(name, str):
        raise InputError('The name of the exercise comes first, as text: check("start-1", answer).')
    wanted = name.strip().lower()
    prefix = wanted.rpartition("-")[0]
    if prefix in prefixes():
        for exercise in module_of(prefix).EXERCISES:
            if exercise.name == wanted:
                return exercise
    known = [exercise.name for _, exercise in everything()]
    nearest = difflib.get_close_matches(wanted, known, 3, 0.4) or known[:3]
    raise InputError(f"There is no exercise {name!r}. Nearest names: {', '.join(nearest)}.")


def everything() -> list[tuple[str, Exercise]]:
    """Return (notebook, exercise) for every exercise, in the order of the notebooks."""
    modules = sorted((module_of(prefix) for prefix in prefixes()), key=lambda module: module.NOTEBOOK)
    return [(module.NOTEBOOK, exercise) for module in modules for exercise in module.EXERCISES]
