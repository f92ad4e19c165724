"""rk4_step: one step of Runge and Kutta's method."""

import numpy as np

from ir50p_lab.course.checking.task import task_of
from ir50p_lab.course.motion.functions import rates


def rk4_step(f, t, x, dt):
    """Return x after one step of dt (s), from x at the time t, where f(t, x) is its rate."""
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
        (rates.growing, 0.2, np.linspace(-0.6, 0.6, 7), 0.3),
    ]


def _symptom(case, returned, expected):
    """How much each of the right rates counts in the change: told by six numbers, not by one or two."""
    f, t, x, dt = case
    asked = []
    rk4_step(lambda t, x: asked.append(f(t, x)) or asked[-1], t, x, dt)
    table, mean = np.column_stack(asked), (returned - x) / dt
    counts = np.linalg.lstsq(table, mean)[0]
    if len(x) < 6 or not np.allclose(table @ counts, mean, rtol=0, atol=1e-9):
        return ""
    return f"the rates count {', '.join(f'{round(6 * one, 4) + 0.0:g}' for one in counts)} sixths: look at the weights"


TASK = task_of(rk4_step, cases=_steps, symptom=_symptom)
