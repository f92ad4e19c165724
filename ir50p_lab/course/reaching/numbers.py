"""Numbers of notebook 18: a count of a potentiometer at the tip."""

import numpy as np

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P, jacobian

# reach-3: one count of joint 2 in a pose over a ball.
_Q, _SLOPE = np.array([0.0, 0.5, -1.4]), 122.0
_LEVER = float(np.linalg.norm(jacobian(IR50P, _Q)[:3, 1]))


NUMBERS = (
    Number(
        "reach-3",
        "18_vision_guided_reaching",
        "by how many millimetres the tip of the IR50P moves when its potentiometer 2 (122 counts per rad) changes by "
        "one count, in the pose q = (0, 0.5, -1.4) rad",
        1e3 * _LEVER / _SLOPE,
        unit="mm",
        tolerance=0.1,
        because="a tenth of a millimetre shows the right lever",
        why="Lever over slope: one count costs millimetres, so single readings are not good enough.",
        mistakes={
            "That is how far it moves per radian; one count is a small part of one.": 1e3 * _LEVER,
            "That is the angle of one count, in mrad: the lever is missing.": 1e3 / _SLOPE,
            "That is the lever of the stretched arm; here the elbow is bent.": 1e3 * (IR50P.l[1] + IR50P.l[2]) / _SLOPE,
            "That is the lever of joint 3: columns of the Jacobian count joints.": (
                1e3 * float(np.linalg.norm(jacobian(IR50P, _Q)[:3, 2])) / _SLOPE
            ),
            "That is in metres; millimetres are wanted.": _LEVER / _SLOPE,
        },
        hint="The column of joint 2 in jacobian(IR50P, q), its first three rows, and its length.",
    ),
)
