"""The public names of the package, with their docstrings, as one page of text."""

import inspect
import re
import textwrap

from ir50p_lab import bench, controllers, course, identification, modelling, signals, simulation, vision

_SUBJECTS = (modelling, controllers, signals, simulation, bench, identification, vision, course)


def reference():
    """Return the page as Markdown: a section for each subject; in it each name, how it is called, and its docstring."""
    parts = [
        "# Public names",
        "`from ir50p_lab.SUBJECT import NAME`: what there is, with the docstrings of the package.",
    ]
    for module in _SUBJECTS:
        parts += [f"## {module.__name__.partition('.')[2]}", inspect.getdoc(module)]
        for name in module.__all__:
            parts += [f"### {name}", *_entries(name, getattr(module, name))]
    return "\n\n".join(parts)


def _entries(name, thing):
    """How a name is called, and its docstring; of a class its methods, too."""
    call = inspect.signature(thing) if callable(thing) and not name.endswith("Error") else f": {type(thing).__name__}"
    call = re.sub(r"\b(?:\w+\.)+(?=[A-Z])", "", f"{name}{call}")  # types without their modules
    about = inspect.getdoc(thing) if callable(thing) or inspect.ismodule(thing) else textwrap.shorten(repr(thing), 400)
    yield f"```python\n{call}\n```\n\n```text\n{about}\n```"
    for method, function in vars(thing).items() if inspect.isclass(thing) else ():
        if inspect.isfunction(function) and function.__doc__ and not method.startswith("_"):
            yield from _entries(f"{name}.{method}", function)
