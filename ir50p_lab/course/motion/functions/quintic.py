"""quintic: a motion that starts and ends at rest, with its speeds and accelerations."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


def quintic(q0, q1, duration, t):
    """Return angle, speed and acceleration at t (s) of a motion from q0 to q1 (rad); at rest outside [0, duration]."""
    s = np.clip(np.asarray(t, dtype=float) / duration, 0, 1)
    way = q1 - q0
    q = q0 + way * (10 * s**3 - 15 * s**4 + 6 * s**5)
    qd = way / duration * (30 * s**2 - 60 * s**3 + 30 * s**4)
    qdd = way / duration**2 * (60 * s - 180 * s**2 + 120 * s**3)
    return q, qd, qdd


def _ways():
    here, there = np.array([0.3, -0.4, 1.2]), np.array([-0.5, 0.9, 1.5])
    return [
        *((here.copy(), there.copy(), 2.0, t) for t in (0.6, 1.7, -0.5, 0.0, 2.0, 3.1)),
        (np.array([0, 1, 2]), np.array([2, -1, 0]), 0.8, 0.3),
        (0.4, -0.9, 1.5, np.linspace(-0.5, 2.0, 11)),
        (0, 1, 4, np.arange(6)),
    ]


TASK = task_of(quintic, cases=_ways, results=("q", "qd", "qdd"))
