"""Exercises of notebook 18: a count at the tip, the marker on the hand."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.modelling import IR50P, frames, jacobian

NOTEBOOK = "18_vision_guided_reaching"

# reach-3: one count of joint 2 in a pose over a ball.
_Q, _SLOPE = np.array([0.0, 0.5, -1.4]), 122.0
_LEVER = float(np.linalg.norm(jacobian(IR50P, _Q)[:3, 1]))


# reach-4: the marker on the hand.
def _on_the_axis(q, x, frame=3):
    """A point at x m on the x axis of a frame, base coordinates."""
    return frames(IR50P, q)[frame][:3] @ np.array([x, 0.0, 0.0, 1.0])


def _marker(q):
    return _on_the_axis(q, -0.042)


EXERCISES = (
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
            "That is the tip itself.": lambda q: _on_the_axis(q, 0.0),
            "That lies 42 mm beyond the tip: before it means towards the elbow, x is negative.": (
                lambda q: _on_the_axis(q, 0.042)
            ),
            "The 42 mm were taken along the base's x axis; they turn with the forearm.": (
                lambda q: _on_the_axis(q, 0.0) - np.array([0.042, 0.0, 0.0])
            ),
            "That is counted from the elbow: frame 2 instead of frame 3.": lambda q: _on_the_axis(q, -0.042, frame=2),
        },
        hint="frames(IR50P, q)[3] is T_base_tool; its x axis points along the forearm.",
    ),
)
