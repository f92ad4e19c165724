"""The PID of the textbook, in continuous time: the thesis' simulation case (2.3), Tables 2.1-2.3."""

import numpy as np

from ir50p_lab.controllers.gains import gains, limits


class ContinuousPID:
    """u(t) = kp e + ki int e dt + kd de/dt at every instant, with the true velocity    (2.3)

    No computer runs it: it has no sampling period, filter or delay. It exists to reproduce the thesis' Simulink
    figures and to compare with the sampled `PID`.

    Args: kp, ki, kd: (3,) N m per rad, per rad s, per rad/s; limit: N m, scalar or (3,), None: not limited (the
    integral then rests while the command is limited and the error would push it further).
    """

    continuous = True
    unit = "N m"

    def __init__(self, kp, ki=(0.0, 0.0, 0.0), kd=(0.0, 0.0, 0.0), *, limit=None):
        self.kp, self.ki, self.kd = gains("kp", kp), gains("ki", ki), gains("kd", kd)
        self.limit = np.broadcast_to(limits(limit), 3).copy()

    @property
    def parameters(self):
        """kp, ki, kd, limit in a row, (12,), as the compiled loop takes them."""
        return np.concatenate([self.kp, self.ki, self.kd, self.limit])
