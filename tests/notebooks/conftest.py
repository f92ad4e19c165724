"""Notebooks as parameters."""

import pytest
import stripped
from notebook_runner import CHAIN, NOTEBOOKS, REWRITTEN


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def path(request):
    """Every notebook."""
    return request.param


@pytest.fixture
def notebook(path):
    """The notebook as it is shipped, without what JupyterLab has stored in it."""
    return stripped.read(path)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    """Each notebook runs once: with solutions, or else as it is. `--all`: as it is, too, or in the chain."""
    names = {item.name for item in items}
    double = set()
    if "test_notebooks_in_a_chain" in names:  # a home of its own it has where the chain is left out
        double |= {f"test_notebook[{path.stem}]" for path in CHAIN}
    if not config.option.all:
        solved = {number for number in REWRITTEN if f"test_notebook_with_solutions[{number}]" in names}
        double |= {f"test_notebook[{path.stem}]" for path in NOTEBOOKS if path.name[:2] in solved}
    config.hook.pytest_deselected(items=[item for item in items if item.name in double])
    items[:] = [item for item in items if item.name not in double]
