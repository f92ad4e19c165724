"""Number of notebook 14: an error that stays."""

from ir50p_lab.course.checking.number import Number

# ct-3: one joint whose weight the model has wrong.
_M, _KP, _KD, _BELIEVED, _TRUE = 0.6, 49.0, 14.0, 4.0, 5.5  # kg m^2, 1/s^2, 1/s, N m, N m
_SAG = (_BELIEVED - _TRUE) / (_M * _KP)

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
)
