"""motor_torque: what a motor gives at its joint, by counts and speed."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def motor_torque(u_pwm, qd, gain, damping):
    """Torque of the motors at the joints, (3,) N m    (1.118)-(1.120 corrected, without the rotor)."""
    push = gain * u_pwm
    brake = damping * qd
    return push - brake


def _drives():
    rng = np.random.default_rng(73)
    counts = np.array(
        [[200, -90, 60], [0, 0, 0], [255, -255, 255], [-150, 20, -255], [120, 0, -30], [0, 255, 0], [40, -30, 10]]
    )
    speeds = [
        [0.5, 0.2, -0.4],
        [1.0, -0.3, 0.6],
        [0, 0, 0],
        [-0.4, -0.7, 0.2],
        [-0.2, 0.9, 0.6],
        [0.7, 0.3, -1.1],
        [1.0, -0.9, 0.8],
    ]
    strong = rng.uniform([0.01, 0.5], [0.04, 3.0], (7, 3, 2))
    return [(u, np.array(qd), *both.T) for u, qd, both in zip(counts, speeds, strong, strict=True)]


_SAYS = sentences(motor_torque)


def _symptom(case, returned, expected):
    counts, speed = case[:2]
    off = np.abs(returned - expected) > 1e-9
    return _SAYS["push"] if off[speed == 0].any() else _SAYS["brake"] if off[counts == 0].any() else ""


TASK = task_of(motor_torque, cases=_drives, parts=("joint 1", "joint 2", "joint 3"), unit="N m", symptom=_symptom)
