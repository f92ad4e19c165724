"""A model of the student's own functions: tables from a recording, a row of theta for each joint."""

import numpy as np

from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.identification import process

#: The columns that are fitted for each joint; what says the same as another is left out.
ACTS = [0, 1, 4, 5, 10, 11, 16], [1, 2, 3, 4, 5, 8, 9, 12, 13, 17], [3, 4, 5, 9, 14, 15, 18, 19]


def columns(recording, **steps):
    """Return tables (n, 3, 20) by the student's `regressor`, pushes (n, 3) counts, and which samples are used (n, 3).

    steps: options of `process` besides a delay of 20 ms and leaving out slow samples, under 0.05 rad/s.
    """
    motion = process(recording, **{"delay": 0.02, "slow": 0.05} | steps)
    rows = zip(motion.q, motion.qd, motion.qdd, np.sign(motion.qd), strict=True)
    return np.array([my_robot.regressor(*row) for row in rows]), motion.u, motion.use


def fit_rows(Y, u, use, acts=ACTS):
    """Fit theta (3, 20), one row per joint, by the student's `least_squares`.

    Returns: theta and its errors (nan: not fitted).
    """
    theta, errors = np.zeros((3, 20)), np.full((3, 20), np.nan)
    for joint, here in enumerate(acts):
        rows = use[:, joint]
        theta[joint, here], errors[joint, here] = my_robot.least_squares(Y[rows, joint][:, here], u[rows, joint])
    return theta, errors


def mass_of(theta, q):
    """Return the mass matrix (3, 3) that a theta implies in the pose q, by the student's `regressor`."""
    still = np.zeros(3)
    rest = np.sum(my_robot.regressor(q, still, still, still) * theta, axis=1)
    pushed = [np.sum(my_robot.regressor(q, still, one, still) * theta, axis=1) - rest for one in np.eye(3)]
    return np.transpose(pushed)


def badge(*names):
    """Return whose functions moved an arm: the weakest of "yours", "on loan" and "the course's"."""
    owners = {my_robot.whose(name) for name in names}
    return next(words for words in ("the course's", "on loan", "yours") if words in owners)


def table_figure(Y):
    """Draw which columns of a table (3, 20) are filled in which row. Returns: LabFigure."""
    figure, ax = subplots(8.6, 2.2)
    ax.imshow(0.6 * np.sign(Y), cmap="RdBu", vmin=-1, vmax=1, aspect="auto")
    ax.grid(False)
    ax.set_xticks(range(20))
    ax.set_yticks(range(3), ["waist", "shoulder", "elbow"])
    ax.set(xlabel="column [counted from 0]", title="Blue: above 0; red: below 0; white: 0")
    return figure


PARTS = {  # columns of each part of a push, and the colour of its curve
    "weight": ((2, 3), "blue"),
    "brake": ((10, 12, 14), "orange"),
    "dry friction": ((11, 13, 15), "green"),
    "inertia": ((0, 1, 4, 5, 8, 9, 19), "purple"),
}


def parts_of_push(Y, theta, u, joint, span):
    """Draw what the parts of a model add to the push of a joint over a span of samples, and the push.

    Returns: LabFigure.
    """
    figure, ax = subplots(9.6, 3.6)
    here = slice(*span)
    t = 0.01 * np.arange(len(u))[here]
    ax.plot(t, u[here, joint], ".", ms=1.5, color=COLOURS["grey"], label="measured")
    for name, (chosen, colour) in PARTS.items():
        chosen = list(chosen)
        ax.plot(t, Y[here, joint][:, chosen] @ theta[joint, chosen], lw=1.2, color=COLOURS[colour], label=name)
    ax.plot(t, Y[here, joint] @ theta[joint], color=COLOURS["dark"], lw=0.9, label="all of the model")
    ax.set(xlabel="time [s]", ylabel="push [PWM counts]", title="Parts of the push; no push goes beyond 255")
    ax.legend(fontsize=8, ncols=3, loc="lower left")
    return figure


def mass_figure(models, truth=None):
    """Draw the shoulder's own inertia, and the least eigenvalue of the mass matrix, over the elbow. Returns: LabFigure.

    Args: models: {label: theta}; truth: a theta, drawn dashed.
    """
    figure, left, right = subplots(9.6, 3.6, cols=2)
    elbow = np.linspace(-2.4, 0.5, 30)
    drawn = [(theta, {"label": label}) for label, theta in models.items()]
    for theta, line in drawn + ([(truth, SETPOINT | {"label": "as drawn"})] if truth is not None else []):
        masses = [mass_of(theta, np.array([0, 0.4, angle])) for angle in elbow]
        left.plot(elbow, [M[1, 1] for M in masses], **line)
        right.plot(elbow, [np.linalg.eigvals(M).real.min() for M in masses], **line)
    for ax in (left, right):
        ax.axhline(0, color=COLOURS["grey"], lw=0.8)
        ax.set(xlabel="angle of the elbow [rad]")
    left.set(ylabel="M22 [counts s²/rad]", title="The shoulder's own inertia")
    right.set(ylabel="least eigenvalue of M [counts s²/rad]", title="No arm can be below 0")
    left.legend(fontsize=8)
    return figure
