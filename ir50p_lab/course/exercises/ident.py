"""Exercises of notebook 12: a step of recursive least squares, what a clamped joint hides, a fit, the scale."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Number
from ir50p_lab.identification import base_parameters, regressor
from ir50p_lab.identification.parameters import NAMES, ONLY_THESIS
from ir50p_lab.modelling import IR50P

NOTEBOOK = "12_identification"

# ident-1: one parameter, one sample.
_THETA, _P, _PHI, _Y = 2.0, 0.5, 3.0, 9.0
_GAIN = _P * _PHI / (1 + _PHI * _P * _PHI)
_STEP = _THETA + _GAIN * (_Y - _PHI * _THETA)


# ident-2: joint 1 is clamped; what the three joints together still tell of the 18 parameters of a rigid arm.
def _rank_with_joint_1_clamped():
    q, qd, qdd = np.random.default_rng(0).uniform(-2, 2, (3, 400, 3))
    qd[:, 0] = qdd[:, 0] = 0.0
    kept = [k for k, name in enumerate(NAMES) if name not in ONLY_THESIS]
    return base_parameters(regressor(q, qd, qdd)[:, :, kept], names=[NAMES[k] for k in kept]).rank


# ident-3: Table 4.4, joint 1.
_RMS, _FIT = 47.0, 63.0  # PWM counts, %
_SPREAD = _RMS / (1 - _FIT / 100)

# ident-4: theta4 = m3 lc3 of joint 3 in counts, without and with a payload in the gripper.
_MASS, _L3 = 0.3, IR50P.l[2]  # kg, m
_BEFORE, _AFTER = 5.8, 10.5  # PWM s^2/m times kg m over N m: theta4/K, kg m per N m of one count
_K = _MASS * _L3 / (_AFTER - _BEFORE)

EXERCISES = (
    Exercise(
        "ident-1",
        "the estimate after one step of recursive least squares from theta = 2, P = 0.5, with phi = 3 and y = 9",
        Number(_STEP, tolerance=2e-3),
        why="One sample explains most of itself: the new estimate predicts 8.45 where 9 was measured.",
        slips={
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
    Exercise(
        "ident-2",
        "how many of the 18 parameters of the rigid arm, or groups of them, all three joints together tell while "
        "joint 1 is clamped",
        Number(_rank_with_joint_1_clamped(), tolerance=0.4, because="it is a whole number"),
        why="Three have no effect, and two pairs act as one each: theta2 with theta9, theta5 with theta10.",
        slips={
            "That is with joint 1 free; clamped, its velocity and acceleration are zero.": 18,
            "Three columns vanish, right; but of those left some have become the same: compare them.": 15,
            "The offset Tf1 needs no motion: joint 1 still shows what it pushes with.": 14,
            "theta7 and theta8 belong to no rigid body; the question is about the other 18.": 20,
        },
        hint="Put a zero for the velocity and the acceleration of joint 1 into each column; base_parameters counts.",
    ),
    Exercise(
        "ident-3",
        "the standard deviation of the PWM counts of joint 1 in the thesis' validation, from its RMS error of 47 "
        "counts and its fit of 63 %",
        Number(_SPREAD, unit="PWM", tolerance=0.6),
        why="All three columns of Table 4.4 give about 125: its fit is this one, and no share of a variance.",
        slips={
            "That divides by the fit; the error is what the fit leaves.": _RMS / (_FIT / 100),
            "That takes the fit for a share of the variance (R squared).": _RMS / np.sqrt(1 - _FIT / 100),
            "Upside down: the error is the smaller of the two.": _RMS * (1 - _FIT / 100),
            "That is smaller than the error; the fit compares the error with the spread.": _RMS * _FIT / 100,
        },
    ),
    Exercise(
        "ident-4",
        "the torque of one PWM count at joint 3, if theta4 of that joint grows from 5.8 to 10.5 (per N m of a count) "
        "when 0.3 kg are put into the gripper, 0.372 m from the joint",
        Number(_K, unit="N m", tolerance=2e-4),
        why="Now every parameter of joint 3 can be had in kg and m: multiply by this.",
        slips={
            "Upside down: that is in counts per N m.": 1 / _K,
            "Gravity stands in the regressor already: theta4 is m3 lc3.": _MASS * _L3 * 9.81 / (_AFTER - _BEFORE),
            "That takes the loaded arm alone; only the difference is the payload's.": _MASS * _L3 / _AFTER,
            "That lacks the lever: theta4 is mass times distance.": _MASS / (_AFTER - _BEFORE),
            "That is the length of the upper arm; joint 3 carries l3.": _MASS * IR50P.l[1] / (_AFTER - _BEFORE),
        },
    ),
)
