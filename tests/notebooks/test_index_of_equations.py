"""The net under the rewriting: nothing of the thesis is lost without a reason."""

import re

import index_of_equations as index


def test_the_index_is_up_to_date():
    assert index.INDEX.read_text(encoding="utf-8") == index.text(), "run python tests/notebooks/index_of_equations.py"


def test_every_row_has_its_place_or_a_reason():
    lost = [
        (thesis, what, home)
        for thesis, what, home, where_or_why, notebooks, *_ in index.rows()
        if not notebooks and not where_or_why
    ]
    assert lost == []  # (in the thesis, what it is, its home): named nowhere


def test_sections_that_are_named_are_there():
    for thesis, *_, where_or_why, _, _ in index.rows():
        for number, first, more in re.findall(
            r"\b(\d\d|A\d), sections? ([\d.]+)((?:, [\d.]+| (?:to|and) [\d.]+)*)", where_or_why
        ):
            named = {first, *re.findall(r"[\d.]+", more)}
            assert named <= index.sections(number), f"{thesis}: {where_or_why}"


def test_numbers_are_read():
    assert index.equations("(1.5), (1.11) to (1.13), (1.46)-(1.48)") == {
        "1.5", "1.11", "1.12", "1.13", "1.46", "1.47", "1.48"
    }  # fmt: skip
    assert index.labels("Table 1.1, Figures 4.15 and 4.16, Fig 1.8a,b") == {
        "Table 1.1", "Figure 4.15", "Figure 4.16", "Figure 1.8"
    }  # fmt: skip
    assert index.labels("Tables 4.5 to 4.7") == {"Table 4.5", "Table 4.6", "Table 4.7"}
