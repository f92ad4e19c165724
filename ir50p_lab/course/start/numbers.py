"""Numbers of notebook 00: radians, a time constant."""

import numpy as np

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P, mass_matrix

# start-5: the waist of the IR50P pushed from rest, shoulder and elbow folded.
_T = float(mass_matrix(IR50P, [0, 1.9, -2.44])[0, 0] / (IR50P.actuators.back_emf_damping[0] + IR50P.friction.fv[0]))


NUMBERS = (
    Number(
        "start-1",
        "00_start_here",
        "the joint angles (90, -45, 30) degrees in radians",
        np.deg2rad([90, -45, 30]),
        unit="rad",
        tolerance=1e-3,
        why="Inside the package every angle is in radians; degrees appear only on sliders, named `_deg`.",
        mistakes={
            "These are still degrees: half a turn is 180 degrees, or pi radians.": [90, -45, 30],
            "These are turns: a full turn is 2 pi radians, not 1.": np.array([90, -45, 30]) / 360,
            "The sign of the second angle got lost: it turns the other way.": np.deg2rad([90, 45, 30]),
        },
    ),
    Number(
        "start-5",
        "00_start_here",
        "the time constant T of the speed drawn above",
        _T,
        unit="s",
        tolerance=0.02,
        because="a reading from the plot is good to a tick",
        why="T says how fast a system answers; each motor and each filter of the arm has one.",
        mistakes={
            "That is the top speed; the time constant is a time, read on the other axis.": 1.74,
            "That is the speed at the dashed line; at what time is it reached?": 1.74 * (1 - np.exp(-1)),
            "That is the share of the top speed; at what time is it reached?": 1 - np.exp(-1),
            "That is when 95 % are reached, three time constants: look where 63 % are.": 3 * _T,
            "That is the time to half of the top speed: look where 63 % are.": _T * np.log(2),
        },
    ),
)
