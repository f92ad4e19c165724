"""Exercises of notebook 18: from the camera's frame to the arm's, reach, counts at the tip, what tells joint 1."""

import numpy as np

from ir50p_lab.course.exercises import Choice, Exercise, Function, Number
from ir50p_lab.modelling import IR50P, frames, jacobian

NOTEBOOK = "18_vision_guided_reaching"

# reach-1: where the camera stands, and a ball in camera coordinates.
_T_BASE_CAM = np.array([[0.0, 0.6, -0.8, 0.9], [1.0, 0.0, 0.0, 0.1], [0.0, -0.8, -0.6, 0.7], [0.0, 0.0, 0.0, 1.0]])
_P_CAM = np.array([0.05, 0.10, 0.80])
_P_BASE = _T_BASE_CAM[:3, :3] @ _P_CAM + _T_BASE_CAM[:3, 3]

# reach-2: a goal too far out for the IR50P.
_GOAL = np.array([0.56, 0.12, 0.09])
_SHOULDER = np.array([0.0, 0.0, IR50P.l[0]])
_MISSING = float(np.linalg.norm(_GOAL - _SHOULDER) - IR50P.l[1] - IR50P.l[2])


# reach-3: one count of joint 2 in a pose over a ball.
_Q, _SLOPE = np.array([0.0, 0.5, -1.4]), 122.0
_LEVER = float(np.linalg.norm(jacobian(IR50P, _Q)[:3, 1]))


def _marker(q):
    """Marker 42 mm before the tip, base coordinates."""
    return frames(IR50P, q)[3][:3] @ np.array([-0.042, 0.0, 0.0, 1.0])


def _tip(q):
    return frames(IR50P, q)[3][:3, 3]


def _beyond(q):
    return frames(IR50P, q)[3][:3] @ np.array([0.042, 0.0, 0.0, 1.0])


def _base_axes(q):
    """Shifted along the base's x instead of the hand's."""
    return _tip(q) - np.array([0.042, 0.0, 0.0])


def _elbow(q):
    return frames(IR50P, q)[2][:3] @ np.array([-0.042, 0.0, 0.0, 1.0])


EXERCISES = (
    Exercise(
        "reach-1",
        "the ball's position in base coordinates: T_base_cam has the rows (0, 0.6, -0.8, 0.9), (1, 0, 0, 0.1), "
        "(0, -0.8, -0.6, 0.7), (0, 0, 0, 1), and the camera sees it at (0.05, 0.10, 0.80) m",
        Number(_P_BASE, unit="m", tolerance=1e-3, because="a millimetre is less than the arm can do"),
        why="T_base_cam takes camera coordinates to base coordinates: read it from right to left.",
        slips={
            "Turned, not shifted: the camera does not stand in the base.": _T_BASE_CAM[:3, :3] @ _P_CAM,
            "Shifted, not turned: the camera's axes do not point as the base's do.": _P_CAM + _T_BASE_CAM[:3, 3],
            "That is the inverse, T_cam_base: it takes base coordinates to the camera.": (
                _T_BASE_CAM[:3, :3].T @ (_P_CAM - _T_BASE_CAM[:3, 3])
            ),
            "The rotation is transposed: the row form of the thesis beside a matrix in column form.": (
                _T_BASE_CAM[:3, :3].T @ _P_CAM + _T_BASE_CAM[:3, 3]
            ),
        },
    ),
    Exercise(
        "reach-2",
        "by how many metres the IR50P misses the goal (0.56, 0.12, 0.09) m",
        Number(_MISSING, unit="m", tolerance=5e-4, because="half a millimetre shows the right triangle"),
        why="From the shoulder, at height l1, the arm reaches l2 + l3: the rest is missing.",
        slips={
            "Measured along the table: but the shoulder stands 285 mm above it.": (
                float(np.hypot(*_GOAL[:2]) - IR50P.l[1] - IR50P.l[2])
            ),
            "Measured from the foot of the column; the arm begins at the shoulder.": (
                float(np.linalg.norm(_GOAL) - IR50P.l[1] - IR50P.l[2])
            ),
            "That is the whole way from the shoulder to the goal.": float(np.linalg.norm(_GOAL - _SHOULDER)),
            "reach_pose refuses this goal, so something is missing.": 0.0,
        },
        hint="Nothing but lengths: the distance from the shoulder to the goal, and what the two links make together.",
    ),
    Exercise(
        "reach-3",
        "by how many millimetres the tip of the IR50P moves when its potentiometer 2 (122 counts per rad) changes by "
        "one count, in the pose q = (0, 0.5, -1.4) rad",
        Number(
            1e3 * _LEVER / _SLOPE, unit="mm", tolerance=0.1, because="a tenth of a millimetre shows the right lever"
        ),
        why="Lever over slope: one count costs millimetres, so single readings are not good enough.",
        slips={
            "That is how far it moves per radian; one count is a small part of one.": 1e3 * _LEVER,
            "That is the angle of one count, in mrad: the lever is missing.": 1e3 / _SLOPE,
            "That is the lever of the stretched arm; here the elbow is bent.": 1e3 * (IR50P.l[1] + IR50P.l[2]) / _SLOPE,
            "That is the lever of joint 3: columns of the Jacobian count joints.": (
                1e3 * float(np.linalg.norm(jacobian(IR50P, _Q)[:3, 2])) / _SLOPE
            ),
            "That is in metres; asked for are millimetres.": _LEVER / _SLOPE,
        },
        hint="The column of joint 2 in jacobian(IR50P, q), its first three rows, and its length.",
    ),
    Exercise(
        "reach-4",
        "a function that returns where a marker is (base coordinates, m) that sits 42 mm before the tip of the IR50P, "
        "on the axis of the forearm, for joint angles q",
        Function(
            _marker,
            cases=[[0.0, 0.0, 0.0], [0.4, 0.5, -1.2], [-0.7, 0.9, -1.6], [1.0, 0.2, -0.5]],
            unit="m",
            tolerance=5e-4,
        ),
        why="A point of the hand is constant in the hand's frame: T_base_tool does the rest.",
        slips={
            "That is the tip itself.": _tip,
            "That lies 42 mm beyond the tip: before it means towards the elbow, x is negative.": _beyond,
            "The 42 mm were taken along the base's x axis; they turn with the forearm.": _base_axes,
            "That is counted from the elbow: frame 2 instead of frame 3.": _elbow,
        },
        hint="frames(IR50P, q)[3] is T_base_tool; its x axis points along the forearm.",
    ),
    Exercise(
        "reach-5",
        "the one measurement that tells a constant error of joint 1, which the board in the hand does not",
        Choice(
            "table",
            {
                "poses": "another hundred poses of the board in the hand",
                "pixels": "the same pictures with four times the pixels",
                "second": "a second camera, its place found with the board in the hand, too",
                "table": "one picture of the board on the table, its place measured with a ruler from the column",
            },
        ),
        why="Turn arm and camera about the column together: every picture of the hand stays the same. A thing that "
        "stays where it is on the table, at a place known in the base frame, does not turn along.",
        slips={
            "Turn the arm in all of them by the same angle, and the camera with it: nothing is seen of it.": "poses",
            "Finer pictures of something that does not change: the camera turns along with joint 1.": "pixels",
            "It turns about the column along with the first: its place comes from the same joint 1.": "second",
        },
    ),
)
