"""The lecturer's table of predictions names every prediction of 00 to 11, and is what its program writes."""

import predictions


def test_the_table_is_up_to_date():
    page = predictions.PAGE.read_text(encoding="utf-8")
    assert page == predictions.filled(page), "run python tests/notebooks/predictions.py"
