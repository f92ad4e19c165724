"""The exercise of notebook 03: tip velocity."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Number
from ir50p_lab.modelling import IR50P, jacobian

NOTEBOOK = "03_velocities_and_singular_poses"

# ik-1: velocity of the IR50P's tip in this state.
_Q = np.deg2rad([30, 45, -60])
_QD = np.array([0.5, -0.2, 0.4])
_JV = jacobian(IR50P, _Q)[:3]


def _printed_jv(q):
    """Derivative of the printed (1.45), whose second row repeats the first."""
    Jv = jacobian(IR50P, q)[:3].copy()
    Jv[1] = Jv[0]
    return Jv


EXERCISES = (
    Exercise(
        "ik-1",
        "the velocity of the tip of the IR50P at q = (30, 45, -60) degrees and qd = (0.5, -0.2, 0.4) rad/s",
        Number(_JV @ _QD, unit="m/s", tolerance=1e-3, because="a millimetre per second is what this arm can resolve"),
        why="v = Jv qd: three numbers of nine, and they change with every pose.",
        slips={
            "That is Jv^T qd: columns belong to joints, so Jv stands on the left as it is.": _JV.T @ _QD,
            "Rows 1 and 2 came out the same: that is the derivative of the printed (1.45).": _printed_jv(_Q) @ _QD,
            "The pose went in as degrees; the functions take radians.": jacobian(IR50P, np.rad2deg(_Q))[:3] @ _QD,
            "The rates are in rad/s already; they were converted once too often.": _JV @ np.deg2rad(_QD),
            "That is how fast the hand turns (rows 4 to 6), not how fast it moves.": jacobian(IR50P, _Q)[3:] @ _QD,
        },
        hint="Those are the joint speeds; multiply the upper three rows of jacobian(T, 3, tip) with them.",
    ),
)
