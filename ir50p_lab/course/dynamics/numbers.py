"""Numbers of notebook 04: the gear with which a joint starts fastest."""

import numpy as np

from ir50p_lab.course.checking.numbers import Number

# dyn-6: a motor with a rotor of 2e-5 kg m^2 and any gear turns a load of 0.098 kg m^2.
_ROTOR, _LOAD = 2e-5, 0.098
_BEST = np.sqrt(_LOAD / _ROTOR)

NUMBERS = (
    Number(
        "dyn-6",
        "04_inertia",
        "the gear ratio N with which the joint starts fastest (rotor 2e-5 kg m^2, load 0.098 kg m^2)",
        _BEST,
        tolerance=0.5,
        because="nobody cuts half a tooth",
        why="The rotor, seen through that gear, is as heavy as the load: half of the torque turns the motor itself.",
        slips={
            "That is load by rotor, which is N^2: which gear has that square?": _BEST**2,
            "That is upside down, rotor by load: the motor turns faster than the joint.": 1 / _BEST,
            "There the rotor counts twice as much as the load: set the slope to zero once more.": _BEST * np.sqrt(2),
        },
    ),
)
