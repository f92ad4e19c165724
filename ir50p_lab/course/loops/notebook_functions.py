"""The function of 09 that stays in its notebook: the course's, what it is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks


def rule(K, T, L, tau_c):
    """Return Kp, Ki and Kd for a joint whose speed answers a push with K, T and L (SIMC)."""
    gain, Ti = 1 / (K * (tau_c + L)), 4 * (tau_c + L)
    return gain * (1 + T / Ti), gain / Ti, gain * T


def _joints():
    low, high = [0.005, 0.05, 0.01, 0.05], [0.02, 0.3, 0.05, 0.3]
    return [tuple(row) for row in np.random.default_rng(9).uniform(low, high, (6, 4))]


TASKS = notebook_tasks(
    __file__,
    rule=(rule, _joints, "Kp, Ki and Kd, three numbers", {"results": ("Kp", "Ki", "Kd")}),
)
