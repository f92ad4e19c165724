"""integrate: step after step, from the start to the end."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.motion.functions import rates
from ir50p_lab.course.motion.functions.rk4_step import rk4_step


def integrate(f, x0, duration, dt):
    """Return the times t (n + 1,) from 0 to duration (s) in steps of dt, and x (n + 1, len(x0)) at each of them."""
    steps = round(duration / dt)
    t = dt * np.arange(steps + 1)
    x = np.zeros((steps + 1, len(x0)))
    x[0] = x0
    for k in range(steps):
        x[k + 1] = rk4_step(f, t[k], x[k], dt)
    return t, x


def _runs():
    return [
        (rates.swinging, np.array([0.5, -0.3]), 0.3, 0.1),
        (rates.growing, np.array([0.8, 1.5]), 0.7, 0.1),
        (rates.by_the_clock, np.array([0.2, 0.1]), 0.4, 0.05),
        (rates.swinging, np.array([1, 2]), 2.0, 0.25),
        (rates.cooling, np.array([1.5]), 0.5, 0.5),
        (rates.three_joints, rates.SIX.copy(), 0.6, 0.2),
        (rates.cooling, np.array([0.7]), 0.2, 0.1),
        (rates.swinging, np.array([0.3, 0.1]), 0.33, 0.03),
    ]


TASK = task_of(integrate, cases=_runs, leans_on=("rk4_step",), results=("t", "x"))
