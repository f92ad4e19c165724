"""PID: a class, written in four stages: push, memory, limits, damping."""

from functools import partial

import numpy as np

from ir50p_lab import controllers
from ir50p_lab.course.checking.task import Task, changed, solutions, table
from ir50p_lab.course.loops.functions.PID_trials import LOANS, tried


class PID(controllers.PID):
    """The course's PID with the arguments of the student's    (2.1)-(2.4)."""

    def __init__(self, kp, ki=0.0, kd=0.0, limit_pwm=255, period=0.01, filter_hz=10, **options):
        super().__init__(kp, ki=ki, kd=kd, limit_pwm=limit_pwm, period=period, filter_hz=filter_hz, **options)


_TEST = solutions("PID.test", __file__)[0] + "\n"


def _task(stage, asks, *hints):
    right = PID if stage == "PID" else changed(LOANS[stage], (), {"np": np})["PID"]
    return Task(stage, asks, right, LOANS[stage], tried=partial(tried, stage), test=_TEST, hints=hints)


STAGES = {stage: _task(stage, *words) for stage, words in table("PID.stages", __file__)}  # what it returns, two hints
TASK = STAGES["PID"]
