"""The functions of 03: the Jacobian of any point of the arm, and one damped step towards a place."""

import numpy as np

from ir50p_lab.course.functions.pose import _LENGTHS, forward_kinematics, frames
from ir50p_lab.course.functions.task import Slip, Task


# -------------------------------------------------------------------------------------------------------- jacobian
def jacobian(T, link, point):
    """Velocity and turning of a point carried by a link, per joint speed, (6, 3)    (1.32)-(1.43 corrected)."""
    return _columns(T, link, point)


def _columns(T, link, point, *, axis=0, origin=0, across=np.cross, joints=None):
    """The Jacobian with one step replaced: the frame whose axis and origin count, the product, the joints."""
    J = np.zeros((6, 3))
    for joint in range(link if joints is None else joints):
        z, o = T[joint + axis][:3, 2], T[joint + origin][:3, 3]
        J[:3, joint] = across(z, point - o)
        J[3:, joint] = z
    return J


def _points():
    rng = np.random.default_rng(31)
    cases = []
    for k in range(9):
        q, l = rng.uniform(-2, 2, 3), _LENGTHS[k % 3]
        T = frames(q, l)
        link = 3 - k % 3
        tip = T[link][:3, 3]
        cases.append((T, link, tip.copy() if k < 3 else tip + rng.uniform(-0.1, 0.1, 3)))
    return cases


def _jacobian_symptom(cases, returned, expected):
    J, right = np.array(returned, dtype=float), np.array(expected)
    for k, (_, link, _) in enumerate(cases):
        if link < 3 and np.abs(J[k][:, link:]).max() > 1e-9:
            return f"link {link} moves with joint {link + 1}, which comes after it: which joints carry a link?"
    top, bottom = np.allclose(J[:, :3], right[:, :3]), np.allclose(J[:, 3:], right[:, 3:])
    if bottom and not top:
        if np.allclose(J[:, :3], -right[:, :3]):
            return "the velocities point backwards: axis x lever is not lever x axis"
        return (
            "the lower three rows (turning) are right, the upper three (velocity) are not: axis x lever, and the lever "
            "goes from where to where?"
        )
    if top and not bottom:
        return (
            "the upper three rows (velocity) are right, the lower three (turning) are not: about which axis does each "
            "joint turn the link?"
        )
    wrong = [str(c + 1) for c in range(3) if not np.allclose(J[:, :, c], right[:, :, c])]
    return f"column {', '.join(wrong)} is wrong: one column a joint" if 0 < len(wrong) < 3 else ""


JACOBIAN = Task(
    name="jacobian",
    notebook="03",
    signature=("T", "link", "point"),
    asks="the matrix (6, 3) of a point (base coordinates) carried by link 1, 2 or 3: velocity above, turning below, "
    "one column a joint, from the four frames T",
    right=jacobian,
    cases=_points,
    leans_on=("frames", "dh_matrix", "rot_z"),
    loan="""def jacobian(T, link, point):
    J = np.zeros((6, 3))
    for joint in range(link):
        axis = T[joint][:3, 2]
        origin = T[joint][:3, 3]
        lever = point - origin
        J[:3, joint] = np.cross(axis, lever)
        J[3:, joint] = axis
    return J""",
    slips=(
        Slip(
            lambda T, k, p: _columns(T, k, p, axis=1, origin=1),
            "each joint turns about the axis of the frame *after* it: joint 1 turns about z of the base, frame 0",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, p, axis=1),
            "each joint turns about the axis of the frame *after* it: joint 1 turns about z of the base, frame 0",
        ),
        Slip(lambda T, k, p: _columns(T, k, p, origin=1), "the axes are right, the levers start one joint too late"),
        Slip(
            lambda T, k, p: _columns(T, k, p, across=lambda a, b: np.cross(b, a)),
            "the velocities point backwards: axis x lever is not lever x axis",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, p, across=lambda a, b: a * b),
            "the velocities are products entry by entry (`*`): axis and lever need the cross product",
        ),
        Slip(
            lambda T, k, p: _columns(T, 3, p, joints=3),
            "every joint moves every link in it: a link is carried by the joints before it only",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, p, joints=k - 1),
            "the last joint before the link is missing: link 1 is carried by joint 1",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, T[k][:3, 3]),
            "it is the end of the link that moves in it, not the point: `point` is not used",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, T[3][:3, 3]),
            "it is the tip that moves in it, not the point: `point` is not used",
        ),
        Slip(
            lambda T, k, p: np.vstack([jacobian(T, k, p)[3:], jacobian(T, k, p)[:3]]),
            "turning stands above velocity: the other way round is asked for",
        ),
        Slip(
            lambda T, k, p: jacobian(T, k, p)[:3],
            "it has three rows, the velocity: the link turns, too; three rows more, below",
        ),
        Slip(lambda T, k, p: jacobian(T, k, p).T, "rows and columns have changed places: one *column* a joint"),
        Slip(
            lambda T, k, p: jacobian(T, k, p)[:, :k],
            "there are three columns always: joints that do not carry the link get zeros",
        ),
        Slip(
            lambda T, k, p: _columns([t.T for t in T], k, p),
            "it reads rows of the transforms: axes and origin stand in columns",
        ),
        Slip(
            lambda T, k, p: np.vstack([jacobian(T, k, p)[:3], np.zeros((3, 3))]),
            "the lower three rows are still zero: about which axis does each joint turn the link?",
        ),
        Slip(
            lambda T, k, p: _columns(T, k, p, across=lambda z, _: np.cross(z, p)),
            "the levers all start at the base: each starts at its own joint",
        ),
    ),
    symptom=_jacobian_symptom,
    hints=(
        "Joint 1 alone turns: how fast does a point move that is 0.5 m from the axis, and where to? Axis x lever.",
        "Joint k turns about the z axis of frame k - 1, and stands at its origin. Both are columns of T[k - 1].",
    ),
)


# ----------------------------------------------------------------------------------------------------- damped_step
def damped_step(q, p, l, damping):
    """One step of damped least squares towards p, the next q (3,)    (1.56)-(1.59 corrected)."""
    return _step(q, p, l, damping)


def _step(q, p, l, damping, *, square=True, sign=1, back=None, start=True):
    T = frames(q, l)
    tip = T[3][:3, 3]
    J = jacobian(T, 3, tip)[:3]
    lam = damping**2 if square else damping
    left = sign * (p - tip)
    dq = J.T @ np.linalg.solve(J @ J.T + lam * np.eye(3), left) if back is None else back(J, left, damping)
    return q + dq if start else dq


def _steps():
    rng = np.random.default_rng(41)
    cases = []
    for k in range(8):
        l = _LENGTHS[k % 3].copy()
        q = rng.uniform([-2, -1, -1.5], [2, 1, 1.5])
        p = forward_kinematics(q, l) + rng.uniform(-0.1, 0.1, 3)
        cases.append((q, p, l, (0.02, 0.05, 0.2)[k % 3]))
    cases.append((np.array([0.3, 0.4, 0.0]), np.array([0.3, 0.1, 0.4]), _LENGTHS[0].copy(), 0.02))  # stretched
    cases.append((np.array([0.3, 0.4, -0.5]), np.array([1.5, 0.0, 0.4]), _LENGTHS[0].copy(), 0.05))  # out of reach
    return cases


def _plain(J, left, _):
    return np.linalg.pinv(J) @ left


def _step_symptom(cases, returned, expected):
    here = [np.asarray(case[0]) for case in cases]
    if all(np.allclose(one, q) for one, q in zip(returned, here, strict=True)):
        return "it stays where it is: it returns q unchanged"
    worse = 0
    for (q, p, l, _), one in zip(cases[:8], returned, strict=False):
        before = np.linalg.norm(forward_kinematics(q, l) - p)
        worse += np.linalg.norm(forward_kinematics(np.asarray(one, dtype=float), l) - p) > before
    if worse >= 6:
        return f"{worse} of 8 steps lead away from the place, not towards it"
    return (
        "most steps come nearer, but they are not those of the damped formula: look at damping, and at what is solved"
    )


DAMPED_STEP = Task(
    name="damped_step",
    notebook="03",
    signature=("q", "p", "l", "damping"),
    asks="the next q (3,) rad after one damped step towards p (m)",
    right=damped_step,
    cases=_steps,
    leans_on=("jacobian", "forward_kinematics", "frames", "dh_matrix", "rot_z"),
    tolerance=1e-8,
    loan="""def damped_step(q, p, l, damping):
    T = frames(q, l)
    tip = T[3][:3, 3]
    J = jacobian(T, 3, tip)[:3]
    A = J @ J.T + damping**2 * np.eye(3)
    y = np.linalg.solve(A, p - tip)
    return q + J.T @ y""",
    slips=(
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, sign=-1),
            "it steps away from the place: what is missing is place less tip, not tip less place",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, start=False),
            "it returns the step alone; asked for is where the step leads, the next q",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, square=False),
            "the damping is added as it is; J times its transpose is "
            "in square metres, so damping (m) has to be squared",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, back=_plain),
            "the damping does nothing: near the stretched arm the step has no bound",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, back=lambda J, e, _: J.T @ e),
            "it follows the transpose alone, without solving: the right side, but far too short or too long",
        ),
        Slip(
            lambda q, p, l, d: _step(
                q, p, l, d, back=lambda J, e, _: d * np.linalg.solve(J @ J.T + d**2 * np.eye(3), e)
            ),
            "the step is shortened by the damping as well: it belongs inside the matrix only",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, back=lambda J, e, d: np.linalg.solve(J @ J.T + d**2 * np.eye(3), e)),
            "after solving, what you have is a push at the tip, in metres' kind; the joints feel it through the "
            "transpose, which is missing",
        ),
        Slip(
            lambda q, p, l, d: _step(
                q, p, l, d, back=lambda J, e, d: J @ np.linalg.solve(J @ J.T + d**2 * np.eye(3), e)
            ),
            "at the end stands J where its transpose belongs: from the tip back to the joints",
        ),
        Slip(
            lambda q, p, l, d: _step(q, p, l, d, back=lambda J, e, d: np.linalg.solve(J + d * np.eye(3), e)),
            "the damping is added to J itself: that changes where the step leads, instead of shortening it",
        ),
        Slip(
            lambda q, p, l, d: _step(
                q, p, l, d, back=lambda J, e, d: J.T @ np.linalg.solve(J @ J.T - d**2 * np.eye(3), e)
            ),
            "the damping is taken away, not added: it has to keep the matrix from vanishing",
        ),
        Slip(
            lambda q, p, l, d: _step(
                q, p, l, d, back=lambda J, e, d: J.T @ np.linalg.solve(J.T @ J + d**2 * np.eye(3), e)
            ),
            "J and its transpose are mixed up in one place: J J' goes with J' in front, J' J with J' behind",
        ),
        Slip(lambda q, p, l, d: np.degrees(_step(q, p, l, d)), "it returns degrees: everything here is rad"),
    ),
    symptom=_step_symptom,
    hints=(
        "Of your jacobian only the three rows of velocity count here: a place has three numbers.",
        "Solve (J J' + damping^2 1) y = what is missing, with np.linalg.solve. Then back to the joints with J'.",
    ),
)

TASKS = (JACOBIAN, DAMPED_STEP)
