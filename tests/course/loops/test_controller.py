"""What students write as a PID: right ones of several kinds pass, wrong ones are told apart, stages follow each other."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.loops.functions import PID_trials as trials
from ir50p_lab.course.robot import catalogue
from ir50p_lab.course.robot import student_package as folder
from ir50p_lab.course.robot.catalogue import STAGES, task
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

ALL = (*STAGES["PID"], "PID")


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    catalogue._at.clear()
    my_robot._said.clear()
    yield tmp_path
    catalogue._at.clear()  # a test of another file, in this process, works on no stage


def edited(stage, *edits):
    """The course's solution of a stage with some lines changed."""
    text = task(stage).loan
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return text


def made(text):
    names = {"np": np}
    exec(text, names)
    return names["PID"]


GROWN = "grown = self.integral + self.ki * error * self.period"
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
          "period / (period + 1 / (2 * np.pi * filter_hz))")], "another share"),
    ],
)  # fmt: skip
def test_other_right_ones_pass(stage, edits, remark):
    verdict = grade(task(stage), made(edited(stage, *edits)))
    assert verdict.state == "right"
    assert remark in verdict.says
    assert bool(remark) == bool(verdict.says)


@pytest.mark.parametrize(
    ("stage", "old", "new", "words"),
    [
        ("PID.p", "q_wanted - q", "q - q_wanted", "the wrong way"),
        ("PID.p", "q_wanted - q", "q_wanted + q", "sum of both angles"),
        ("PID.p", "q_wanted - q", "np.degrees(q_wanted - q)", "57 times"),
        ("PID.p", "q_wanted - q", "q_wanted", "wherever the arm is"),
        ("PID.p", "q_wanted - q", "abs(q_wanted - q)", "both sides"),
        ("PID.p", "self.kp * error", "400 * error", "kp does nothing"),
        ("PID.p", "self.kp * error", "-self.kp * (q - q_wanted)", "a tuple cannot be calculated with"),
        ("PID.p", "self.kp * error", "np.sum(self.kp * error)", "one number"),
        ("PID.p", "self.kp * error", "[0, (self.kp * error)[1], 40]", "; joint 2 is right"),
        ("PID.p", "error = q_wanted - q", "q_wanted -= q\n        error = q_wanted", "changes the reference"),
        ("PID.p", "error = q_wanted - q", "q -= q_wanted\n        error = -q", "changes q"),
        ("PID.p", "self.kp * error", "np.trunc(self.kp * error)", "cuts off"),
        ("PID.p", "self.kp * error", "self.kp * q_wanted - q", "only one of the two angles"),
        ("PID.p", "q_wanted - q", "reference[:, 0] - q", "a column of the reference"),
        ("PID.pi", "self.ki * error", "error", "ki is not used"),
        ("PID.pi", "self.ki * error", "self.ki * q", "adds up the angle"),
        ("PID.pi", "error + self.integral", "error + self.ki * self.integral", "ki is in it twice"),
        ("PID.pi", "error + self.integral", "error + self.integral * self.period", "the period is in it twice"),
        ("PID.pi", ADD, "self.integral = self.ki * error * t", "error times t is no sum"),
        ("PID.pi", ADD, ADD.replace("error", "(error + getattr(self, 'before', 0))") + "\n        self.before = error",
         "the sum of two errors"),
        ("PID.pi", "return self.kp * error + self.integral",
         "self.integral = self.integral + self.kp * error\n        return self.integral", "adds up the whole push"),
        ("PID.p", "        return self.kp * error", "        push = self.kp * error", "`return`"),
        ("PID.p", '    unit = "PWM"\n', "", "unit"),
        ("PID.p", "self.kp = kp", "self.gain = kp\n        self.kp = 0", "sends 0 whatever is missing"),
        ("PID.p", "    def __init__(self, kp)", "    def __init__(self)", "its __init__ takes"),
        ("PID.p", "error = q_wanted - q", "error = q_wanted - angle", "NameError"),
        ("PID.p", "self.kp * error", "self.kp * error + 40", "where nothing is missing, it pushes with [40., 40., 40.]"),
        ("PID.p", "self.kp * error", "self.kp * np.sign(error)", "only the error's sign"),
        ("PID.p", "self.kp * error", "np.round(self.kp * error)", "it rounds"),
        ("PID.p", "step(self, t, q, reference)", "step(t, q, reference)", "its step takes (t, q, reference); begin"),
        ("PID.pi", " * self.period", "", "period is missing"),
        ("PID.pi", " * self.period", " / self.period", "divides by the period"),
        ("PID.pi", " * self.period", " * t", "as wide as t"),
        ("PID.p", "q_wanted - q", "qd_wanted - q", "speed that is wanted is taken for the angle"),
        ("PID.limits", "= kp, ki, limit_pwm,", "= kp, ki, limit_pwm / 2,", "and limit_pwm 100, it sends [ 50., -50.,   4.]"),
        ("PID.pi", " * self.period", " * 0.01", "0.01 s is written"),
        ("PID.pi", "self.integral + self.ki * e", "self.integral - self.ki * e", "away from the target"),
        ("PID.pi", "self.integral + self.ki * e", "self.ki * e", "does not remember"),
        ("PID.pi", "self.kp * error + self.integral", "self.integral", "sends 0 whatever is missing"),
        ("PID.pi", "self.integral = np.zeros(3)", "pass", "AttributeError"),
        ("PID.pi", "    def reset(self):", "    def begin(self):", "AttributeError"),
        ("PID.pi", "        self.integral = np.zeros(3)",
         '        if not hasattr(self, "integral"):\n            self.integral = np.zeros(3)', "not as new: the integral"),
        ("PID.limits", "np.clip(self.kp * error + self.integral, -self.limit, self.limit)",
         "self.kp * error + self.integral", "no limit"),
        ("PID.pi", "self.ki * error", "self.ki * error * self.kp", "ki is a gain of its own"),
        ("PID.limits", "return np.clip(self.kp * error + self.integral, -self.limit, self.limit)",
         "push = self.kp * error + self.integral\n        np.clip(push, -self.limit, self.limit)\n        return push",
         "is what it gives used"),
        ("PID", "        self.last = q\n", "        self.last = q if self.last is None else self.last\n", "stays the first"),
        ("PID.limits", "-self.limit, self.limit)", "0, self.limit)", "cannot push downwards"),
        ("PID.p", "return self.kp * error", "return self.kp * error * [1, 0, 1]", "no push reaches joint 2"),
        ("PID.p", "error = q_wanted - q", "error = reference - q", "the whole reference"),
        ("PID.p", "return self.kp * error", "print(self.kp * error)", "step returns nothing: what is printed"),
        ("PID.p", "self.kp * error", "error / self.kp", "it divides by kp"),
        ("PID.p", "return self.kp * error", "self.kp = self.kp * error\n        return self.kp", "the later ones are not"),
        ("PID.p", "return self.kp * error", "return np.dot(np.ones(3) * self.kp, error)", "the joints added up"),
        ("PID.p", "self.kp * error", "self.kp * error + qd_wanted", "wanted speed is added"),
        ("PID.p", "self.kp * error", "self.kp * error * t", "the push grows with t"),
        ("PID.p", "self.kp * error", "(self.kp * error)[::-1]", "changed places"),
        ("PID.p", "self.kp * error", "self.kp * error.astype(int)", "cut to whole radians"),
        ("PID.pi", "self.ki * error", "self.kp * error", "a gain of its own, ki"),
        ("PID.pi", "self.integral + self.ki", "0.99 * self.integral + self.ki", "keeps only 99 %"),
        ("PID.pi", "error + self.integral", "error + self.integral / max(t, self.period)", "divided by the time"),
        ("PID.limits", WINDS, WINDS.replace("push * error", "push * q"), "compared with the angle"),
        ("PID", "self.ki, self.kd, self.limit, self.period = kp, ki, kd,", "self.ki, self.kd, self.limit, self.period "
         "= kp, ki, ki,", "ki multiplies D"),
        ("PID", "self.kd * (qd_wanted - self.speed)", "self.kp * (qd_wanted - self.speed)", "kp = 20 it pushes: kp multiplies D"),
        ("PID", "self.last = q\n", "self.last = q_wanted\n", "the one that was wanted"),
        ("PID", "(np.abs(push + grown) > self.limit)", "(np.abs(self.kp * error + grown) > self.limit)", "does D count"),
        ("PID.limits", "= kp, ki, limit_pwm,", "= kp, ki, 255,", "255 is written"),
        ("PID.limits", "np.where(winds_up, self.integral, grown)", "grown", "never rests"),
        ("PID.limits", "        winds_up = (np.abs(push) > self.limit) & (push * error > 0)\n"
         "        self.integral = np.where(winds_up, self.integral, grown)\n"
         "        return np.clip(self.kp * error + self.integral, -self.limit, self.limit)",
         "        self.integral = np.clip(grown, -self.limit, self.limit)\n"
         "        return np.clip(self.kp * error, -self.limit, self.limit) + self.integral", "limit their sum"),
        ("PID.limits", "np.where(winds_up, self.integral, grown)", "np.where(winds_up, 0, grown)", "falls back"),
        ("PID.limits", "np.where(winds_up, self", "np.where(np.any(winds_up), self", "joint by joint"),
        ("PID.limits", "-self.limit, self.limit)", "self.limit, -self.limit)", "its lower bound comes first"),
        ("PID.limits", "np.where(winds_up, self.integral, grown)", "np.clip(grown, -self.limit / 2, self.limit / 2)",
         "stops too early"),
        ("PID.limits", WINDS, "winds_up = (push > self.limit) & (error > 0)", "when it pushes downwards"),
        ("PID.limits", WINDS, WINDS.replace("push", "(self.kp * error)"), "asked of P alone"),
        ("PID.limits", f"{REST}\n        return np.clip(self.kp * error + self.integral,", "self.integral = grown\n"
         "        return np.clip(self.kp * error + np.clip(grown, -self.limit, self.limit),", "it winds up: after 10 s"),
        ("PID.limits", f"grown\n        {WINDS}\n        {REST}\n"
         "        return np.clip(self.kp * error + self.integral, -self.limit, self.limit)",
         f"self.integral\n        {WINDS}\n        {REST}\n"
         "        return np.where(np.abs(push) > self.limit, np.sign(error) * self.limit, push)", "jumps from 255 to -255"),
        ("PID", f"{REST}\n        return np.clip(push + self.integral,", "self.integral, d = grown, push - self.kp * error\n"
         "        return np.clip(push - d + np.clip(grown + d, -self.limit, self.limit),", "it winds up: after 10 s"),
        ("PID", "kd=0, limit_pwm=255, period=0.01", "limit_pwm=255, period=0.01, kd=0", "in this order"),
        ("PID", "qd_wanted, qdd_wanted = ", "qdd_wanted, qd_wanted = ", "the wanted acceleration"),
        ("PID", f"{SPEED}\n        self.last = q\n        push = self.kp * error + self.kd * (qd_wanted - self.speed)",
         SPEED.replace("((q", "(qd_wanted - (q") + "\n        self.last = q\n        "
         "push = self.kp * error + self.kd * self.speed", "goes through the filter, too"),
        ("PID", "1 - np.exp(-2 * np.pi * filter_hz * period)", "0.47", "D is not kd times the filtered speed"),
        ("PID", " + self.kd * (qd_wanted - self.speed)\n        grown = self.integral + self.ki * error",
         "\n        grown = self.integral + self.ki * (error + self.kd * (qd_wanted - self.speed))", "only through ki"),
        ("PID", "(q - self.last)", "(q[1] - self.last[1])", "; joint 2 is right"),
        ("PID", "if self.last is not None:\n    ",
         "if self.last is None:\n            self.last = q_wanted\n        if True:\n    ", "come from its target"),
        ("PID", "self.kp * error + self.kd * (qd_wanted - self.speed)",
         "self.kp * (error + self.kd * (qd_wanted - self.speed))", "kp multiplies D"),
        ("PID", "np.clip(push + self.integral, -self.limit, self.limit)", "np.clip(self.kp * error + self.integral, "
         "-self.limit, self.limit) + np.clip(push - self.kp * error, -self.limit, self.limit)", "limit the sum"),
        ("PID", "qd_wanted - self.speed", "qd_wanted + self.speed", "along with the motion"),
        ("PID", SPEED, "self.speed = (q - self.last) / self.period", "not filtered"),
        ("PID", "(q - self.last) / self.period", "(q - self.last)", "no speed yet"),
        ("PID", SPEED, "self.speed = self.share * (q - self.last) / self.period", "its filter keeps nothing"),
        ("PID", "qd_wanted - self.speed", "np.degrees(qd_wanted - self.speed)", "57 times"),
        ("PID", "self.kd * (qd_wanted - self.speed)", "self.kd * error", "how fast it moves"),
        ("PID", "        if self.last is not None:\n", "        self.last = q\n        if self.last is not None:\n",
         "before it is written over"),
        ("PID.limits", "return np.clip(self.kp * error + self.integral, -self.limit, self.limit)",
         "u = self.kp * error + self.integral\n        return np.where(np.abs(u) > self.limit, 0, u)",
         "it sends [0., 0., 4.]"),
        ("PID", "(q - self.last) / self.period", "(q - self.last) / 0.01", "0.01 s is written"),
        ("PID", "self.last = None", "self.last = np.zeros(3)", "come from zero"),
        ("PID", "2 * np.pi * filter_hz", "filter_hz", "six times too slow"),
        ("PID", "qd_wanted - self.speed", "-self.speed", "which speed is wanted"),
        ("PID", "        self.speed = np.zeros(3)\n", '        self.speed = getattr(self, "speed", np.zeros(3))\n',
         "last angle"),
        ("PID", "return np.clip(push + self.integral, -self.limit, self.limit)",
         "return np.clip(self.kp * error + self.integral, -self.limit, self.limit) + push - self.kp * error",
         "limit the sum"),
    ],
)  # fmt: skip
def test_wrong_ones_are_told_apart(stage, old, new, words):
    verdict = grade(task(stage), made(edited(stage, (old, new))))
    assert verdict.state == "wrong"
    assert words in verdict.says, verdict.says


@pytest.mark.parametrize("stage", ALL)
def test_every_mistake_in_a_table_gets_its_own_sentence(stage):
    earlier = {"the integral has the gain kp: it has its own, ki"}  # told by what it adds to P where ki is 0
    for wrong, says in trials._made(stage, "mistakes"):
        verdict = grade(task(stage), wrong)
        assert verdict.state == "wrong" and (says in verdict.says or says in earlier), verdict.says


def test_no_reset_a_shared_memory_gains_read_once_and_a_kick():
    no_reset = edited("PID.pi", ("        self.reset()", "        self.integral = np.zeros(3)"))
    no_reset = no_reset.replace("    def reset(self):\n        self.integral = np.zeros(3)\n\n", "")
    assert "no `reset`" in grade(task("PID.pi"), made(no_reset)).says

    shared = edited("PID.pi", ("        self.integral = np.zeros(3)", "        self.integral[:] = 0"))
    shared = shared.replace('    unit = "PWM"\n', '    unit = "PWM"\n    integral = np.zeros(3)\n')
    shared = shared.replace("self.integral = self.integral +", "self.integral +=")
    shared = shared.replace("        self.reset()\n", "")
    assert "one memory" in grade(task("PID.pi"), made(shared)).says

    once = edited(
        "PID.p", ("self.kp = kp", "self.kp = kp\n        self.gain = kp"), ("return self.kp", "return self.gain")
    )
    assert "was changed while it ran" in grade(task("PID.p"), made(once)).says

    kick = edited("PID", ("(q - self.last)", "(error - self.last)"), ("self.last = q", "self.last = error"))
    kick = kick.replace("qd_wanted - self.speed", "self.speed")
    assert "kicks" in grade(task("PID"), made(kick)).says


def test_a_memory_limited_in_rad_s_is_told():
    text = edited("PID.limits", ("self.ki * error", "error"), ("+ grown", "+ self.ki * grown"))
    text = text.replace("np.where(winds_up, self.integral, grown)", "np.clip(grown, -self.limit, self.limit)")
    text = text.replace("error + self.integral,", "error + self.ki * self.integral,")
    assert "your memory is in rad s" in grade(task("PID.limits"), made(text)).says


def test_an_integral_that_waits_for_the_last_push_is_told():
    """Deciding by what was returned last locks up: at its limit it never integrates again."""
    text = edited("PID.limits", (WINDS, "winds_up = np.abs(self.pushed) >= self.limit"))
    text = text.replace("self.integral = np.zeros(3)", "self.integral = np.zeros(3)\n        self.pushed = np.zeros(3)")
    text = text.replace("        return np.clip(", "        self.pushed = np.clip(")
    assert "never lets go" in grade(task("PID.limits"), made(text + "\n        return self.pushed")).says


def test_each_stage_takes_the_place_of_the_one_before(home, capsys):
    for stage in ALL:
        check(stage, cell(solutions.source(stage), "PID"))
        assert "right, and yours: from now on my_robot.PID is this class" in capsys.readouterr().out
        assert folder.is_there(stage) and my_robot.whose("PID") == "yours"
        catalogue._at.clear()  # another notebook: a stage on the way is not used there
        assert my_robot.whose("PID") == ("yours" if stage == "PID" else "the course's")
        assert my_robot.PID(kp=1, ki=1, kd=1).unit == "PWM"
    assert len(list((home / "my_robot" / "old").glob("PID_*.py"))) == 3


def test_an_early_stage_run_again_says_where_the_finished_class_went(home, capsys):
    check("PID.pi", cell(solutions.source("PID.pi"), "PID"))
    check("PID", cell(solutions.source("PID"), "PID"))
    assert "finished" not in capsys.readouterr().out
    check("PID.p", cell(solutions.source("PID.p"), "PID"))
    assert "finished PID was put aside, into my_robot/old" in capsys.readouterr().out
    assert any("filter_hz" in file.read_text(encoding="utf-8") for file in (home / "my_robot" / "old").glob("PID_*.py"))


def test_what_stands_in_is_at_the_same_stage(capsys):
    target = np.array([0.0, 0.8, 0.0])
    check("PID.p")
    short = simulate(IR50P, my_robot.PID(kp=400), target, duration=3)
    mine = simulate(IR50P, made(task("PID.p").loan)(kp=400), target, duration=3)
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
    ("stage", "old", "new", "line", "reason"),
    [
        ("PID.p", "self.kp * error", "[self.kp[i] * error[i] for i in range(3)]", "`return [self", "`self.kp` is 50"),
        (
            "PID.pi",
            "self.ki * error * self.period",
            "self.ki * self.period * error",
            "`self.integral = ",
            "a tuple: three",
        ),
        ("PID.pi", "self.integral = np.zeros(3)", "integral = np.zeros(3)", "`self.integral = ", "are two: without"),
        ("PID.pi", ADD, ADD.replace("self.integral", "integral"), "`integral = integral", "are two: without"),
        ("PID.p", "self.kp = kp", "self.kp = float(kp)", "`self.kp = float(kp)`", "one a joint"),
        ("PID.pi", "self.integral = self.integral + self", "self.integral += self", "`self.integral += self", "whole"),
        ("PID.limits", WINDS, "winds_up = np.abs(push) > self.limit and push * error > 0", "`winds_up =", "np.where"),
        (
            "PID.limits",
            WINDS,
            "winds_up = np.abs(push) > self.limit & push * error > 0",
            "`winds_up =",
            "needs brackets",
        ),
        (
            "PID",
            "self.kd * (qd_wanted - self.speed)",
            "-self.kd * (self.speed - qd_wanted)",
            "`push = ",
            "a tuple cannot",
        ),
        ("PID", "self.last is not None", "self.last", "`if self.last:`", "`is None` asks"),
        ("PID", "self.last is not None", "self.last != None", "`if self.last != None:`", "`is None` asks"),
        ("PID", "if self.last is not None:", "if True:", "`self.speed = ", "in the first step self.last is still None"),
    ],
)
def test_a_class_that_stops_is_told_the_line(stage, old, new, line, reason, capsys):
    text = edited(stage, (old, new))
    if reason == "whole":
        text = text.replace("np.zeros(3)", "np.array([0, 0, 0])")
    check(stage, cell(text, "PID"))
    said = capsys.readouterr().out
    assert f"it stops in {line}" in said and reason in said.split("Python says")[0], said


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
