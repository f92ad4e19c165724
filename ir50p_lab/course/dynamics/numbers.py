"""Numbers of notebooks 04 and 05: the gear with which a joint starts fastest, the heaviest load."""

import numpy as np

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P, gravity, jacobian

# dyn-6: a motor with a rotor of 2e-5 kg m^2 and any gear turns a load of 0.098 kg m^2.
_ROTOR, _LOAD = 2e-5, 0.098
_BEST = np.sqrt(_LOAD / _ROTOR)

# weight-1: what the shoulder's motor can still hold at the tip.
_POSE, _STALL = np.radians([0, 30, -60]), 7.0  # rad, N m
_PER_KG, _STRETCHED = IR50P.g * jacobian(IR50P, _POSE)[2, 1], IR50P.g * IR50P.reach  # N m/kg
_HEAVIEST = (_STALL - gravity(IR50P, _POSE)[1]) / _PER_KG
_DEGREES = np.remainder([0, 30, -60], 2 * np.pi)  # taken for radians
_BY_DEGREES = (_STALL - gravity(IR50P, _DEGREES)[1]) / (IR50P.g * jacobian(IR50P, _DEGREES)[2, 1])

NUMBERS = (
    Number(
        "dyn-6",
        "04_inertia",
        "the gear ratio N with which the joint starts fastest (rotor 2e-5 kg m^2, load 0.098 kg m^2)",
        _BEST,
        tolerance=0.5,
        because="nobody cuts half a tooth",
        why="The rotor, seen through that gear, is as heavy as the load: half of the torque turns the motor itself.",
        mistakes={
            "That is load over rotor, which is N^2: which gear has that square?": _BEST**2,
            "That is next to nothing: is it upside down, rotor over load? The motor turns faster than the joint.": 1
            / _BEST,
            "There the rotor counts twice as much as the load: set the slope to zero once more.": _BEST * np.sqrt(2),
        },
    ),
    Number(
        "weight-1",
        "05_equation_of_motion",
        "the heaviest load at the tip of the IR50P that 7.0 N m at its shoulder hold at (0, 30, -60) degrees",
        _HEAVIEST,
        unit="kg",
        tolerance=2e-3,
        why="Bending the elbow brings the load in: stretched and level it is a quarter less.",
        mistakes={
            "The arm itself weighs on the shoulder, too: the load gets what it leaves of the torque.": _STALL / _PER_KG,
            "The angles are taken in degrees: cos and sin want radians.": _BY_DEGREES,
            "That is a force in N; a kilogram weighs 9.81 N.": IR50P.g * _HEAVIEST,
            "That is the lever of the stretched arm: how far outwards is the tip here?": _HEAVIEST
            * _PER_KG
            / _STRETCHED,
        },
    ),
)
