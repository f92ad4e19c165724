"""Numbers of notebook 14: an error that stays, a top speed."""

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P

# ct-3: one joint whose weight the model has wrong.
_M, _KP, _KD, _BELIEVED, _TRUE = 0.6, 49.0, 14.0, 4.0, 5.5  # kg m^2, 1/s^2, 1/s, N m, N m
_SAG = (_BELIEVED - _TRUE) / (_M * _KP)

# ct-4: joint 1 of the IR50P at full drive, at constant speed.
_D, _FC, _TF = IR50P.theta_pwm[0, 10], IR50P.theta_pwm[0, 11], IR50P.theta_pwm[0, 16]
_FULL = IR50P.actuators.limit_pwm

NUMBERS = (
    Number(
        "ct-3",
        "14_computed_torque",
        "the error e = q - q_ref that stays when the model holds 4 N m of weight, the arm has 5.5 N m, "
        "M = 0.6 kg m^2, Kp = 49 1/s^2 and Kd = 14 1/s",
        _SAG,
        unit="rad",
        tolerance=5e-4,
        why="It sags: an error of the model is divided by M Kp, so that high gains hide it.",
        mistakes={
            "Kp is an acceleration per rad here; the torque per rad is M Kp.": (_BELIEVED - _TRUE) / _KP,
            "The model carries its 4 N m; only what is missing must be made by the error.": -_TRUE / (_M * _KP),
            "At rest nothing moves, so Kd has no part in it.": (_BELIEVED - _TRUE) / (_M * _KD),
        },
    ),
    Number(
        "ct-4",
        "15_on_the_bench",
        "the highest constant speed of joint 1 of the IR50P (row 1 of IR50P.theta_pwm) at 255 counts, level, no load",
        (_FULL - _FC - _TF) / _D,
        unit="rad/s",
        tolerance=5e-3,
        why="No controller passes it: what a motion needs beyond that, the forecast shows before the arm does.",
        mistakes={
            "That is the speed without friction; Coulomb friction and offset take their counts first.": _FULL / _D,
            "Friction does not help: it takes counts away from the motion.": (_FULL + _FC + _TF) / _D,
            "Upside down: that is in s/rad.": _D / _FULL,
        },
    ),
)
