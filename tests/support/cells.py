"""Functions as a notebook's cell defines them: their text can be looked up."""

import itertools
import linecache

import numpy as np

_number = itertools.count()


def cell(text, name, notebook=()):
    """Run a cell's text and return what it calls `name`; notebook: names that earlier cells have left behind."""
    file = f"<cell {next(_number)}>"
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)
    names = {"np": np, **dict(notebook)}
    exec(compile(text, file, "exec"), names)
    return names[name]
