"""Exercises of notebooks 01 and A2: a pose seen from the other side, a singular orientation."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Number
from ir50p_lab.modelling import rot_z

NOTEBOOK = "01_pose_and_forward_kinematics"

# pose-2: at the singular middle angle +90 degrees of the sequence XYZ, R depends on the sum of the outer angles.
_FIRST, _THIRD = np.deg2rad([20, 35])

# pose-3: frame {B} stands at t in {A}, turned by 90 degrees about z.
_T = np.array([0.3, 0.1, 0.2])
_R = rot_z(np.pi / 2)


EXERCISES = (
    Exercise(
        "pose-2",
        "the first angle, in rad, of the XYZ angles (first, 90 degrees, 0) that give the same rotation as "
        "(20, 90, 35) degrees",
        Number(_FIRST + _THIRD, unit="rad", tolerance=1e-3, angle=True),
        why="At +90 degrees only the sum of the outer angles matters; at -90 degrees it is their difference.",
        slips={
            "That is the difference, which counts at -90 degrees; try it in the matrix.": _FIRST - _THIRD,
            "The third turn got lost: without it the rotation is another one.": _FIRST,
            "That is the third turn alone; the first one is still there.": _THIRD,
        },
        hint="Multiply the three matrices for a middle angle of 90 degrees and look at what the entries depend on.",
    ),
    Exercise(
        "pose-3",
        "the coordinates in {B} of the origin of {A}, where {B} stands at t = (0.3, 0.1, 0.2) m in {A} and is "
        "turned by 90 degrees about z",
        Number(-_R.T @ _T, unit="m", tolerance=1e-3, because="a millimetre is what this arm can resolve"),
        why="It is the last column of the inverse: -R^T t, the way back, measured along the axes of {B}.",
        slips={
            "That is -t, still measured along the axes of {A}; the answer wants those of {B}.": -_T,
            "That is -R t; coordinates of {A} go to {B} with the transposed matrix.": -_R @ _T,
            "That points from {A} to {B}; the question is where {A} lies, seen from {B}.": _R.T @ _T,
            "The angle went in as 90 rad; the functions take radians.": -rot_z(90.0).T @ _T,
        },
    ),
)
