"""Notebooks as parameters."""

import nbformat
import pytest
from notebook_runner import NOTEBOOKS


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def path(request):
    """Every notebook."""
    return request.param


@pytest.fixture
def notebook(path):
    """The notebook as nbformat reads it."""
    return nbformat.read(path, as_version=4)
