"""Numbers of notebooks 01 and 03: a pose from the other side, a velocity of the tip."""

import numpy as np

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P, jacobian, rot_z

# pose-3: frame B stands at t in A, turned by 90 degrees about z.
_T = np.array([0.3, 0.1, 0.2])
_R = rot_z(np.pi / 2)


# ik-1: velocity of the IR50P's tip in this state.
_Q = np.deg2rad([30, 45, -60])
_QD = np.array([0.5, -0.2, 0.4])
_JV = jacobian(IR50P, _Q)[:3]


NUMBERS = (
    Number(
        "pose-3",
        "01_pose_and_forward_kinematics",
        "the coordinates in B of the origin of A, where B stands at t = (0.3, 0.1, 0.2) m in A and is "
        "turned by 90 degrees about z",
        -_R.T @ _T,
        unit="m",
        tolerance=1e-3,
        because="a millimetre is what this arm can resolve",
        why="It is the last column of the inverse: -R^T t, the way back, measured along the axes of B.",
        mistakes={
            "That is -t, still measured along the axes of A; the answer needs those of B.": -_T,
            "That is -R t; coordinates of A go to B with the transposed matrix.": -_R @ _T,
            "That points from A to B; the question is where A lies, seen from B.": _R.T @ _T,
            "The angle went in as 90 rad; the functions take radians.": -rot_z(90.0).T @ _T,
        },
    ),
    Number(
        "ik-1",
        "03_velocities_and_singular_poses",
        "the velocity of the tip of the IR50P at q = (30, 45, -60) degrees and qd = (0.5, -0.2, 0.4) rad/s",
        _JV @ _QD,
        unit="m/s",
        tolerance=1e-3,
        because="a millimetre per second is what this arm can resolve",
        why="v = Jv qd: three numbers of nine, and they change with every pose.",
        mistakes={
            "That is Jv^T qd: columns belong to joints, so Jv stands on the left as it is.": _JV.T @ _QD,
            "Rows 1 and 2 came out the same: that is the derivative of the printed (1.45).": _JV[[0, 0, 2]] @ _QD,
            "The pose went in as degrees; the functions take radians.": jacobian(IR50P, np.rad2deg(_Q) % (2 * np.pi))[
                :3
            ]
            @ _QD,
            "The rates are in rad/s already; they were converted once too often.": _JV @ np.deg2rad(_QD),
            "That is how fast the hand turns (rows 4 to 6), not how fast it moves.": jacobian(IR50P, _Q)[3:] @ _QD,
        },
        hint="Those are the joint speeds; multiply the upper three rows of jacobian(T, 3, tip) with them.",
    ),
)
