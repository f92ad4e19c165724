"""The function of 09 that stays in its notebook: the course's, what it is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.controllers import simc_integrating
from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.identification import FOPDT


def rule(K, T, L, tau_c):
    """Kp, Ki and Kd for a joint whose speed answers a push with K, T and L (SIMC)."""
    gains = simc_integrating(FOPDT(K=K, T=T, L=L), tau_c=tau_c)
    return gains.kp, gains.ki, gains.kd


def _joints():
    low, high = [0.005, 0.05, 0.01, 0.05], [0.02, 0.3, 0.05, 0.3]
    return [tuple(row) for row in np.random.default_rng(9).uniform(low, high, (6, 4))]


TASKS = notebook_tasks(
    __file__,
    rule=(rule, _joints, "Kp, Ki and Kd, three numbers", {"results": ("Kp", "Ki", "Kd")}),
)
