"""Exercises of notebook 14: gains that are positive and unstable, two poles, an error that stays, a top speed."""

from ir50p_lab.course.exercises import Exercise, Number
from ir50p_lab.modelling import IR50P

NOTEBOOK = "14_computed_torque"

# ct-1: s^3 + K2 s^2 + K1 s + K0; Routh: K2 K1 > K0.
_K1, _K2 = 6.0, 4.0

# ct-2: both poles of one joint's error at the same place.
_POLE = -8.0

# ct-3: one joint whose weight the model has wrong.
_M, _KP, _KD, _BELIEVED, _TRUE = 0.6, 49.0, 14.0, 4.0, 5.5  # kg m^2, 1/s^2, 1/s, N m, N m
_SAG = (_BELIEVED - _TRUE) / (_M * _KP)

# ct-4: joint 1 of the IR50P at full drive, at constant speed.
_D, _FC, _TF = IR50P.theta_pwm[0, 10], IR50P.theta_pwm[0, 11], IR50P.theta_pwm[0, 16]
_FULL = IR50P.actuators.limit_pwm

EXERCISES = (
    Exercise(
        "ct-1",
        "the border of stability: the K0 below which s^3 + 4 s^2 + 6 s + K0 is stable",
        Number(_K1 * _K2, tolerance=1e-6, because="the border is a whole number"),
        why="Above it two roots are on the right, with all gains positive: from three on, the signs are not enough.",
        slips={
            "The sum plays no part: the last but one entry of Routh's first column must stay positive.": _K1 + _K2,
            "A quotient is close: write Routh's table down and see where the row of s^1 turns negative.": _K1 / _K2,
            "Only one of the gains is in that; the row of s^1 holds both K1 and K2.": _K2**2,
        },
    ),
    Exercise(
        "ct-2",
        "(Kp, Kd) of (2.20) that put both poles of a joint's error at -8 1/s",
        Number([_POLE**2, -2 * _POLE], tolerance=1e-6, because="both are whole numbers"),
        why="As in all six tables of the thesis: Kd = 2 sqrt(Kp), critically damped, sqrt(Kp) its speed.",
        slips={
            "Those are the right numbers in the wrong places: Kp multiplies the error itself.": [-2 * _POLE, _POLE**2],
            "That damps half as much as a double pole needs: multiply (s + 8)(s + 8) out.": [_POLE**2, -_POLE],
            "Kp is the square of the speed: multiply (s + 8)(s + 8) out.": [-_POLE, -2 * _POLE],
        },
    ),
    Exercise(
        "ct-3",
        "the error e = q - q_ref that stays when the model holds 4 N m of weight, the arm has 5.5 N m, "
        "M = 0.6 kg m^2, Kp = 49 1/s^2 and Kd = 14 1/s",
        Number(_SAG, unit="rad", tolerance=5e-4),
        why="It sags: an error of the model is divided by M Kp, so that high gains hide it.",
        slips={
            "Kp is an acceleration per rad here; the torque per rad is M Kp.": (_BELIEVED - _TRUE) / _KP,
            "The model carries its 4 N m; only what is missing must be made by the error.": -_TRUE / (_M * _KP),
            "At rest nothing moves, so Kd has no part in it.": (_BELIEVED - _TRUE) / (_M * _KD),
        },
    ),
    Exercise(
        "ct-4",
        "the highest constant speed of joint 1 of the IR50P (row 1 of IR50P.theta_pwm) at 255 counts, level, no load",
        Number((_FULL - _FC - _TF) / _D, unit="rad/s", tolerance=5e-3),
        why="No controller passes it: what a motion needs beyond that, the forecast shows before the arm does.",
        slips={
            "That is the speed without friction; Coulomb friction and offset take their counts first.": _FULL / _D,
            "Friction does not help: it takes counts away from the motion.": (_FULL + _FC + _TF) / _D,
            "Upside down: that is in s/rad.": _D / _FULL,
        },
    ),
)
