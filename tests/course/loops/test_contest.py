"""The contest can be lost and won: on 20 copies of the arm, with unseen payloads and targets, by tuning only."""

import control
import numpy as np
import pytest
import solutions

from ir50p_lab.controllers import PID
from ir50p_lab.course import lab_book
from ir50p_lab.course.loops import contest_rules as jury
from ir50p_lab.course.loops.notebook_functions import rule
from ir50p_lab.modelling import IR50P, forward_kinematics, load_arm

UNITS = range(7000, 7020)  # seeds nobody tuned on
HIGHEST = np.array([2000, 3000, 60])  # right ends of the sliders of notebook 09, which random settings are drawn from
TUNED = {"kp": (1000, 1000, 1000), "ki": (800, 2800, 2400), "kd": (8, 1, 1)}  # by search on other seeds


def pid(kp, ki, kd):
    return PID(kp, ki, kd, limit_pwm=255)


@pytest.mark.parametrize("seed", UNITS[:5])
def test_ends_of_the_sliders_and_the_thesis_lose_and_a_tuned_set_wins(seed):
    for gains in (HIGHEST, (2000, 600, 200), (0, 0, 0), ((289, 225, 270), (50, 10, 50), (40, 30, 30))):
        assert jury.score(pid(*gains), [seed], IR50P).value > 1.5
    assert jury.score(pid(**TUNED), [seed], IR50P).won


def test_at_most_one_in_twenty_random_settings_wins():
    rng = np.random.default_rng(11)
    won = 0
    for _ in range(80):
        gains = pid(*(rng.uniform(0, 1, (3, 3)) * HIGHEST[:, None]))
        seeds = rng.permutation(UNITS)[: jury.RUNS]
        won += all(jury.score(gains, [seed], IR50P).won for seed in seeds)  # most lose on the first arm
    assert won <= 4


def test_figures_of_a_motion_that_is_known():
    """Exponential approach from above, sampled: late when the error is 30 mrad, no overshoot, quiet command."""
    given = jury.Draw(np.array([[0.0] * 3, [0.5] * 3, [0.6] * 3]), 0.0, 1)
    t = jury._PERIOD * np.arange(1000)
    q = np.zeros((1000, 3))
    q[300:700] = 0.5 * (1 - np.exp(-(t[300:700] - 3) / 0.4))[:, None]
    q[700:] = 0.6 + 0.05 * np.exp(-(t[700:] - 7) / 0.4)[:, None]
    u = np.outer(np.arange(1000) % 2, [0.0, 4.0, 9.0])
    found = jury.grade_run(given, u, q)
    assert found[0] == pytest.approx(0.4 * np.log(0.5 / jury.BAND), abs=0.011)
    assert found[1] == pytest.approx(0.4 * np.log(0.05 / jury.BAND), abs=0.011)
    assert found[2] == pytest.approx(0.05) and found[4] == pytest.approx([0, 4, 9])
    ends = 0.5 * np.exp(-(t[600:700] - 3) / 0.4), 0.05 * np.exp(-(t[900:] - 7) / 0.4)
    assert found[3] == pytest.approx(max(np.mean(end) for end in ends))


@pytest.mark.parametrize(("share", "won"), [(0.99, True), (1.01, False)])
def test_won_is_every_figure_within_its_limit(share, won):
    terms = np.array([[limit * 0.5] * 3 for limit, _ in jury.LIMITS.values()])
    terms[2, 1] *= 2 * share
    assert jury.Score(terms).won is won


def test_draws_are_within_reach_and_differ():
    arms = [load_arm("data/arm_example.toml"), IR50P]
    for arm in arms:
        draws = [jury.draw(arm, seed) for seed in range(30)]
        poses = np.array([one.poses for one in draws])
        assert (poses > arm.q_min).all() and (poses < arm.q_max).all()
        assert min(forward_kinematics(arm, q)[2] for q in poses.reshape(-1, 3)) > 0.05
        assert len({one.copy for one in draws}) == 30 and np.ptp([one.payload for one in draws]) > 0.05 * arm.m[2]


class Mine:
    """Not a PID: proportional, with a bias for each joint."""

    unit = "PWM"

    def step(self, t, q, reference):
        return 400 * (reference[0] - q) + [0, 60, 30]


def test_any_controller_may_enter_and_attempts_are_kept(capsys):
    student = solutions.load().PID
    first, second = jury.contest(Mine(), "my own law"), jury.contest(student(**TUNED), "tuned")
    assert not first.won and second.value < first.value
    said = capsys.readouterr().out
    assert "attempt 1: the best so far" in said and "decides" in said
    kept = lab_book.read()["contest"]
    assert [one["name"] for one in kept] == ["my own law", "tuned"]
    assert len({seed for one in kept for seed in one["seeds"]}) == 2 * jury.RUNS  # drawn anew each time
    assert jury.score(student(**TUNED), kept[1]["seeds"]).value == pytest.approx(kept[1]["score"])


def test_who_stops_on_the_way_has_lost_an_attempt():
    """Else a class could break off on an unlucky arm, unseen, until nine lucky ones come."""

    class BreaksOff(Mine):
        def step(self, t, q, reference):
            if t > 5:
                raise KeyboardInterrupt
            return super().step(t, q, reference)

    with pytest.raises(KeyboardInterrupt):
        jury.contest(BreaksOff(), "breaks off")
    (kept,) = lab_book.read()["contest"]
    assert kept["name"] == "breaks off" and kept["score"] >= 1e6


def test_a_cell_cannot_move_the_limits():
    with pytest.raises(TypeError):
        jury.LIMITS["activity"] = (1000.0, "")


def test_a_cut_drive_is_lost_and_says_why():
    class Nonsense:
        unit = "PWM"

        def step(self, t, q, reference):
            return np.full(3, np.nan)

    found = jury.score(Nonsense(), [1], IR50P)
    assert found.value == np.inf and "cut the drive" in str(found)


def test_the_twin_is_taken_only_where_it_sends_the_same():
    student = solutions.load().PID
    assert jury.twin_of(student(**TUNED), IR50P) is not None
    assert jury.twin_of(Mine(), IR50P) is None

    class Trapezoid(student):
        def step(self, t, q, reference):
            return super().step(t, q, reference) + 0.5 * self.ki * self.period * (reference[0] - q)

    assert jury.twin_of(Trapezoid(**TUNED), IR50P) is None


def test_compiled_and_python_give_one_score():
    mine, twin = solutions.load().PID(**TUNED), pid(**TUNED)
    a, b = jury.score(mine, [1], IR50P), jury.score(twin, [1], IR50P)
    np.testing.assert_allclose(a.terms, b.terms, rtol=0.05, atol=0.02)


def test_the_rule_of_09_has_the_margins_that_skogestad_gives():
    for T, L in ((1.0, 0.1), (0.5, 0.5), (0.1, 2.0)):
        kp, ki, kd = rule(4.0, T, L, L)
        w = np.geomspace(1e-2, 60, 2_000) / L
        s = 1j * w
        loop = (kp + ki / s + kd * s) * 4.0 * np.exp(-s * L) / (T * s + 1) / s
        assert control.stability_margins(control.frd(loop, w))[:2] == pytest.approx((2.96, 46.9), rel=3e-3)
