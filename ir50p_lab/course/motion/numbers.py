"""Numbers of notebooks 06 and 07: the shortest time of a way, and where a joint sticks."""

import numpy as np

from ir50p_lab.course.checking.numbers import Number

# traj-1: the shortest quintic that keeps each joint below a speed.
_TIMES = 15 / 8 * np.array([0.343 / 2.5, 1.523 / 1.1, 1.247 / 1.3])  # s, of each joint: rad, rad/s

# sim-2: one joint on a P controller with Coulomb friction, let go away from its set point.
_KP, _FC, _START = 2.0, 0.1, 0.37  # N m/rad, N m, rad


def _rest(start, lost, band):
    """Where the swings end: each turns `lost` rad nearer to the set point; at rest within `band` rad."""
    angle = start
    while abs(angle) > band:
        angle = -np.sign(angle) * (abs(angle) - lost)
    return angle


_RIGHT_REST = _rest(_START, 2 * _FC / _KP, _FC / _KP)

NUMBERS = (
    Number(
        "traj-1",
        "06_simulation_and_trajectories",
        "the shortest duration of a quintic over -0.343, -1.523 and 1.247 rad with at most 2.5, 1.1 and 1.3 rad/s",
        np.max(_TIMES),
        unit="s",
        tolerance=0.01,
        why="One joint decides, here the shoulder; the others have time to spare. 07 will ask for just this.",
        slips={
            "That is for an even speed: half way a quintic is faster.": np.max(_TIMES) * 8 / 15,
            "That is the waist's time; all three have to keep their speed.": _TIMES[0],
            "That is the elbow's time; another joint needs longer.": _TIMES[2],
            "The joints move at the same time: their times are not added.": np.sum(_TIMES),
        },
    ),
    Number(
        "sim-2",
        "07_friction_and_motors",
        "where a joint with kp = 2 N m/rad and Coulomb friction 0.1 N m stops, let go at +0.37 rad from its set point",
        _RIGHT_REST,
        unit="rad",
        tolerance=1e-3,
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
