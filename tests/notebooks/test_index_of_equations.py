"""The net under the rewriting: nothing of the thesis is lost without a reason."""

import index_of_equations as index
import pytest
from notebook_runner import REWRITTEN

ROWS = list(index.rows())


def test_the_index_is_up_to_date():
    assert index.INDEX.read_text(encoding="utf-8") == index.text(), "run python tests/notebooks/index_of_equations.py"


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_what_belongs_to_a_rewritten_notebook_is_there_or_has_a_reason(row):
    thesis, what, home, notebooks, *_ = row
    if home[:2] in REWRITTEN:
        assert notebooks or thesis in index.REASONS, f"{thesis} ({what}) has its home in {home} and is named nowhere"


def test_numbers_are_read():
    assert index.equations("(1.5), (1.11) to (1.13), (1.46)-(1.48)") == {
        "1.5", "1.11", "1.12", "1.13", "1.46", "1.47", "1.48"
    }  # fmt: skip
    assert index.labels("Table 1.1, Figures 3.2, Fig 1.8") == {"Table 1.1", "Figure 3.2", "Figure 1.8"}
