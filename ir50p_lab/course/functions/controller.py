"""The controller of 08: a class, written in four stages: push, memory, limits, damping."""

import numpy as np

from ir50p_lab import controllers
from ir50p_lab.course.functions import controller_trials as trials
from ir50p_lab.course.functions.task import Task


class PID(controllers.PID):
    """The course's PID with the arguments of the student's    (2.1)-(2.4)."""

    def __init__(self, kp, ki=0.0, kd=0.0, limit_pwm=255, period=0.01, filter_hz=10, **options):
        super().__init__(kp, ki=ki, kd=kd, limit_pwm=limit_pwm, period=period, filter_hz=filter_hz, **options)


class _P(PID):
    def __init__(self, kp):
        super().__init__(kp, limit_pwm=np.inf)


class _PI(PID):
    def __init__(self, kp, ki=0.0, period=0.01):
        super().__init__(kp, ki=ki, period=period, limit_pwm=np.inf)


class _LimitedPI(PID):
    def __init__(self, kp, ki=0.0, limit_pwm=255, period=0.01):
        super().__init__(kp, ki=ki, limit_pwm=limit_pwm, period=period)


_TEST = """import numpy as np

from my_robot import PID


def test_PID():
    reference = np.array([[0.1, 0.2, -0.3], [0, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(PID(kp=100).step(0, np.zeros(3), reference), [10, 20, -30])
"""

_LOAN_P = """class PID:
    unit = "PWM"

    def __init__(self, kp):
        self.kp = kp

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        return self.kp * error"""

_LOAN_PI = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, period=0.01):
        self.kp, self.ki, self.period = kp, ki, period
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        self.integral = self.integral + self.ki * error * self.period
        return self.kp * error + self.integral"""

_LOAN_LIMITS = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, limit_pwm=255, period=0.01):
        self.kp, self.ki, self.limit, self.period = kp, ki, limit_pwm, period
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        grown = self.integral + self.ki * error * self.period
        push = self.kp * error + grown
        winds_up = (np.abs(push) > self.limit) & (push * error > 0)
        self.integral = np.where(winds_up, self.integral, grown)
        return np.clip(self.kp * error + self.integral, -self.limit, self.limit)"""

_LOAN_PID = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, kd=0, limit_pwm=255, period=0.01, filter_hz=10):
        self.kp, self.ki, self.kd, self.limit, self.period = kp, ki, kd, limit_pwm, period
        self.share = 1 - np.exp(-2 * np.pi * filter_hz * period)
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)
        self.speed = np.zeros(3)
        self.last = None

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        if self.last is not None:
            self.speed = self.speed + self.share * ((q - self.last) / self.period - self.speed)
        self.last = q
        push = self.kp * error + self.kd * (qd_wanted - self.speed)
        grown = self.integral + self.ki * error * self.period
        winds_up = (np.abs(push + grown) > self.limit) & ((push + grown) * error > 0)
        self.integral = np.where(winds_up, self.integral, grown)
        return np.clip(push + self.integral, -self.limit, self.limit)"""


def _stage(name, right, loan, asks, hints, *parts):
    return Task(
        name=name,
        asks=asks,
        right=right,
        loan=loan,
        tried=trials.tried_by(*parts),
        test=_TEST,
        hints=hints,
    )


TASKS = (
    _stage("PID.p", _P, _LOAN_P, "a class whose `step` gives three pushes in PWM counts, kp times the error",
           ("How far away is each joint? One line gives three numbers.",
            "The arm is below the target. Should the push be positive or negative? Does yours agree?"),
           *trials.PUSH, trials.gains("kp")),
    _stage("PID.pi", _PI, _LOAN_PI, "the same with a memory, `self.integral`, and a `reset`",
           ("In one period the error covers an area: error x period. Where is their sum kept between two steps?",
            "reset() sets the memory to three zeros; __init__ calls it, so that there is one from the beginning."),
           *trials.PUSH, *trials.MEMORY, trials.gains("kp", "ki")),
    _stage("PID.limits", _LimitedPI, _LOAN_LIMITS,
           "the same within its limits, the integral resting while the push can grow no further",
           ("np.clip(push, -limit, limit) limits what is returned. What does the integral do meanwhile?",
            "What would the push be with the grown integral, before you clip it? Beyond the limit, "
            "and the error pushing further: keep the old one. np.where(condition, old, new) decides for all joints."),
           *trials.PUSH, *trials.MEMORY, *trials.LIMITS, trials.gains("kp", "ki")),
    _stage("PID", PID, _LOAN_PID,
           "the whole controller: P, I within limits, and D against the filtered speed",
           ("Speed: how far the angle has moved since the last step, by the period. The first step knows none.",
            "First-order filter: at each sample the speed moves a share 1 - exp(-2 pi filter_hz period) of the way "
            "to the new one. Three memories now; reset has to know them all."),
           *trials.SPEED, *trials.PUSH, *trials.MEMORY, *trials.LIMITS, *trials.DAMPING,
           trials.gains("kp", "ki", "kd")),
)  # fmt: skip
