"""Functions of 06 and 07 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.modelling import forward_dynamics, inverse_dynamics, load_arm
from ir50p_lab.modelling.friction import friction_torque as friction


def falling(t, x):
    """Return the rates (6,) of the state x: angles and speeds of an arm without motors and friction."""
    arm = load_arm().without_friction()
    return np.concatenate([x[3:], forward_dynamics(arm.theta, x[:3], x[3:], np.zeros(3), g=arm.g)])


def halve(too_much, too_short, enough):
    """Return the shortest time (s) for which too_much(time) is not above 0, by ten halvings."""
    for _ in range(10):
        middle = (too_short + enough) / 2
        if too_much(middle) > 0:
            too_short = middle
        else:
            enough = middle
    return enough


def slide(speed, taken):
    """Return the speed (rad/s) that dry friction leaves: it can take `taken` of it, but never more than there is."""
    return np.sign(speed) * max(abs(speed) - taken, 0.0)


def motor_factors(N, kt, ke, Ra, V):
    """Return the torque of one count, N m, and of one rad/s, N m s/rad, for a motor behind its gear."""
    return N * kt * V / (255 * Ra), N**2 * kt * ke / Ra


def counts_for(q, qd, qdd):
    """Return the counts (3,) that a motion takes."""
    arm = load_arm()
    torque = inverse_dynamics(arm.without_friction(), q, qd, qdd)
    rubbing, brake = friction(arm, qd), arm.actuators.back_emf_damping * qd
    return (torque + rubbing + brake) / arm.actuators.gain


# ------------------------------------------------------------------------------------------------------ tried on
def _states():
    rows = np.random.default_rng(61).uniform(-2, 2, (6, 6))  # all of them move
    return [(0.1 * k, row) for k, row in enumerate(rows)]


def _limits():
    def least(seconds):
        def too_much(time):
            return (seconds / time) ** 2 - 1

        too_much.__doc__ = f"{seconds} s are just enough"
        return too_much

    return [(least(0.76), 0.2, 3.0), (least(2.9), 0.2, 3.0), (least(0.5), 0.1, 5.0)]


def _slides():
    return [(0.5, 0.2), (-0.5, 0.2), (0.1, 0.2), (-0.1, 0.2), (0.0, 0.2), (0.3, 0.3), (1.2, 0.0)]


def _motors():
    low, high = [20, 0.01, 0.01, 1, 6], [90, 0.05, 0.05, 9, 24]
    return [tuple(row) for row in np.random.default_rng(62).uniform(low, high, (5, 5))]


def _motions():
    return [tuple(row) for row in np.random.default_rng(63).uniform(-1, 1, (6, 3, 3))]


TASKS = notebook_tasks(
    __file__,
    falling=(falling, _states, "six rates: of three angles and of three speeds", {"tolerance": 0.02}),
    halve=(halve, _limits, "the shortest time that is enough, s", {"tolerance": 0.01, "unit": "s"}),
    slide=(slide, _slides, "the speed that is left, rad/s"),
    motor_factors=(motor_factors, _motors, "gain and damping, two numbers", {"results": ("gain", "damping")}),
    counts_for=(counts_for, _motions, "the counts, three numbers", {"tolerance": 0.05, "unit": "counts"}),
)
