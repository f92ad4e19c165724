"""damped_step: one damped step of the joints towards a place."""

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of
from ir50p_lab.course.kinematics.functions import LENGTHS
from ir50p_lab.course.kinematics.functions.forward_kinematics import forward_kinematics
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def damped_step(q, p, l, damping):
    """One step of damped least squares towards p, the next q (3,)    (1.56)-(1.59 corrected)."""
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


def _step_symptom(cases, returned, expected):
    ends = [
        forward_kinematics(np.asarray(one, dtype=float), case[2]) for one, case in zip(returned, cases, strict=True)
    ]
    if sum(np.linalg.norm(end - case[1]) < 3e-3 for end, case in zip(ends, cases, strict=True)) > len(cases) / 2:
        return "it is at the place already: one step is asked for, the loop that repeats it stands outside"
    if says := _along(cases, returned, expected):
        return says
    worse = 0
    for (q, p, l, _), end in zip(cases, ends, strict=True):
        worse += np.linalg.norm(end - p) > np.linalg.norm(forward_kinematics(q, l) - p)
    if worse >= 0.7 * len(cases):
        return f"{worse} of {len(cases)} steps lead away from the place, not towards it"
    return (
        "most steps come nearer, but they are not those of the damped formula: look at the damping, at what is solved, "
        "and whether anything is cut or added afterwards"
    )


def _along(cases, returned, expected):
    """A step with another damping, or one with another length than the damped or the plain one."""
    mine, damped, plain, turned, added = [], [], [], [], []
    for (q, p, l, _), one, right in zip(cases, returned, expected, strict=True):
        J, missing = jacobian(frames(q, l), 3, forward_kinematics(q, l))[:3], p - forward_kinematics(q, l)
        left = J.T @ (missing - J @ (one - q))
        number = left @ (one - q) / max((one - q) @ (one - q), 1e-12)  # on the diagonal
        mine.append(one - q)
        damped.append(right - q)
        plain.append(np.linalg.pinv(J) @ missing)
        turned.append(J.T @ missing)
        added.append(number if np.allclose(number * (one - q), left, atol=1e-6) else np.nan)
    if np.isfinite(added).all():
        return f"{added[0]:.3g} is added on the diagonal where the damping is {cases[0][3]:g}: look at the formula"
    for says, steps in (
        ("the direction of the step is right, its length is not: is it cut, scaled or divided afterwards?", damped),
        (
            "it is the step without damping, made shorter or longer: the damping belongs inside, into what is solved, "
            "where it acts on the lost direction most",
            plain,
        ),
        (
            "it follows the transpose alone: is an equation solved? The step is too short or too long",
            turned,
        ),
    ):
        if all(np.allclose(np.cross(a, b), 0, atol=1e-6) and a @ b > 0 for a, b in zip(mine, steps, strict=True)):
            return says
    return ""


_BY_NORMAL_EQUATIONS = """def damped_step(q, p, l, damping):
    T = frames(q, l)
    tip = forward_kinematics(q, l)
    J = jacobian(T, 3, tip)[:3]
    e = p - tip
    A = J.T @ J + damping**2 * np.eye(3)
    dq = np.linalg.solve(A, J.T @ e)
    return q + dq"""


TASK = Task(
    name="damped_step",
    asks="the next q (3,) rad after one damped step towards p (m)",
    right=damped_step,
    cases=_steps,
    leans_on=("jacobian", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    tolerance=1e-5,  # a Jacobian by differences over 1e-6 rad leaves 2e-6
    parts=("q1", "q2", "q3"),
    loan=text_of(damped_step),
    routes=(_BY_NORMAL_EQUATIONS,),
    slips=mistakes(damped_step),
    symptom=_step_symptom,
    hints=(
        "Of your jacobian only the three rows of velocity count here: a place has three numbers.",
        "Solve (J J' + damping^2 1) y = what is missing, with np.linalg.solve. Then back to the joints with J'.",
    ),
)  # fmt: skip
