"""`python -m tests.targets`: which tables are run, with which options, and what comes of it."""

import sys
from types import ModuleType

import pytest

from tests.targets import __main__ as targets


@pytest.fixture
def asked(monkeypatch):
    """Stand-ins for the modules; returns what they were asked for. `--missed NAME` misses, `--broken NAME` raises."""
    calls = []

    def stand_in(name):
        def main(arguments):
            calls.append((name, *arguments))
            print(f"table of {name}")
            if arguments == ["--broken", name]:
                raise ValueError("no camera")
            if arguments == ["--unknown"]:
                raise SystemExit(2)
            return int(arguments == ["--missed", name])

        module = ModuleType(f"tests.targets.{name}")
        module.main = main
        return module

    for name in targets.NAMES:
        monkeypatch.setitem(sys.modules, f"tests.targets.{name}", stand_in(name))
    return calls


def test_one_missed_target_is_enough(asked):
    assert targets.main(["--missed", "identification"]) == 1
    assert len(asked) == len(targets.NAMES)


def test_what_cannot_be_measured_is_not_met_and_does_not_stop_the_rest(asked, capsys):
    assert targets.main(["--broken", "identification"]) == 1
    assert len(asked) == len(targets.NAMES)
    said = capsys.readouterr()
    assert "no camera" in said.err and "identification: could not be measured" in said.err
    assert "table of vision" in said.out


@pytest.mark.parametrize("name", targets.NAMES)
def test_every_table_is_there_and_has_a_quick_form(name, capsys):
    assert targets.main([name, "--help"]) == 0
    said = capsys.readouterr().out
    assert f"python -m tests.targets.{name}" in said and "--quick" in said
