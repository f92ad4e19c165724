"""Exercises of notebook 04: inertia, holding torque, acceleration, friction, motor voltage."""

from functools import partial

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.modelling import (
    IR50P,
    THESIS_RODS,
    Actuators,
    Friction,
    coriolis_matrix,
    friction_torque,
    gravity,
    jacobian,
    mass_matrix,
)

NOTEBOOK = "04_dynamics"

# dyn-1: a slender rod that turns about its end, with a hand at the other end.
_ROD_MASS, _HAND_MASS, _LENGTH = 0.6, 0.2, 0.4  # kg, kg, m
_ROD = _ROD_MASS * _LENGTH**2
_HAND = _HAND_MASS * _LENGTH**2

# dyn-2: the IR50P holds a payload at its tip.
_POSE = (0.3, 0.5, -0.7)  # rad
_PAYLOAD = 0.5  # kg
_OWN = gravity(IR50P, _POSE)
_LIFT = jacobian(IR50P, _POSE)[2]  # the row of Jv that belongs to z


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

# dyn-4: one joint that creeps backwards.
_FRICTION = Friction(fv=(2.0,) * 3, fc=(0.5,) * 3, fs=(0.9,) * 3, qs=(0.05,) * 3)
_CREEP = -0.02  # rad/s
_RIGHT_FRICTION = friction_torque(_FRICTION, np.full(3, _CREEP))[0]
_DECAY = np.exp(-((_CREEP / 0.05) ** 2))

# dyn-5: one motor with gear.
_MOTOR = Actuators(N=(50,) * 3, Jm=(8e-5,) * 3, kt=(0.05,) * 3, ke=(0.05,) * 3, Ra=(4.0,) * 3, V=24)
_TAU, _QD, _QDD = 2.0, 0.5, 3.0  # N m, rad/s, rad/s^2
_VOLTS = _MOTOR.voltage(np.full(3, _TAU), np.full(3, _QD), np.full(3, _QDD))[0]
_PER_TORQUE, _BACK_EMF = 4.0 / (0.05 * 50), 0.05 * 50 * _QD

EXERCISES = (
    Exercise(
        "dyn-1",
        "the moment of inertia about the elbow of a rod (0.6 kg, 0.4 m) with a hand (0.2 kg, a point) at its end",
        Number(_ROD / 3 + _HAND, unit="kg m^2", tolerance=1e-4),
        why="The hand is a quarter of the mass and half of the inertia: distance counts squared.",
        slips={
            "The rod turns about its end here, not about its middle: Steiner's term is missing.": _ROD / 12 + _HAND,
            "That takes the rod as a point in its middle: its own inertia about it is missing.": _ROD / 4 + _HAND,
            "That is the rod alone: the hand turns with it.": _ROD / 3,
            "That is about the middle of the rod; the arm turns about the elbow.": _ROD / 12 + _HAND / 4,
        },
    ),
    Exercise(
        "dyn-2",
        "the three torques that hold the IR50P at q = (0.3, 0.5, -0.7) rad with 0.5 kg at its tip",
        Number(_OWN + _LIFT * _PAYLOAD * IR50P.g, unit="N m", tolerance=1e-3),
        why="Half a kilogram (the maker's payload) adds three quarters of what the links ask of the shoulder.",
        slips={
            "That holds the arm alone: the payload pulls at the tip as well.": _OWN,
            "The payload makes it heavier, not lighter: check its sign.": _OWN - _LIFT * _PAYLOAD * IR50P.g,
            "The payload entered as a mass; its weight is m g.": _OWN + _LIFT * _PAYLOAD,
            "That holds the payload alone: the links have weight too.": _LIFT * _PAYLOAD * IR50P.g,
        },
    ),
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
        "dyn-4",
        "the friction torque at -0.02 rad/s for fv = 2, fc = 0.5, fs = 0.9 and qs = 0.05",
        Number(_RIGHT_FRICTION, unit="N m", tolerance=1e-3),
        why="Below the Stribeck velocity the slower joint needs more torque: this makes it stick and slip.",
        slips={
            "That leaves the Stribeck term out, which matters at this low speed.": 2 * _CREEP - 0.5,
            "At 0.02 rad/s part of the Stribeck term is gone already: it decays with speed.": 2 * _CREEP - 0.9,
            "The Stribeck term starts from fs - fc, so that both together start from fs.": (
                2 * _CREEP - 0.5 - 0.9 * _DECAY
            ),
            "All three parts change sign with the velocity, not only the viscous one.": 2 * _CREEP + 0.5 + 0.4 * _DECAY,
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
