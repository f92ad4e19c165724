"""Numbers of notebook 12: a step of recursive least squares, what a clamped joint hides."""

from ir50p_lab.course.checking.number import Number

# ident-1: one parameter, one sample.
_THETA, _P, _PHI, _Y = 2.0, 0.5, 3.0, 9.0
_GAIN = _P * _PHI / (1 + _PHI * _P * _PHI)
_STEP = _THETA + _GAIN * (_Y - _PHI * _THETA)


NUMBERS = (
    Number(
        "ident-1",
        "12_identification",
        "the estimate after one step of recursive least squares from theta = 2, P = 0.5, with phi = 3 and y = 9",
        _STEP,
        tolerance=2e-3,
        why="One sample explains most of itself: the new estimate predicts 8.45 where 9 was measured.",
        mistakes={
            "That has the inverse of P inside the bracket, as (2.44) is printed.": (
                _THETA + _P * _PHI / (1 + _PHI / _P * _PHI) * (_Y - _PHI * _THETA)
            ),
            "That is the first line of (2.40) as printed: the measurement enters with a plus.": (
                _THETA - _GAIN * _PHI * _THETA - _GAIN * _Y
            ),
            "That steps with the old P; the gain divides by 1 + phi P phi.": _THETA + _P * _PHI * (_Y - _PHI * _THETA),
            "The step is by the prediction error y - phi theta, not by y.": _THETA + _GAIN * _Y,
        },
    ),
    Number(
        "ident-2",
        "12_identification",
        "how many of the 18 parameters of the rigid arm, or groups of them, all three joints together tell while "
        "joint 1 is clamped",
        13,
        tolerance=0.4,
        because="it is a whole number",
        why="Three have no effect, and two pairs act as one each: theta2 with theta9, theta5 with theta10.",
        mistakes={
            "That is with joint 1 free; clamped, its velocity and acceleration are zero.": 18,
            "Three columns vanish, right; but of those left some have become the same: compare them.": 15,
            "The offset Tf1 needs no motion: joint 1 still shows what it pushes with.": 14,
            "theta7 and theta8 belong to no rigid body; the question is about the other 18.": 20,
        },
        hint="Put 0 for speed, acceleration and direction of joint 1 into your regressor, for many random states.",
    ),
)
