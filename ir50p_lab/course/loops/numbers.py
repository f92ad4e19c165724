"""Numbers of notebooks 08 and A2: the error that remains, the longest period of a sampled damper."""

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

# pid-3: a damper that acts with a held command: v[k + 1] = (1 - kd T/M) v[k].
_M3, _KD3 = 0.25, 40.0  # kg m^2, N m s/rad

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
    Number(
        "pid-3",
        "A2_further_on",
        "the longest stable period of M qdd = -Kd qd, held, for M = 0.25 kg m^2 and Kd = 40 N m s/rad",
        2 * _M3 / _KD3,
        unit="s",
        tolerance=2e-5,
        because="a tenth of a millisecond more would grow already",
        why="A stiffer damper needs a faster computer: the product Kd T has a limit, set by the inertia.",
        mistakes={
            "At that period the speed is brought to zero in one sample: the best, not the longest.": _M3 / _KD3,
            "Upside down: that is a frequency, in 1/s.": 2 * _KD3 / _M3,
            "That is in milliseconds; the question asks for seconds.": 2000 * _M3 / _KD3,
            "No circle is involved: look for the period at which the factor of one sample reaches -1.": (
                np.pi * _M3 / _KD3
            ),
        },
    ),
)
