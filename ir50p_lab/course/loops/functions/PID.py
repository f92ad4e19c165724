"""PID: a class, written in four stages: push, memory, limits, damping."""

from functools import partial

import numpy as np

from ir50p_lab import controllers
from ir50p_lab.course.checking.task import Task, changed, solutions
from ir50p_lab.course.loops.functions.PID_trials import LOANS, tried


class PID(controllers.PID):
    """The course's PID with the arguments of the student's    (2.1)-(2.4)."""

    def __init__(self, kp, ki=0.0, kd=0.0, limit_pwm=255, period=0.01, filter_hz=10, **options):
        super().__init__(kp, ki=ki, kd=kd, limit_pwm=limit_pwm, period=period, filter_hz=filter_hz, **options)


_TEST = solutions("PID.test", __file__)[0] + "\n"
_STAGES = {  # what each returns, and its two hints
    "PID.p": (
        "a class whose `step` gives three pushes in PWM counts, kp times the error",
        "How far away is each joint? One line gives three numbers.",
        "The arm is below the target. Should the push be positive or negative? Does yours agree?",
    ),
    "PID.pi": (
        "the same with a memory, `self.integral`, and a `reset`",
        "In one period the error covers an area: error x period. Where is their sum kept between two steps?",
        "reset() sets the memory to three zeros; __init__ calls it, so that there is one from the beginning.",
    ),
    "PID.limits": (
        "the same within its limits, the integral resting while the push can grow no further",
        "np.clip(push, -limit, limit) limits what is returned. What does the integral do meanwhile?",
        "What would the push be with the grown integral, before you clip it? Beyond the limit, and the error pushing "
        "further: keep the old one. np.where(condition, old, new) decides for all joints.",
    ),
    "PID": (
        "the whole controller: P, I within limits, and D against the filtered speed",
        "Speed: how far the angle has moved since the last step, by the period. The first step knows none.",
        "First-order filter: at each sample the speed moves a share 1 - exp(-2 pi filter_hz period) of the way to the "
        "new one. Three memories now; reset has to know them all.",
    ),
}


def _task(stage, asks, *hints):
    right = PID if stage == "PID" else changed(LOANS[stage], (), {"np": np})["PID"]
    return Task(
        stage,
        asks,
        right,
        LOANS[stage],
        tried=partial(tried, stage),
        test=_TEST,
        hints=hints,
    )


STAGES = {stage: _task(stage, *words) for stage, words in _STAGES.items()}
TASK = STAGES["PID"]
