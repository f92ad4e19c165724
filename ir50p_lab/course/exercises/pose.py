"""Exercises of notebook 01: rotations, transforms, forward kinematics."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number, Slip
from ir50p_lab.modelling import IR50P, forward_kinematics, rot_x, rot_y, rot_z, transform

NOTEBOOK = "01_pose_and_forward_kinematics"

_MILLIMETRE = {"unit": "m", "tolerance": 1e-3, "because": "a millimetre is what this arm can resolve"}

# pose-1: frame {B} is turned by +30 degrees about y; a point 0.2 m up its z axis.
_TURN = np.deg2rad(30)
_P_B = np.array([0.0, 0.0, 0.2])

# pose-2: at the singular middle angle +90 degrees of the sequence XYZ, R depends on the sum of the outer angles.
_FIRST, _THIRD = np.deg2rad([20, 35])

# pose-3: frame {B} stands at t in {A}, turned by 90 degrees about z.
_T = np.array([0.3, 0.1, 0.2])
_R = rot_z(np.pi / 2)

# pose-4: the tip of the IR50P seen from frame 1, in this pose.
_Q = np.deg2rad([30, 45, -60])


def _position(arm, q, i, j):
    return transform(arm, q, i, j)[:3, 3]


# pose-5: forward kinematics of the IR50P, and the ways to get it wrong.
_L1, _L2, _L3 = IR50P.l


def _tip(q):
    return forward_kinematics(IR50P, q)


def _cosine_in_both_rows(q):
    p = _tip(q)
    return np.array([p[0], p[0], p[2]])


def _elbow_from_the_horizon(q):
    radius = _L2 * np.cos(q[1]) + _L3 * np.cos(q[2])
    height = _L1 + _L2 * np.sin(q[1]) + _L3 * np.sin(q[2])
    return np.array([radius * np.cos(q[0]), radius * np.sin(q[0]), height])


def _down_is_positive(q):
    return _tip(np.array([q[0], -q[1], -q[2]]))


EXERCISES = (
    Exercise(
        "pose-1",
        "the coordinates in {A} of the point (0, 0, 0.2) m of a frame {B} that is turned by +30 degrees about y",
        Number(rot_y(_TURN) @ _P_B, **_MILLIMETRE),
        why="The third column of R_y, times 0.2 m: a positive turn about y tips z towards x.",
        slips=(
            Slip(
                rot_y(-_TURN) @ _P_B,
                "That turns the other way: the printed (1.5), or a transposed matrix. z must tip towards +x.",
            ),
            Slip(rot_x(_TURN) @ _P_B, "That is a turn about x; a turn about y leaves the y coordinate alone."),
            Slip(rot_y(30.0) @ _P_B, "The angle went in as 30 rad; the functions take radians: np.radians(30)."),
            Slip(
                np.array([_P_B[2] * np.cos(_TURN), 0, _P_B[2] * np.sin(_TURN)]),
                "Sine and cosine are swapped: a small turn must leave z almost as it is.",
            ),
        ),
    ),
    Exercise(
        "pose-2",
        "the first angle, in rad, of the XYZ angles (first, 90 degrees, 0) that give the same rotation as "
        "(20, 90, 35) degrees",
        Number(
            _FIRST + _THIRD,
            unit="rad",
            tolerance=1e-3,
            because="three decimals are what you would type",
            angle=True,
        ),
        why="At +90 degrees only the sum of the outer angles matters; at -90 degrees it is their difference.",
        slips=(
            Slip(_FIRST - _THIRD, "That is the difference, which counts at -90 degrees; try it in the matrix."),
            Slip(_FIRST, "The third turn got lost: without it the rotation is another one."),
            Slip(_THIRD, "That is the third turn alone; the first one is still there."),
        ),
        hint="Multiply the three matrices for a middle angle of 90 degrees and look at what the entries depend on.",
    ),
    Exercise(
        "pose-3",
        "the coordinates in {B} of the origin of {A}, where {B} stands at t = (0.3, 0.1, 0.2) m in {A} and is "
        "turned by 90 degrees about z",
        Number(-_R.T @ _T, **_MILLIMETRE),
        why="It is the last column of the inverse: -R^T t, the way back, measured along the axes of {B}.",
        slips=(
            Slip(-_T, "That is -t, still measured along the axes of {A}; the answer wants those of {B}."),
            Slip(-_R @ _T, "That is -R t; coordinates of {A} go to {B} with the transposed matrix."),
            Slip(_R.T @ _T, "That points from {A} to {B}; the question is where {A} lies, seen from {B}."),
            Slip(-rot_z(90.0).T @ _T, "The angle went in as 90 rad; the functions take radians."),
        ),
    ),
    Exercise(
        "pose-4",
        "the position of the tip in frame 1 (at the shoulder) for the IR50P at q = (30, 45, -60) degrees",
        Number(_position(IR50P, _Q, 1, 3), **_MILLIMETRE),
        why="Radius, height above the shoulder, and zero: frame 1 turns with the arm, so q1 has dropped out.",
        slips=(
            Slip(_position(IR50P, _Q, 0, 3), "That is t^0_3, in the base frame; wanted is t^1_3."),
            Slip(_position(IR50P, _Q, 3, 1), "That is t^3_1: the shoulder seen from the tip. Swap i and j."),
            Slip(
                _position(IR50P, _Q, 1, 2),
                "That is the elbow, t^1_2: the product stopped one matrix early, as the printed (1.11) does.",
            ),
            Slip(_position(IR50P, np.rad2deg(_Q), 1, 3), "The angles went in as degrees; the functions take radians."),
        ),
    ),
    Exercise(
        "pose-5",
        "the position of the tip of the IR50P as a function of q (three angles in rad)",
        Function(
            _tip,
            cases=[np.array(q) for q in ((0.3, 0.5, -0.7), (-1.1, 1.2, 0.4), (2.0, -0.4, -1.6), (0.0, 0.9, 0.5))],
            angles_in=True,
            **_MILLIMETRE,
        ),
        why="That is (1.31) put right; notebook 02 turns it round.",
        slips=(
            Slip(_cosine_in_both_rows, "y equals x: that is row 2 as the thesis prints it. y carries s1, not c1."),
            Slip(
                _elbow_from_the_horizon,
                "q3 is measured from the upper arm, not from the horizon: the forearm stands at q2 + q3.",
            ),
            Slip(
                lambda q: _tip(q) - [0, 0, _L1], "The column is missing: z starts at the shoulder, l1 above the base."
            ),
            Slip(_down_is_positive, "Positive q2 and q3 lift the arm; here they lower it."),
        ),
    ),
)
