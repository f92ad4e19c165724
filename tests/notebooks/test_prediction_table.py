"""The lecturer's table of predictions names every prediction of 00 to 18, and is what its program writes."""

import predictions


def test_the_table_is_up_to_date():
    page = predictions.PAGE.read_text(encoding="utf-8")
    assert page == predictions.filled(page), "run python tests/notebooks/predictions.py"


def test_a_truth_that_was_measured_otherwise_is_found():
    right = "start.level_joint: 1\nstart.one_degree: 9.97 mm (the course's: not written down)\nstart.fall: 1.65 s\n"
    assert not list(predictions.contradictions("00", right + "start.no_rotors: 0.27 s\nstart.eleven_volts: 62 mm"))
    missing, wrong = predictions.contradictions("00", right + "start.eleven_volts: 90 mm")
    assert wrong == "start.eleven_volts: the table says 56 to 70, measured is 90"
    assert missing == "start.no_rotors: the table says 0.27, measured is nan"  # what was not measured does not agree
