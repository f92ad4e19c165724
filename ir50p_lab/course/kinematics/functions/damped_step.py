"""damped_step: one damped step of the joints towards a place."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def damped_step(q, p, l, damping):
    """Return the next q (3,) after one step of damped least squares towards p    (1.56)-(1.59 corrected)."""
    T = frames(q, l)
    tip = T[3][:3, 3]
    J = jacobian(T, 3, tip)[:3]
    missing = p - tip
    matrix = J @ J.T + damping**2 * np.eye(3)
    push = np.linalg.solve(matrix, missing)
    step = J.T @ push
    return q + step


def _steps():
    rng = np.random.default_rng(41)
    cases = []
    for k in range(8):
        l = LENGTHS[k % 3].copy()
        q = rng.uniform([-2, -1, -1.5], [2, 1, 1.5])
        p = forward_kinematics(q, l) + rng.uniform(-0.1, 0.1, 3)
        cases.append((q, p, l, (0.02, 0.05, 0.2)[k % 3]))
    cases.append((np.array([0.3, 0.4, 0.0]), np.array([0.3, 0.1, 0.4]), LENGTHS[0].copy(), 0.02))  # stretched
    cases.append((np.array([0.3, 0.4, -0.5]), np.array([1.5, 0.0, 0.4]), LENGTHS[0].copy(), 0.05))  # out of reach
    return cases


_SAYS = sentences("damped_step", __file__)


def _symptom(case, returned, expected):
    q, p, l, _ = case
    tip = forward_kinematics(q, l)
    J = jacobian(frames(q, l), 3, tip)[:3]
    if np.linalg.norm(forward_kinematics(returned, l) - p) < 3e-3:
        return _SAYS["at the place"]
    steps = {"length": expected - q, "undamped": np.linalg.pinv(J) @ (p - tip), "transpose": J.T @ (p - tip)}
    for key, step in steps.items():
        if np.allclose(np.cross(returned - q, step), 0, atol=1e-6) and (returned - q) @ step > 0:
            return _SAYS[key]
    return ""


TASK = task_of(
    damped_step,
    cases=_steps,
    leans_on=("jacobian", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    tolerance=1e-5,  # a Jacobian by differences over 1e-6 rad leaves 2e-6
    entry_names=("q1", "q2", "q3"),
    symptom=_symptom,
)
