"""Numbers of notebooks 06 and 07: the shortest time of a motion, a motor's voltage."""

import numpy as np

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import Actuators

# traj-1: the shortest quintic that keeps each joint below a speed.
_TIMES = 15 / 8 * np.array([0.343 / 2.5, 1.523 / 1.1, 1.247 / 1.3])  # s, of each joint: rad, rad/s

# dyn-5: one motor with gear.
_MOTOR = Actuators(N=(50,) * 3, Jm=(8e-5,) * 3, kt=(0.05,) * 3, ke=(0.05,) * 3, Ra=(4.0,) * 3, V=24)
_TAU, _QD, _QDD = 2.0, 0.5, 3.0  # N m, rad/s, rad/s^2
_VOLTS = _MOTOR.voltage(np.full(3, _TAU), np.full(3, _QD), np.full(3, _QDD))[0]
_PER_TORQUE, _BACK_EMF = 4.0 / (0.05 * 50), 0.05 * 50 * _QD

NUMBERS = (
    Number(
        "traj-1",
        "06_simulation_and_trajectories",
        "the shortest duration of a quintic over -0.343, -1.523 and 1.247 rad with at most 2.5, 1.1 and 1.3 rad/s",
        np.max(_TIMES),
        unit="s",
        tolerance=0.01,
        why="One joint decides, here the shoulder; the others have time to spare. 07 asks in counts.",
        mistakes={
            "That is for an even speed: halfway a quintic is faster.": np.max(_TIMES) * 8 / 15,
            "That is the waist's time; all three have to keep their speed.": _TIMES[0],
            "That is the elbow's time; another joint needs longer.": _TIMES[2],
            "The joints move at the same time: their times are not added.": np.sum(_TIMES),
        },
    ),
    Number(
        "dyn-5",
        "07_friction_and_motors",
        "the motor voltage for 2 N m at the joint, 0.5 rad/s and 3 rad/s^2 "
        "(N = 50, Jm = 8e-5 kg m^2, kt = ke = 0.05, Ra = 4 ohm)",
        _VOLTS,
        unit="V",
        tolerance=5e-3,
        why="The gear multiplies the rotor's inertia by N^2: 0.2 kg m^2 here, more than the forearm has.",
        mistakes={
            "The motor turns N times as fast as the joint: its back-EMF is ke N qd.": _VOLTS - _BACK_EMF * 49 / 50,
            "The back-EMF ke N qd is missing: a turning motor works against its supply.": _VOLTS - _BACK_EMF,
            "The rotor's inertia is taken N times, as in the thesis; at the joint it counts N^2 times.": (
                _PER_TORQUE * (_TAU + 50 * 8e-5 * _QDD) + _BACK_EMF
            ),
            "That adds torques as (1.120) prints it: the result is in N m, not in volts.": _TAU + 50 * 8e-5 * _QDD,
            "The rotor has to be accelerated too: N^2 Jm qdd is missing.": _PER_TORQUE * _TAU + _BACK_EMF,
        },
    ),
)
