"""Exercises of notebook 02: Jacobian, singular poses, inverse kinematics."""

import numpy as np

from ir50p_lab.course.exercises import Choice, Exercise, Function, Number, Slip
from ir50p_lab.modelling import IR50P, inverse_kinematics, jacobian, reachability

NOTEBOOK = "02_jacobian_and_inverse_kinematics"

_L1, _L2, _L3 = IR50P.l

# ik-1: velocity of the IR50P's tip in this state.
_Q = np.deg2rad([30, 45, -60])
_QD = np.array([0.5, -0.2, 0.4])
_JV = jacobian(IR50P, _Q)[:3]


def _printed_jv(q):
    """Derivative of the printed (1.45), whose second row repeats the first."""
    Jv = jacobian(IR50P, q)[:3].copy()
    Jv[1] = Jv[0]
    return Jv


# ik-2: the tip passes the axis of the column.
_DISTANCE, _SPEED = 0.04, 0.2

# ik-3: a point in the hole around the shoulder.
_P_HOLE = np.array([0.05, 0.03, 0.25])
_R_HOLE = np.linalg.norm(_P_HOLE - [0, 0, _L1])

# ik-5: a target of which the joint limits leave one pose.
_P_LIMITS = np.array([0.40, 0.15, 0.35])
_BRANCH_SLIPS = {
    "front/down": "q3 is beyond its upper limit there: the elbow of this arm bends the other way.",
    "back/up": "Joint 1 would have to face away from the target, far beyond its travel to either side.",
    "back/down": "Joint 1 would face away and the elbow would bend backwards: both are beyond their limits.",
}


def _elbow(r):
    """Angle q3 <= 0 for a tip at distance r from the shoulder."""
    return float(inverse_kinematics(IR50P, [r, 0.0, _L1])["front/up"][2])


def _inner_angle(r):
    return np.pi + _elbow(r)


EXERCISES = (
    Exercise(
        "ik-1",
        "the velocity of the tip of the IR50P at q = (30, 45, -60) degrees and qd = (0.5, -0.2, 0.4) rad/s",
        Number(_JV @ _QD, unit="m/s", tolerance=1e-3, because="a millimetre per second is what this arm can resolve"),
        why="v = Jv qd: three numbers of nine, and they change with every pose.",
        slips=(
            Slip(_JV.T @ _QD, "That is Jv^T qd: columns belong to joints, so Jv stands on the left as it is."),
            Slip(
                _printed_jv(_Q) @ _QD,
                "Rows 1 and 2 came out the same: that is the derivative of the printed (1.45).",
            ),
            Slip(jacobian(IR50P, np.rad2deg(_Q))[:3] @ _QD, "The pose went in as degrees; the functions take radians."),
            Slip(_JV @ np.deg2rad(_QD), "The rates are in rad/s already; they were converted once too often."),
            Slip(
                jacobian(IR50P, _Q)[3:] @ _QD, "That is how fast the hand turns (rows 4 to 6), not how fast it moves."
            ),
        ),
        hint="jacobian(IR50P, q) has six rows; the first three make velocities out of joint rates.",
    ),
    Exercise(
        "ik-2",
        "the largest rate of joint 1 while the tip passes the column's axis on a straight horizontal line, "
        "0.04 m beside it, at 0.2 m/s",
        Number(_SPEED / _DISTANCE, unit="rad/s", tolerance=0.01, because="a hundredth shows that the idea is right"),
        why="v / d: half the distance, twice the rate. On the axis itself no rate is enough.",
        slips=(
            Slip(_SPEED * _DISTANCE, "That is v d, which is small near the axis: but there joint 1 must hurry."),
            Slip(np.rad2deg(_SPEED / _DISTANCE), "That is in degrees per second; asked for is rad/s."),
            Slip(
                _SPEED / (_L2 + _L3),
                "That is the rate with the arm stretched, where a little turning moves the tip far.",
            ),
            Slip(_DISTANCE / _SPEED, "That is d / v: a time, in seconds."),
        ),
        hint="Where the line is nearest to the axis the tip moves sideways, on a circle of radius 0.04 m.",
    ),
    Exercise(
        "ik-3",
        "the distance of the point (0.05, 0.03, 0.25) m to the workspace of the IR50P, joint limits aside",
        Number(
            reachability(IR50P, _P_HOLE), unit="m", tolerance=1e-3, because="a millimetre is what this arm can resolve"
        ),
        why="The forearm is longer than the upper arm: around the shoulder is a hole no pose can enter.",
        slips=(
            Slip(0.0, "Near is not the same as reachable: how close to the shoulder can the folded arm get?"),
            Slip(_R_HOLE, "That is the distance from the shoulder; wanted is how much is missing to the inner edge."),
            Slip(
                (_L2 + _L3) - _R_HOLE, "That is the way to the outer edge, through the hole; the inner edge is nearer."
            ),
            Slip(
                (_L3 - _L2) - np.linalg.norm(_P_HOLE),
                "That counts from the foot of the column; the shell lies about the shoulder, l1 above it.",
            ),
        ),
    ),
    Exercise(
        "ik-4",
        "a function that returns q3 of the elbow-up pose of the IR50P for a tip at distance r (m) from the shoulder",
        Function(
            _elbow,
            cases=[0.2, 0.3, 0.4, 0.5, 0.55],
            unit="rad",
            tolerance=1e-4,
            because="four decimals show that the formula is right",
        ),
        why="The distance alone decides the elbow; turning joints 1 and 2 then points the arm.",
        slips=(
            Slip(lambda r: -_elbow(r), "That is elbow down: the acos of (1.69) knows only angles >= 0."),
            Slip(
                _inner_angle,
                "That is the angle alpha inside the triangle (1.65); q3 is measured from the stretched arm.",
            ),
            Slip(
                lambda r: -_inner_angle(r),
                "That is -alpha, the angle inside the triangle; from it to q3 pi is missing.",
            ),
            Slip(
                lambda r: -2 * np.arccos(np.clip(r / (_L2 + _L3), -1, 1)),
                "That holds for links of equal length; here the law of cosines is needed.",
            ),
        ),
    ),
    Exercise(
        "ik-5",
        "the only branch on which the IR50P may reach (0.40, 0.15, 0.35) m within its joint limits",
        Choice(
            "front/up",
            {
                "front/up": "joint 1 faces the target, q3 <= 0",
                "front/down": "joint 1 faces the target, q3 >= 0",
                "back/up": "joint 1 faces away, q3 <= 0",
                "back/down": "joint 1 faces away, q3 >= 0",
            },
        ),
        why="Reach first, then branches, then limits: in this order a 'no' always has a reason.",
        slips=tuple(Slip(branch, message) for branch, message in _BRANCH_SLIPS.items()),
    ),
)
