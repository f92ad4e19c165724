"""friction_torque: what a joint that moves has to overcome."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def friction_torque(qd, fv, fc, fs, qs, offset):
    """Return friction as it stands on the left of (1.74), (3,) N m    (1.115)-(1.117), the offset from (1.118)."""
    fading = np.exp(-((qd / qs) ** 2))
    dry = fc + (fs - fc) * fading
    return fv * qd + np.sign(qd) * dry + offset


def _speeds():
    rng = np.random.default_rng(71)
    at_rest = [0.0, 0.5, -0.03], [0.04, -0.06, 0.0], [-0.8, 0.0, 0.1], [0.0, 0.0, 0.0]
    tried = [[1.3, -0.7, slow] for slow in (0.1, -0.1, 0.02, -0.02, 0.05, -0.05)]  # fast both ways
    speeds = [*rng.permuted(tried, axis=1), *at_rest]
    cases = []
    for qd in (*np.array(speeds), np.array([1, -1, 2])):
        fv, fc, more, qs, offset = rng.uniform([0.2, 0.2, 0.2, 0.03, -0.3], [1, 0.6, 0.6, 0.08, 0.3], (3, 5)).T
        cases.append((qd, fv, fc, fc + more * (len(cases) != 4), qs, offset))
    return cases


_SAYS = sentences("friction_torque", __file__)


def _symptom(case, returned, expected):
    fast, off = np.abs(case[0] / case[4]) > 6, np.abs(returned - expected)
    if (off[fast & (case[0] < 0)] > 1e-9).any() and (off[case[0] >= 0] < 1e-9).all():
        return _SAYS["back"]
    slow_alone = fast.sum() > 1 and off[fast].max() < 0.05 * off.max()
    return _SAYS["slow"] if slow_alone and (off[case[0] == 0] < 1e-9).all() else ""


TASK = task_of(
    friction_torque, cases=_speeds, entry_names=("joint 1", "joint 2", "joint 3"), unit="N m", symptom=_symptom
)
