"""adaptive_step: numbers of a model that change while it drives."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


def adaptive_step(theta, Y, s, gain, dt):
    """Return theta (3, 20) after dt (s): a number falls if Y (3, 20) and the s (3,) of its row agree in sign."""
    change = np.zeros((3, 20))
    for joint in range(3):
        change[joint] = gain[joint] * Y[joint] * s[joint]
    return theta - dt * change


def _steps():
    rng = np.random.default_rng(151)
    cases = []
    for k in range(5):
        theta, Y, gain = rng.normal(size=(3, 3, 20))
        cases.append((theta, Y, rng.normal(size=3), 60 * np.abs(gain), (0.01, 0.05)[k % 2]))
    theta, Y, gain = rng.normal(size=(3, 3, 20))
    few = np.where(np.arange(20) < 4, 30.0, 0.0) * np.ones((3, 1))
    return [*cases, (theta, Y, np.array([0.5, 0.0, -1.0]), few, 0.01), (theta, Y, np.zeros(3), few, 0.01)]


TASK = task_of(adaptive_step, cases=_steps)
