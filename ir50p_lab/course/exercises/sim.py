"""Exercises of notebook 06: a step of time, a joint that sticks, a motor at its limit, a motion within a torque."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.modelling import THESIS_RODS, Actuators, forward_dynamics

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

# sim-3: a motor whose joint data were taken at 12 V, now on 24 V, with Coulomb friction in the joint.
_DATA = {"stall_torque": (4.0,) * 3, "no_load_speed": (2.5,) * 3, "reflected_inertia": (0.15,) * 3, "N": (100.0,) * 3}
_RUBS = 0.5  # N m
_WEAK = Actuators.from_joint_data(**_DATA, V=12.0)
_STRONG = Actuators(N=_WEAK.N, Jm=_WEAK.Jm, kt=_WEAK.kt, ke=_WEAK.ke, Ra=_WEAK.Ra, V=24.0)


def _speed(motor, rubs):
    return motor.no_load_speed[0] * (1 - rubs / motor.stall_torque[0])


# sim-4: the quickest quintic that a torque allows.
_WAY, _INERTIA, _TORQUE = 1.2, 0.8, 3.0  # rad, kg m^2, N m
_SQUARE = _WAY * _INERTIA / _TORQUE  # s^2
_QUINTIC = 10 / np.sqrt(3)  # largest acceleration of a quintic, times duration^2 / way

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
    Exercise(
        "sim-3",
        "the steady speed at full 24 V of a joint with 4 N m stall torque and 2.5 rad/s no-load speed at 12 V, "
        "against 0.5 N m of friction",
        Number(_speed(_STRONG, _RUBS), unit="rad/s", tolerance=5e-3),
        why="The line from stall to no-load speed moves outwards with the supply; its slope, the back-EMF, stays.",
        slips={
            "That is the speed at 12 V: the supply moves both ends of the motor's line.": _speed(_WEAK, _RUBS),
            "The stall torque doubles as well: the same friction costs less of it.": 2 * _speed(_WEAK, _RUBS),
            "That is the no-load speed at 24 V: friction is a load.": _speed(_STRONG, 0.0),
            "The torque line is that of 24 V there, the speed still that of 12 V.": _speed(_WEAK, _RUBS / 2),
        },
    ),
    Exercise(
        "sim-4",
        "the shortest quintic over 1.2 rad for a joint of 0.8 kg m^2 (no gravity) and 3 N m",
        Number(np.sqrt(_QUINTIC * _SQUARE), unit="s", tolerance=5e-3),
        why="Twice the torque makes it 1.4 times faster only: time counts squared.",
        slips={
            "That is the duration squared: the acceleration falls with duration^2.": _QUINTIC * _SQUARE,
            "So fast is full acceleration, then full braking; a quintic starts and ends softly.": np.sqrt(4 * _SQUARE),
            "15/8 belongs to the velocity; the torque asks for the largest acceleration.": np.sqrt(15 / 8 * _SQUARE),
            "That takes way/duration^2 for the acceleration; its peak is several times that.": np.sqrt(_SQUARE),
        },
    ),
)
