"""Numbers of notebooks 04 and 05: a motor's voltage, the heaviest load."""

import numpy as np

from ir50p_lab.course.checking.numbers import Number
from ir50p_lab.modelling import IR50P, Actuators, gravity, jacobian

# dyn-5: one motor with gear.
_MOTOR = Actuators(N=(50,) * 3, Jm=(8e-5,) * 3, kt=(0.05,) * 3, ke=(0.05,) * 3, Ra=(4.0,) * 3, V=24)
_TAU, _QD, _QDD = 2.0, 0.5, 3.0  # N m, rad/s, rad/s^2
_VOLTS = _MOTOR.voltage(np.full(3, _TAU), np.full(3, _QD), np.full(3, _QDD))[0]
_PER_TORQUE, _BACK_EMF = 4.0 / (0.05 * 50), 0.05 * 50 * _QD

# weight-1: what the shoulder's motor can still hold at the tip.
_POSE, _STALL = np.radians([0, 30, -60]), 7.0  # rad, N m
_PER_KG, _STRETCHED = IR50P.g * jacobian(IR50P, _POSE)[2, 1], IR50P.g * IR50P.reach  # N m/kg
_LOAD = (_STALL - gravity(IR50P, _POSE)[1]) / _PER_KG

NUMBERS = (
    Number(
        "dyn-5",
        "04_dynamics",
        "the motor voltage for 2 N m at the joint, 0.5 rad/s and 3 rad/s^2 "
        "(N = 50, Jm = 8e-5 kg m^2, kt = ke = 0.05, Ra = 4 ohm)",
        _VOLTS,
        unit="V",
        tolerance=5e-3,
        why="The gear multiplies the rotor's inertia by N^2: 0.2 kg m^2 here, more than the forearm has.",
        slips={
            "The back-EMF ke N qd is missing: a turning motor works against its supply.": _VOLTS - _BACK_EMF,
            "The rotor's inertia is taken N times, as in the thesis; at the joint it counts N^2 times.": (
                _PER_TORQUE * (_TAU + 50 * 8e-5 * _QDD) + _BACK_EMF
            ),
            "That adds torques as (1.120) prints it: the result is in N m, not in volts.": _TAU + 50 * 8e-5 * _QDD,
            "The rotor has to be accelerated too: N^2 Jm qdd is missing.": _PER_TORQUE * _TAU + _BACK_EMF,
        },
    ),
    Number(
        "weight-1",
        "05_equation_of_motion",
        "the heaviest load at the tip of the IR50P that 7.0 N m at its shoulder hold at (0, 30, -60) degrees",
        _LOAD,
        unit="kg",
        tolerance=2e-3,
        why="Bending the elbow brings the load in: stretched and level it is a quarter less.",
        slips={
            "The arm itself weighs on the shoulder, too: the load gets what it leaves of the torque.": _STALL / _PER_KG,
            "That is a force in N; a kilogram weighs 9.81 N.": IR50P.g * _LOAD,
            "That is the lever of the stretched arm: how far outwards is the tip here?": _LOAD * _PER_KG / _STRETCHED,
        },
    ),
)
