"""The lab book: guesses, what came out and why, partners, notes, figures; a damaged one is named."""

import pytest
from matplotlib.figure import Figure

from ir50p_lab.course import lab_book, measured, partners, predict, why


def said(capsys):
    return capsys.readouterr().out


def entry(name):
    return lab_book.read()["predictions"].get(name)


def test_a_guess_is_replaced_once_and_not_after_it_is_measured(capsys):
    predict("fk.height", ..., "m")
    assert "in place of the dots" in said(capsys)
    predict("fk.height", 0.1, "m")
    predict("fk.height", 0.2, "m")
    assert said(capsys).endswith("your guess is 0.2 m, in place of 0.1 m\n")
    predict("fk.height", 0.3, "m")
    assert "stays 0.2 m" in said(capsys)
    measured("fk.height", 0.5, by="the course's")
    assert "you guessed 0.2 m, it is 0.5 m (the course's: not" in said(capsys) and "truth" not in entry("fk.height")
    measured("fk.height", 0.33)
    assert "you guessed 0.2 m, it is 0.33 m" in said(capsys)
    predict("not.replaced", 1)
    measured("not.replaced", 2)
    predict("not.replaced", 2, "cm")
    assert said(capsys).endswith("your guess stays 1: 2 cm comes too late to count\n")
    measured("other", 1, "m")
    assert said(capsys) == "other: 1 m\n"
    predict("other", 1, "m")
    assert entry("other")["late"] and not entry("fk.height")["late"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((0, 35), "write 0.35"),
        ((0, 35, "m"), "write 0.35"),
        (("0,35", "m"), "write 0.35"),
        (("a lot", "m"), "'a lot' is not an answer, so it does not count: give one number (m)"),
        ((float("nan"), "m"), "nan is not an answer"),
    ],
)
def test_what_is_no_prediction_is_refused_and_does_not_count(capsys, arguments, words):
    predict("fk.height", *arguments, within=0.2)
    assert words in said(capsys)
    assert entry("fk.height") is None


def test_a_choice_is_one_of_those_there_are(capsys):
    predict("level", 7, choices=(1, 2, 3))
    assert said(capsys) == "level: 7 is not an answer, so it does not count: give one of 1, 2, 3.\n"
    predict("level", 3, choices=(1, 2, 3))
    measured("level", 3.001)  # as near as a number might be, and yet another choice
    assert 'why("level", "...")' in said(capsys)


def test_a_wrong_choice_is_no_difference(capsys):
    predict("sim.honey", 1, choices={1: "slower", 2: "as fast", 3: "faster"})
    measured("sim.honey", 3)
    words = said(capsys)
    assert "sim.honey: you guessed slower, it is faster\n" in words and " off" not in words


@pytest.mark.parametrize(("guess", "options", "asks"), [(0.95, {}, 0), (0.85, {}, 1), (0.85, {"within": 0.2}, 0)])
def test_measured_asks_why_where_a_guess_is_off_by_more_than_it_may(capsys, guess, options, asks):
    predict("p.ends", guess, "rad", **options)
    measured("p.ends", 1)
    assert said(capsys).count('Why? One sentence: why("p.ends", "...")\n') == asks


def test_a_reason_is_written_down_and_then_not_asked_for_again(capsys):
    why("p.ends", "friction")
    assert "nothing of this name" in said(capsys)
    predict("p.ends", 2, "rad")
    measured("p.ends", 1)
    why("p.ends", "...")
    assert "in place of the dots" in said(capsys) and "why" not in entry("p.ends")
    why("p.ends", "friction holds it")
    measured("p.ends", 1)
    assert "Why?" not in said(capsys)
    assert entry("p.ends")["why"] == "friction holds it"


def test_a_notebook_run_twice_leaves_a_trace_of_what_it_changes():
    for guess, truth, reason in ((1, 2, "weight"), (3, 2, "weight"), (3, 4, "friction"), (5, 4, "friction")):
        predict("p.ends", guess, "rad")
        measured("p.ends", truth)
        why("p.ends", reason)
    now = entry("p.ends")
    assert [now[key] for key in ("guess", "changed", "truth", "why")] == [1, 5, 4, "friction"]
    earlier = [(key, one[key]) for one in now["earlier"] for key in ("changed", "truth", "why") if key in one]
    assert earlier == [("truth", 2), ("why", "weight"), ("changed", 3)]


def test_partners_are_written_down_and_said(capsys):
    partners()
    assert "nobody yet" in said(capsys)
    partners("Ada L.", "Blaise P.")
    partners()
    assert said(capsys) == 2 * "This lab book belongs to Ada L. and Blaise P.\n"
    assert lab_book.read()["partners"] == ["Ada L.", "Blaise P."]


def test_a_note_whose_end_is_still_dots_is_not_kept(capsys):
    lab_book.note("samples count above 0.05 rad/s, because ...")
    assert capsys.readouterr().out.startswith("note: write what you saw")
    assert lab_book.read()["notes"] == []


def test_the_same_note_is_kept_once():
    lab_book.note("it sank")
    lab_book.note("it sank")
    assert [one["text"] for one in lab_book.read()["notes"]] == ["it sank"]


def test_a_figure_is_kept_under_its_name(home):
    lab_book.keep(Figure(), "my first arm")
    lab_book.keep(Figure(), "my first arm")
    assert [one["file"] for one in lab_book.read()["figures"]] == ["my_first_arm.png"]
    assert (home / "results" / "figures" / "my_first_arm.png").exists()


def test_a_damaged_lab_book_is_named():
    lab_book.path().parent.mkdir()
    lab_book.path().write_text("[" * 100000)
    with pytest.raises(lab_book.LabBookError, match="rename it"):
        lab_book.read()
