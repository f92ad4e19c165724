"""Exercises of notebook 04: acceleration, motor voltage."""

from functools import partial

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.modelling import THESIS_RODS, Actuators, coriolis_matrix, gravity, mass_matrix

NOTEBOOK = "04_dynamics"


# dyn-3: acceleration of the thesis' arm (slender rods) from its M, C and g.
def _solved(q, qd, tau, coriolis=1.0, weight=1.0):
    M, C, g = mass_matrix(THESIS_RODS, q), coriolis_matrix(THESIS_RODS, q, qd), gravity(THESIS_RODS, q)
    return np.linalg.solve(M, tau - coriolis * C @ qd - weight * g)


def _acceleration(q, qd, tau):
    return _solved(q, qd, tau)


def _divided_by_the_diagonal(q, qd, tau):
    M = mass_matrix(THESIS_RODS, q)
    return M @ _acceleration(q, qd, tau) / np.diag(M)


_STATES = [
    (np.array([0.3, 0.5, -0.7]), np.array([0.4, -0.6, 0.8]), np.array([1.0, 20.0, 5.0])),
    (np.array([2.0, -0.4, -1.6]), np.array([-0.9, 1.1, 2.2]), np.array([0.0, 0.0, 0.0])),
]

# dyn-5: one motor with gear.
_MOTOR = Actuators(N=(50,) * 3, Jm=(8e-5,) * 3, kt=(0.05,) * 3, ke=(0.05,) * 3, Ra=(4.0,) * 3, V=24)
_TAU, _QD, _QDD = 2.0, 0.5, 3.0  # N m, rad/s, rad/s^2
_VOLTS = _MOTOR.voltage(np.full(3, _TAU), np.full(3, _QD), np.full(3, _QDD))[0]
_PER_TORQUE, _BACK_EMF = 4.0 / (0.05 * 50), 0.05 * 50 * _QD

EXERCISES = (
    Exercise(
        "dyn-3",
        "the acceleration of THESIS_RODS as a function of (q, qd, tau), from M, C and g",
        Function(_acceleration, cases=_STATES, unit="rad/s^2", tolerance=1e-6),
        why="These three lines are forward dynamics: every simulation of this course calls them.",
        slips={
            "The velocities have no effect in it: C qd is missing.": partial(_solved, coriolis=0.0),
            "The arm would float: g is missing.": partial(_solved, weight=0.0),
            "C qd and g stand on the side of M qdd in (1.74): they change sign when moved.": partial(
                _solved, coriolis=-1.0, weight=-1.0
            ),
            "M couples the joints: solve with all of it, not with its diagonal.": _divided_by_the_diagonal,
        },
    ),
    Exercise(
        "dyn-5",
        "the motor voltage for 2 N m at the joint, 0.5 rad/s and 3 rad/s^2 "
        "(N = 50, Jm = 8e-5 kg m^2, kt = ke = 0.05, Ra = 4 ohm)",
        Number(_VOLTS, unit="V", tolerance=5e-3),
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
