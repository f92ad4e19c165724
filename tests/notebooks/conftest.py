"""Notebooks as parameters."""

import pytest
import stripped
from notebook_runner import CHAIN, NOTEBOOKS


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
    """A notebook of the chain is not run a second time beside it: a home of its own it has where the chain is left out."""
    if any(item.name == "test_notebooks_in_a_chain" for item in items):
        double = [item for item in items if item.name in {f"test_notebook[{path.stem}]" for path in CHAIN}]
        config.hook.pytest_deselected(items=double)
        items[:] = [item for item in items if item not in double]
