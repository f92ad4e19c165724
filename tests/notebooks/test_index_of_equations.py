"""The net under the rewriting: nothing of the thesis is lost without a reason."""

import index_of_equations as index
from notebook_runner import REWRITTEN


def test_the_index_is_up_to_date():
    assert index.INDEX.read_text(encoding="utf-8") == index.text(), "run python tests/notebooks/index_of_equations.py"


def test_what_belongs_to_a_rewritten_notebook_is_there_or_has_a_reason():
    lost = [
        (thesis, what, home)
        for thesis, what, home, reason, notebooks, *_ in index.rows()
        if home[:2] in REWRITTEN and not notebooks and not reason
    ]
    assert lost == []  # (in the thesis, what it is, its home): named nowhere


def test_numbers_are_read():
    assert index.equations("(1.5), (1.11) to (1.13), (1.46)-(1.48)") == {
        "1.5", "1.11", "1.12", "1.13", "1.46", "1.47", "1.48"
    }  # fmt: skip
    assert index.labels("Table 1.1, Figures 3.2, Fig 1.8") == {"Table 1.1", "Figure 3.2", "Figure 1.8"}
