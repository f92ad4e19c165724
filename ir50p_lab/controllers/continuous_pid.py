"""The PID of the textbook, in continuous time, as the thesis simulates it (2.3), Tables 2.1-2.3."""

import numpy as np

from ir50p_lab.controllers import law
from ir50p_lab.controllers.base import gains, limits, three


class ContinuousPID:
    """u(t) = kp e + ki int e dt + kd de/dt at every instant, with the true velocity    (2.3)

    No computer runs this controller: it has no sampling period, filter or delay. It is here to reproduce the thesis's
    Simulink figures and to compare with the sampled `PID`.

    Args: kp, ki, kd: (3,) N m per rad, per rad s, per rad/s; limit: N m, scalar or (3,), None: not limited (with a
    limit the integral rests while the command is limited and the error would drive it further).
    Attributes: kp, ki, kd, limit (3,); parameters (12,): kp, ki, kd, limit in a row, as the compiled loop takes them.
    """

    continuous = True
    unit = "N m"
    kp = three(law.KP, "Proportional gains (3,), N m/rad.")
    ki = three(law.KI, "Integral gains (3,), N m/(rad s).")
    kd = three(law.KD, "Derivative gains (3,), N m s/rad.")
    limit = three(law.LIMIT, "Limits of the command (3,), N m; infinite where there is none.")

    def __init__(self, kp, ki=0.0, kd=0.0, *, limit=None):
        self.parameters = np.concatenate([gains("kp", kp), gains("ki", ki), gains("kd", kd), limits(limit)])
