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
