"""The test command: what runs together, what alone, what is left out."""

from types import SimpleNamespace

import pytest
from marks import MARKS, TESTS

from tests import __main__ as command
from tests import everywhere


@pytest.fixture
def started(monkeypatch):
    """What is started in the place of pytest; `codes`: how it ends."""
    runs = SimpleNamespace(commands=[], codes=[0, 0])

    def run(line, **options):
        runs.commands.append(line[3:])
        return SimpleNamespace(returncode=runs.codes[len(runs.commands) - 1])

    monkeypatch.setattr(command.subprocess, "run", run)
    return runs


def test_what_measures_time_runs_alone_after_the_rest(started):
    assert command.main(["-k", "pose"]) == 0
    together, alone = started.commands
    assert together == [*everywhere.PARALLEL, "--timing=without", "-k", "pose"]
    assert alone == ["-p", "no:xdist", "--timing=only", "-k", "pose"]
    assert everywhere.PARALLEL[0] == "-n" and int(everywhere.PARALLEL[1]) > 1


@pytest.mark.parametrize(
    ("codes", "code"), [((0, 5), 0), ((5, 1, 1), 1), ((0, 1, 0), 0), ((1, 0), 1), ((1, 1, 0), 1), ((5, 5), 5)]
)
def test_exit_code_and_a_second_try_for_what_measures_time(started, codes, code):
    started.codes = codes
    assert command.main([]) == code
    assert len(started.commands) == len(codes)
    assert ("--last-failed" in started.commands[-1]) == (len(codes) == 3)


def test_marked_files_exist():
    for place in MARKS:
        assert (TESTS / place).exists(), place


# -- everywhere --------------------------------------------------------------------------------------------------------
