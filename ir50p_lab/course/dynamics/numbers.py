"""Numbers of notebook 04: a motor's voltage."""

import numpy as np

from ir50p_lab.course.checking.numbers import Number
from ir50p_lab.modelling import Actuators

# dyn-5: one motor with gear.
_MOTOR = Actuators(N=(50,) * 3, Jm=(8e-5,) * 3, kt=(0.05,) * 3, ke=(0.05,) * 3, Ra=(4.0,) * 3, V=24)
_TAU, _QD, _QDD = 2.0, 0.5, 3.0  # N m, rad/s, rad/s^2
_VOLTS = _MOTOR.voltage(np.full(3, _TAU), np.full(3, _QD), np.full(3, _QDD))[0]
_PER_TORQUE, _BACK_EMF = 4.0 / (0.05 * 50), 0.05 * 50 * _QD

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
)
