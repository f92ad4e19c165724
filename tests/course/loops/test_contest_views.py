"""Pictures of the contest: what is drawn is what was driven; the sliders say whose controller they move."""

import numpy as np
import pytest
import solutions

from ir50p_lab.controllers import PID
from ir50p_lab.course import lab_book
from ir50p_lab.course.loops import contest_rules as contest
from ir50p_lab.course.loops import contest_views
from ir50p_lab.modelling import IR50P

GAINS = {f"{part}{joint}": value for part, value in (("kp", 900), ("ki", 800), ("kd", 5)) for joint in (1, 2, 3)}


def test_practice_draws_the_run_that_is_scored():
    view = contest_views.Practice(IR50P)
    run = contest.drive(PID(900, 800, 5, limit_pwm=255), contest.PRACTICE[0], IR50P)
    view.show(run)
    _, recording, q = run
    for joint in range(3):
        np.testing.assert_array_equal(view.figure.axes[joint].lines[-1].get_ydata(), q[:, joint])
        np.testing.assert_array_equal(view.figure.axes[3 + joint].lines[-1].get_ydata(), recording.u[:, joint])
    found = contest.score(PID(900, 800, 5, limit_pwm=255), contest.PRACTICE[:1], IR50P)
    assert found.value == contest.score_of([run]).value


def test_sliders_move_the_students_gains():
    """A class that the twin agrees with runs compiled; another law runs itself; a course's PID stands in."""
    student = solutions.load().PID

    class Half(student):
        def step(self, t, q, reference):
            return 0.5 * super().step(t, q, reference)

    view = contest_views.Practice(IR50P)
    said = {}
    for kind in (student, Half, lambda **gains: PID(**gains, limit_pwm=255)):
        update, words = contest_views.sliders_of(kind(kp=(300,) * 3, ki=(50,) * 3, kd=(40,) * 3), IR50P, view)
        said[words] = update(**GAINS)(), view.recording.u.copy()
    compiled, own = said
    assert "compiled PID runs" in compiled and "the class in Python runs" in own
    assert f"practice arms {contest.score(Half(900, 800, 5), arm=IR50P).value:.2f}" in said[own][0]
    assert "kp, ki, kd = (900, 900, 900), (800, 800, 800), (5, 5, 5)" in said[own][0]
    assert not np.allclose(said[own][1], said[compiled][1])
    wanted = Half(kp=(900,) * 3, ki=(800,) * 3, kd=(5,) * 3)  # the sliders' gains, not those it began with
    np.testing.assert_array_equal(said[own][1], contest.drive(wanted, contest.PRACTICE[0], IR50P)[1].u)


def test_history_shows_every_attempt_and_the_rules():
    contest_views.history()  # of nothing
    scores = [8.0, 3.0, 1e6, 0.9]
    for value in scores:
        entry = {"name": "a", "score": value, "decides": ["activity", 2], "seeds": [1], "at": lab_book.now()}
        lab_book.change(lambda book, entry=entry: book["contest"].append(entry))
    rule = contest.Score(np.full((5, 3), 5.0))
    figure = contest_views.history({"a rule": rule})
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert {"the best so far", "activity decided", "a rule", "below: won"} <= set(labels)
    best = next(line for line in figure.axes[0].lines if line.get_label() == "the best so far")
    assert best.get_ydata() == pytest.approx([8, 3, 3, 0.9])
    cut = next(line for line in figure.axes[0].lines if line.get_label() == "the drive was cut")
    assert cut.get_xydata().tolist() == [[3, 100]]  # and no figure decided it
    decided = next(line for line in figure.axes[0].lines if line.get_label() == "activity decided")
    assert decided.get_xdata().tolist() == [1, 2, 4]


def test_sliders_begin_at_the_gains_and_stay_on_the_scale():
    made = contest_views.gain_sliders(np.array([[528, 1074, 9000], [488, 1114, 942], [7.6, 5.3, 76]]))
    assert list(made) == list(GAINS)
    assert [made[name].start for name in ("kp1", "kp3", "ki2", "kd1", "kd3")] == [530, 2000, 1110, 7.5, 60]
