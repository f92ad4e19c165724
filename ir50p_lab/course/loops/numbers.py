"""Number of notebook 08: the error that remains."""

import numpy as np
from scipy.optimize import fsolve

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import THESIS_A, gravity

# pid-1: what a spring of stiffness kp leaves under the weight of the thesis's arm.
_SET_POINT = np.array([np.pi / 2, np.pi / 2, -np.pi / 3])
_KP = np.array([50.0, 100.0, 50.0])  # N m/rad


def _remaining(kp):
    return fsolve(lambda e: kp * e - gravity(THESIS_A, _SET_POINT - e), np.zeros(3), xtol=1e-12)


_ERROR = _remaining(_KP)

NUMBERS = (
    Number(
        "pid-1",
        "08_pid_from_its_parts",
        "the three errors q_d - q that remain with Kp = (50, 100, 50) N m/rad on THESIS_A at the thesis's set point",
        _ERROR,
        unit="rad",
        tolerance=2e-4,
        because="the error bends the arm: solve, do not take g at q_d",
        why="Half the Kp leaves more than twice the error: the arm that sags has other weights to carry.",
        mistakes={
            "That takes the weight at the set point; the arm rests lower, where its weight is another.": (
                gravity(THESIS_A, _SET_POINT) / _KP
            ),
            "Those are the errors of the thesis's own gains.": _remaining(np.array([25.0, 200.0, 200.0])),
            "That takes the weight at q = 0; the arm rests near its set point.": gravity(THESIS_A, np.zeros(3)) / _KP,
            "Those are the angles reached; the error is set point minus angle.": _SET_POINT - _ERROR,
        },
    ),
)
