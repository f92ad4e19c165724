"""The controller of 08: a class, written in four stages: push, memory, limits, damping."""

import numpy as np

from ir50p_lab import controllers
from ir50p_lab.course.checking.task import Task, changed
from ir50p_lab.course.loops.functions import controller_loans as loans
from ir50p_lab.course.loops.functions import controller_trials as trials


class PID(controllers.PID):
    """The course's PID with the arguments of the student's    (2.1)-(2.4)."""

    def __init__(self, kp, ki=0.0, kd=0.0, limit_pwm=255, period=0.01, filter_hz=10, **options):
        super().__init__(kp, ki=ki, kd=kd, limit_pwm=limit_pwm, period=period, filter_hz=filter_hz, **options)


_TEST = """import numpy as np

from my_robot import PID


def test_PID():
    reference = np.array([[0.1, 0.2, -0.3], [0, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(PID(kp=100).step(0, np.zeros(3), reference), [10, 20, -30])
"""


def _stage(name, loan, asks, hints, *parts):
    right = PID if name == "PID" else changed(loan, (), {"np": np})["PID"]
    return Task(name, asks, right, loan, tried=trials.tried_by(*parts), test=_TEST, hints=hints)


_ALL = (
    _stage("PID.p", loans.P, "a class whose `step` gives three pushes in PWM counts, kp times the error",
           ("How far away is each joint? One line gives three numbers.",
            "The arm is below the target. Should the push be positive or negative? Does yours agree?"),
           *trials.PUSH, trials.gains("kp")),
    _stage("PID.pi", loans.PI, "the same with a memory, `self.integral`, and a `reset`",
           ("In one period the error covers an area: error x period. Where is their sum kept between two steps?",
            "reset() sets the memory to three zeros; __init__ calls it, so that there is one from the beginning."),
           *trials.PUSH, *trials.MEMORY, trials.gains("kp", "ki")),
    _stage("PID.limits", loans.LIMITS,
           "the same within its limits, the integral resting while the push can grow no further",
           ("np.clip(push, -limit, limit) limits what is returned. What does the integral do meanwhile?",
            "What would the push be with the grown integral, before you clip it? Beyond the limit, "
            "and the error pushing further: keep the old one. np.where(condition, old, new) decides for all joints."),
           *trials.PUSH, *trials.MEMORY, *trials.LIMITS, trials.gains("kp", "ki")),
    _stage("PID", loans.PID,
           "the whole controller: P, I within limits, and D against the filtered speed",
           ("Speed: how far the angle has moved since the last step, by the period. The first step knows none.",
            "First-order filter: at each sample the speed moves a share 1 - exp(-2 pi filter_hz period) of the way "
            "to the new one. Three memories now; reset has to know them all."),
           *trials.SPEED, *trials.PUSH, *trials.MEMORY, *trials.LIMITS, *trials.DAMPING,
           trials.gains("kp", "ki", "kd")),
)  # fmt: skip

*_ON_THE_WAY, TASK = _ALL
STAGES = {stage.name: stage for stage in _ON_THE_WAY}
