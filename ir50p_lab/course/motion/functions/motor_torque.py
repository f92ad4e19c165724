"""motor_torque: what a motor gives at its joint, by counts and speed."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def motor_torque(u_pwm, qd, gain, damping):
    """Return the torque of the motors at the joints, (3,) N m    (1.118)-(1.120 corrected, without the rotor)."""
    push = gain * u_pwm
    brake = damping * qd
    return push - brake


def _drives():
    rng = np.random.default_rng(73)
    counts, speeds = rng.integers(-255, 256, (6, 3)), rng.uniform(-1.2, 1.2, (6, 3))
    counts[1], speeds[2] = 0, 0  # turned at no counts; at rest
    counts[3:5] = [255, 0, -255], [40, -30, 10]
    speeds[4] = 1.0, -0.9, 0.8  # faster than these counts drive it
    numbers = rng.uniform([0.01, 0.5], [0.04, 3.0], (6, 3, 2))
    return [(u, qd, *both.T) for u, qd, both in zip(counts, speeds, numbers, strict=True)]


_SAYS = sentences("motor_torque", __file__)


def _symptom(case, returned, expected):
    counts, speed = case[:2]
    off = np.abs(returned - expected) > 1e-9
    return _SAYS["push"] if off[speed == 0].any() else _SAYS["brake"] if off[counts == 0].any() else ""


TASK = task_of(motor_torque, cases=_drives, entry_names=("joint 1", "joint 2", "joint 3"), unit="N m", symptom=_symptom)
