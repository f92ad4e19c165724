"""The table of selections is what its program writes; who follows one meets no gap, and fourteen sessions are of 90 minutes."""

import re
from collections import defaultdict

import minutes
import nbformat
import pytest
import selections
from notebook_runner import NOTEBOOKS


def test_the_table_is_up_to_date():
    page = minutes.INSTRUCTOR.read_text(encoding="utf-8")
    assert page == selections.filled(page), "run python tests/notebooks/minutes.py"


def core_sections(number):
    (path,) = (path for path in NOTEBOOKS if path.name.startswith(number))
    text = "\n".join(cell.source for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "markdown")
    return [int(one) for one in re.findall(r"^## (\d+) .*\*\(core\)\*$", text, re.M)]


@pytest.mark.parametrize("sessions", selections.SELECTIONS.values(), ids=selections.SELECTIONS)
def test_no_section_of_the_core_is_left_out_before_one_that_is_taken(sessions):
    """So that a cell finds what it reads: `core_meets_no_gap` says it of the whole core."""
    taken = defaultdict(list)
    for session in sessions:
        for number, (first, last) in session.items():
            taken[number] += [one for one in core_sections(number) if first <= one <= last]
    for number, those in taken.items():
        assert those == core_sections(number)[: len(those)], number


def test_fourteen_sessions_fit():
    found = [core for *_, core, _ in selections.rows(selections.SELECTIONS["The whole order in fourteen sessions"])]
    assert len(found) == 14 and max(found) <= 95, found
