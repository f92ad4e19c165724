"""rk4_step: one step of Runge and Kutta's method."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.course.motion.functions import rates


def rk4_step(f, t, x, dt):
    """x after one step of dt (s), from x at the time t, where f(t, x) is its rate."""
    k1 = f(t, x)
    k2 = f(t + dt / 2, x + dt / 2 * k1)
    k3 = f(t + dt / 2, x + dt / 2 * k2)
    k4 = f(t + dt, x + dt * k3)
    return x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def _steps():
    return [
        (rates.swinging, 0.0, np.array([0.5, -0.3]), 0.2),
        (rates.swinging, 1.5, np.array([1, 2]), 0.1),
        (rates.by_the_clock, 0.7, np.array([0.2, 0.1]), 0.4),
        (rates.growing, 0.5, np.array([0.8, -1.5]), 0.3),
        (rates.cooling, 0.0, np.array([1.5]), 0.3),
        (rates.three_joints, 0.4, rates.SIX.copy(), 0.25),
        (rates.three_joints, 0.0, -rates.SIX, 0.05),
    ]


def _symptom(case, returned, expected):
    change, right = returned - case[2], expected - case[2]
    factor = change @ right / (right @ right)
    if len(right) == 1 or not np.allclose(change, factor * right, rtol=1e-6):
        return ""
    return sentences(rk4_step)["against" if factor < 0 else "factor"]


TASK = task_of(rk4_step, cases=_steps, symptom=_symptom)
