"""`python -m tests.targets`: every table that it names is there."""

import inspect
from importlib import import_module

import pytest

from tests.targets.__main__ import NAMES


@pytest.mark.parametrize("name", NAMES)
def test_every_table_is_there_and_has_a_quick_form(name):
    module = import_module(f"tests.targets.{name}")
    assert list(inspect.signature(module.rows).parameters) == ["quick"] and len(module.__doc__.splitlines()[0]) < 120
