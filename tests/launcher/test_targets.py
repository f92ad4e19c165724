"""`python -m tests.targets`: which tables are run, with which options, and what comes of it."""

import inspect
import sys
from importlib import import_module
from types import ModuleType

import pytest

from tests.targets import __main__ as targets
from tests.targets.rows import Row


@pytest.fixture
def asked(monkeypatch):
    """Stand-ins for the modules; returns what they were asked for. Of the whole tables one misses and one raises."""
    calls = []

    def stand_in(name):
        def rows(quick):
            calls.append((name, quick))
            if name == "vision_table" and not quick:
                raise ValueError("no camera")
            yield Row("centre", "<= 1", "2", "-", False if name == "identification" and not quick else None)

        module = ModuleType(f"tests.targets.{name}", f"Table of {name}")
        module.rows = rows
        return module

    for name in targets.NAMES:
        monkeypatch.setitem(sys.modules, f"tests.targets.{name}", stand_in(name))
    return calls


def test_what_is_missed_or_cannot_be_measured_is_not_met_and_does_not_stop_the_rest(asked, capsys):
    assert targets.main(["identification"]) == targets.main(["vision_table"]) == targets.main([]) == 1
    assert asked[2:] == [(name, False) for name in targets.NAMES]
    said = capsys.readouterr()
    assert "no camera" in said.err and "vision_table: could not be measured" in said.err
    assert "Table of unknown_arm\n" in said.out and "2         -       MISSED\n" in said.out


def test_names_are_told_by_how_they_begin(asked):
    assert targets.main(["vision", "--quick"]) == 0
    assert asked == [(name, True) for name in targets.NAMES if name.startswith("vision_")]
    with pytest.raises(SystemExit, match="2"):
        targets.main(["visions"])


@pytest.mark.parametrize("name", targets.NAMES)
def test_every_table_is_there_and_has_a_quick_form(name):
    module = import_module(f"tests.targets.{name}")
    assert list(inspect.signature(module.rows).parameters) == ["quick"] and len(module.__doc__.splitlines()[0]) < 120
