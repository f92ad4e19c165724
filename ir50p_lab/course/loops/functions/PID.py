"""PID: a class, written in four stages: push, memory, limits, damping."""

from functools import partial

import numpy as np

from ir50p_lab import controllers
from ir50p_lab.course.checking.task import Task, apply_changes, words
from ir50p_lab.course.loops.functions.PID_trials import LOANS, tried


class PID(controllers.PID):
    """The course's PID, with the arguments of the student's    (2.1)-(2.4)."""

    def __init__(self, kp, ki=0.0, kd=0.0, limit_pwm=255, period=0.01, filter_hz=10, **options):
        super().__init__(kp, ki=ki, kd=kd, limit_pwm=limit_pwm, period=period, filter_hz=filter_hz, **options)


def _task(stage):
    right = PID if stage == "PID" else apply_changes(LOANS[stage], (), {"np": np})["PID"]
    options = words(stage, __file__) | {"test": words("PID", __file__)["test"]}
    return Task(name=stage, reference=right, solution_text=LOANS[stage], trial=partial(tried, stage), **options)


STAGES = {stage: _task(stage) for stage in LOANS}
TASK = STAGES["PID"]
