"""Exercises of notebook 06: a step of time, a joint that sticks."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.modelling import THESIS_RODS, forward_dynamics

NOTEBOOK = "06_simulation_and_friction"


# sim-1: the midpoint rule for the thesis' arm (slender rods) without drive.
def _rate(q, qd):
    return forward_dynamics(THESIS_RODS, q, qd, np.zeros(3))


def _midpoint(q, qd, h):
    half_q, half_qd = q + h / 2 * qd, qd + h / 2 * _rate(q, qd)
    return np.stack([q + h * half_qd, qd + h * _rate(half_q, half_qd)])


def _euler(q, qd, h):
    return np.stack([q + h * qd, qd + h * _rate(q, qd)])


def _half_way(q, qd, h):
    return _euler(q, qd, h / 2)


def _old_velocity(q, qd, h):
    return np.stack([q + h * qd, _midpoint(q, qd, h)[1]])


def _two_half_steps(q, qd, h):
    return _euler(*_euler(q, qd, h / 2), h / 2)


_STATES = [
    (np.array([0.3, 0.5, -0.7]), np.array([0.4, -0.6, 0.8]), 0.05),
    (np.array([2.0, -0.4, -1.6]), np.array([-0.9, 1.1, 2.2]), 0.02),
]

# sim-2: one joint on a P controller with Coulomb friction, let go away from its set point.
_KP, _FC, _START = 2.0, 0.1, 0.37  # N m/rad, N m, rad


def _rest(start, lost, band):
    """Where the swings end: each turns `lost` rad nearer to the set point; at rest within `band` rad."""
    angle = start
    while abs(angle) > band:
        angle = -np.sign(angle) * (abs(angle) - lost)
    return angle


_RIGHT_REST = _rest(_START, 2 * _FC / _KP, _FC / _KP)

EXERCISES = (
    Exercise(
        "sim-1",
        "a step of h seconds by the midpoint rule for THESIS_RODS without drive: the new q and qd from (q, qd, h)",
        Function(_midpoint, cases=_STATES, tolerance=1e-7),
        why="Two evaluations make it second order; Runge-Kutta spends four and is fourth order.",
        slips={
            "That is Euler's step: it uses the rates at the start, not those half way.": _euler,
            "That stops half way: from the start, go the whole h with the rates found there.": _half_way,
            "The angles still go with the old velocity: half way there is a velocity too.": _old_velocity,
            "Those are two short Euler steps: start again at (q, qd) with the rates half way.": _two_half_steps,
        },
    ),
    Exercise(
        "sim-2",
        "where a joint with kp = 2 N m/rad and Coulomb friction 0.1 N m stops, let go at +0.37 rad from its set point",
        Number(_RIGHT_REST, unit="rad", tolerance=1e-3),
        why="Anywhere within fc/kp of the set point it may rest: dry friction leaves an error if nothing integrates.",
        slips={
            "Within fc/kp of the set point the controller is too weak to move it: it need not get there.": 0.0,
            "Each half swing costs 2 fc/kp: friction moves the centre of the swing by fc/kp.": (
                _rest(_START, _FC / _KP, _FC / _KP)
            ),
            "That is the edge of the dead band; follow the turning points until one is inside.": _FC / _KP,
            "There the controller still pushes harder than friction: it swings once more.": (
                _rest(_START, 2 * _FC / _KP, 2 * _FC / _KP)
            ),
        },
    ),
)
