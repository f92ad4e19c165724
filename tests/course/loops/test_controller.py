"""What students write as a PID: right ones of several kinds pass, wrong ones are told apart, stages follow each other."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.loops.functions import PID_trials as trials
from ir50p_lab.course.robot import catalogue, student_package
from ir50p_lab.course.robot.catalogue import STAGES
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

ALL = (*STAGES["PID"], "PID")


def edited(stage, *edits):
    """The course's solution of a stage with some lines changed."""
    text = task(stage).solution_text
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return text


def made(text):
    names = {"np": np}
    exec(text, names)
    return names["PID"]


ADD = "self.integral = self.integral + self.ki * error * self.period"
WINDS = "winds_up = (np.abs(push) > self.limit) & (push * error > 0)"
REST = "self.integral = np.where(winds_up, self.integral, grown)"
SPEED = "self.speed = self.speed + self.share * ((q - self.last) / self.period - self.speed)"
TRAPEZOID = (
    "self.integral = self.integral + self.ki * (error + self.before) / 2 * self.period\n        self.before = error"
)
FORGET = "self.integral = np.zeros(3)\n"


@pytest.mark.parametrize(
    ("stage", "edits", "remark"),
    [
        ("PID.pi", [(ADD, TRAPEZOID), (FORGET, FORGET + "        self.before = 0\n")], "trapezoidal"),
        ("PID.pi", [(ADD, f"self.before = error if self.before is None else self.before\n        {TRAPEZOID}"),
          (FORGET, FORGET + "        self.before = None\n")], "trapezoidal"),
        ("PID.pi", [(f"        {ADD}\n", ""), ("return self.kp * error + self.integral",
          f"push = self.kp * error + self.integral\n        {ADD}\n        return push")], "one period later"),
        ("PID.pi", [("self.ki * error", "error"), ("+ self.integral", "+ self.ki * self.integral")], ""),
        ("PID.limits", [("np.where(winds_up, self.integral, grown)", "np.clip(grown, -self.limit, self.limit)")], ""),
        ("PID.limits", [(WINDS, "winds_up = np.abs(push) > self.limit")], ""),
        ("PID.limits", [("np.where(winds_up, self.integral, grown)",
          "grown + (np.clip(push, -self.limit, self.limit) - push) / 0.5 * self.period")], ""),
        ("PID", [("+ self.kd * (qd_wanted - self.speed)",
          "+ (0 if self.last is None else self.kd * (qd_wanted - self.speed))"),
          ("        self.last = q\n", ""), ("        return", "        self.last = q\n        return")], ""),
        ("PID", [("1 - np.exp(-2 * np.pi * filter_hz * period)",
          "period / (period + 1 / (2 * np.pi * filter_hz))")], "differs from the course"),
    ],
)  # fmt: skip
def test_other_right_ones_pass(stage, edits, remark):
    verdict = grade(task(stage), made(edited(stage, *edits)))
    assert verdict.state == "right"
    assert remark in verdict.says
    assert bool(remark) == bool(verdict.says)


@pytest.mark.parametrize("stage", ALL)
def test_every_mistake_in_a_table_gets_its_own_sentence(stage):
    earlier = {"the integral has the gain kp: it has its own, ki"}  # told by what it adds to P where ki is 0
    for wrong, says in trials._made(stage, "mistakes"):
        verdict = grade(task(stage), wrong)
        assert verdict.state == "wrong" and (says in verdict.says or says in earlier), verdict.says


def test_each_stage_takes_the_place_of_the_one_before(home, capsys):
    for stage in ALL:
        check(stage, cell(solutions.source(stage), "PID"))
        assert "right, and yours: from now on my_robot.PID is this class" in capsys.readouterr().out
        assert student_package.is_there(stage) and my_robot.whose("PID") == "yours"
        catalogue._at.clear()  # another notebook: a stage on the way is not used there
        assert my_robot.whose("PID") == ("yours" if stage == "PID" else "the course's")
        assert my_robot.PID(kp=1, ki=1, kd=1).unit == "PWM"
    assert len(list((home / "my_robot" / "old").glob("PID_*.py"))) == 3


def test_an_early_stage_run_again_says_where_the_finished_class_went(home, capsys):
    check("PID.pi", cell(solutions.source("PID.pi"), "PID"))
    check("PID", cell(solutions.source("PID"), "PID"))
    assert "finished" not in capsys.readouterr().out
    check("PID.p", cell(solutions.source("PID.p"), "PID"))
    assert "finished PID was moved to my_robot/old" in capsys.readouterr().out
    assert any("filter_hz" in file.read_text(encoding="utf-8") for file in (home / "my_robot" / "old").glob("PID_*.py"))


def test_what_stands_in_is_at_the_same_stage(capsys):
    target = np.array([0.0, 0.8, 0.0])
    check("PID.p")
    short = simulate(IR50P, my_robot.PID(kp=400), target, duration=3)
    mine = simulate(IR50P, made(task("PID.p").solution_text)(kp=400), target, duration=3)
    np.testing.assert_allclose(short.q, mine.q, atol=1e-9)
    check("PID.pi")
    far = np.array([0.0, 4.0, 0.0])
    wound = my_robot.PID(kp=100, ki=400)
    simulate(IR50P, wound, far, duration=3)
    assert wound.step(3.01, far, np.zeros((3, 3)))[1] > 255  # no limit yet, and no rest for the integral


def test_a_loan_of_a_stage_never_takes_the_place_of_the_whole(capsys):
    check("PID", cell(solutions.source("PID"), "PID"))
    for k in range(7):
        check("PID.p", cell(edited("PID.p", ("self.kp * error", f"{k} * error")), "PID"))
    assert "lends you" not in capsys.readouterr().out
    catalogue._at.clear()
    assert my_robot.whose("PID") == "yours"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("self.kp * error", "kp * error", "it uses `kp` by itself"),
        ("step(self, ", "step(", "it uses `self` where it is no"),
    ],
)
def test_a_forgotten_self_is_told(old, new, words, capsys):
    check("PID.p", cell(edited("PID.p", (old, new)), "PID"))
    assert words in capsys.readouterr().out
