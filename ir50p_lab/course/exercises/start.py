"""Exercises of notebook 00: what the course takes for granted."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number, Slip

NOTEBOOK = "00_start_here"

# start-2: a rotation by +30 degrees about z, and a point in the rotated frame (m).
_ANGLE = np.deg2rad(30)
_R = np.array([
    [np.cos(_ANGLE), -np.sin(_ANGLE), 0],
    [np.sin(_ANGLE),  np.cos(_ANGLE), 0],
    [0,               0,              1],
])  # fmt: skip
_V = np.array([0.4, 0.1, 0.2])

# start-3: the height of the end of a rod, and its rate by the chain rule.
_ROD = 0.5  # m


def _rate(q, qd):
    return _ROD * np.cos(q) * qd


# start-4: a 2 x 2 system A x = b.
_A = np.array([[2.0, 1.0], [1.0, 3.0]])
_B = np.array([3.0, 7.0])

# start-5: step response y(t) = K (1 - exp(-t / T)).
_T = 0.4  # s
_K = 2.0  # rad/s


def step_response(t):
    """Return the speed (rad/s) that exercise start-5 shows over the time t (s), number or array."""
    return _K * (1 - np.exp(-np.asarray(t) / _T))


EXERCISES = (
    Exercise(
        "start-1",
        "the joint angles (90, -45, 30) degrees in radians",
        Number(
            np.deg2rad([90, -45, 30]),
            unit="rad",
            tolerance=1e-3,
            because="three decimals are what you would type",
        ),
        why="Inside the package every angle is in radians; degrees appear only on sliders, named `_deg`.",
        slips=(
            Slip([90, -45, 30], "These are still degrees: half a turn is 180 degrees, or pi radians."),
            Slip(np.array([90, -45, 30]) / 360, "These are turns: a full turn is 2 pi radians, not 1."),
            Slip(np.deg2rad([90, 45, 30]), "The sign of the second angle got lost: it turns the other way."),
        ),
    ),
    Exercise(
        "start-2",
        "p = R v, the point v = (0.4, 0.1, 0.2) m turned by 30 degrees about z",
        Number(_R @ _V, unit="m", tolerance=1e-3, because="a millimetre is what this arm can resolve"),
        why="Every pose of the arm is a chain of such products; `@` is the product of matrices.",
        slips=(
            Slip(_R.T @ _V, "That is v times R, which turns the other way: the matrix stands on the left."),
            Slip(_R * _V, "That is `R * v`, which multiplies entry by entry; the matrix product is `R @ v`."),
            Slip((_R * _V).diagonal(), "Only the diagonal of R was used: each row of R meets all of v."),
        ),
    ),
    Exercise(
        "start-3",
        "the rate dz/dt of z = 0.5 sin(q), as a function of (q, qd)",
        Function(
            _rate,
            cases=[(0.0, 1.0), (0.7, -2.0), (-1.2, 0.5), (2.5, 3.0)],
            unit="m/s",
            tolerance=1e-3,
            because="a tip speed of 1 mm/s is lost in the noise of this arm",
        ),
        why="Notebook 02 does the same for all joints at once and calls the table of derivatives the Jacobian.",
        slips=(
            Slip(lambda q, qd: _ROD * np.cos(q), "That is dz/dq; the chain rule adds the rate of q itself."),
            Slip(lambda q, qd: _ROD * np.sin(q) * qd, "The sine has to be differentiated, not kept."),
            Slip(lambda q, qd: -_ROD * np.cos(q) * qd, "Check the sign: at q = 0 raising q raises the end."),
            Slip(lambda q, qd: _rate(np.deg2rad(q), qd), "The angle comes in radians, as np.cos wants it."),
        ),
    ),
    Exercise(
        "start-4",
        "x with A x = b, for A = [[2, 1], [1, 3]] and b = (3, 7)",
        Number(np.linalg.solve(_A, _B), tolerance=1e-3, because="three decimals are what you would type"),
        why="`np.linalg.solve` is shorter and more accurate than an inverse; this course never inverts a matrix.",
        slips=(
            Slip(_A @ _B, "That is A b: the unknown stands beside A, and b is given."),
            Slip(_B / _A.diagonal(), "That divides by the diagonal only: both unknowns stand in both equations."),
            Slip(np.linalg.solve(_A, _B)[::-1], "Both numbers are there, in the wrong order."),
        ),
    ),
    Exercise(
        "start-5",
        "the time constant T of the step response drawn above",
        Number(_T, unit="s", tolerance=0.05, because="a reading from a plot is good to half a grid line"),
        why="T says how fast a system answers; each motor and each filter of the arm has one.",
        slips=(
            Slip(_K, "That is the final value; the time constant is a time, read on the other axis."),
            Slip(3 * _T, "That is when 95 % are reached, three time constants: look where 63 % are."),
            Slip(_T * np.log(2), "That is the time to half of the final value: look where 63 % are."),
        ),
    ),
)
