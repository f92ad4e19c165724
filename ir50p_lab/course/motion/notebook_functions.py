"""Functions of 06 and 07 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import Mistake, notebook_tasks
from ir50p_lab.modelling import forward_dynamics, inverse_dynamics, load_arm
from ir50p_lab.modelling.friction import friction_torque as friction


def falling(t, x):
    """The rates (6,) of the state x: angles and speeds of an arm without motors and friction."""
    arm = load_arm().without_friction()
    return np.concatenate([x[3:], forward_dynamics(arm.theta, x[:3], x[3:], np.zeros(3), g=arm.g)])


def halve(too_much, too_short, enough):
    """The shortest time (s) for which too_much(time) is not above 0, by ten halvings."""
    for _ in range(10):
        middle = (too_short + enough) / 2
        if too_much(middle) > 0:
            too_short = middle
        else:
            enough = middle
    return enough


def slide(speed, taken):
    """Speed (rad/s) that dry friction leaves, which can take `taken` of it, and never more than there is."""
    return np.sign(speed) * max(abs(speed) - taken, 0.0)


def motor_factors(N, kt, ke, Ra, V):
    """Torque of one count, N m, and of one rad/s, N m s/rad, of a motor behind its gear."""
    return N * kt * V / (255 * Ra), N**2 * kt * ke / Ra


def counts_for(q, qd, qdd):
    """The counts (3,) that a motion takes."""
    return _counts(inverse_dynamics(load_arm().without_friction(), q, qd, qdd), friction(load_arm(), qd), qd)


def _counts(torque, rubbing, qd):
    motor = load_arm().actuators
    return (torque + rubbing + motor.back_emf_damping * qd) / motor.gain


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


# ------------------------------------------------------------------------------------------------- typical mistakes
def _lets_it_back(speed, taken):
    return speed - np.sign(speed) * taken


def _one_sided(speed, taken):
    return speed - taken


def _angles_stand(t, x):
    return np.concatenate([np.zeros(3), falling(t, x)[3:]])


def _angles_for_speeds(t, x):
    return np.concatenate([x[:3], falling(t, x)[3:]])


def _one_gear(N, kt, ke, Ra, V):
    return N * kt * V / (255 * Ra), N * kt * ke / Ra


def _of_volts(N, kt, ke, Ra, V):
    return N * kt / Ra, N**2 * kt * ke / Ra


def _no_friction(q, qd, qdd):
    return counts_for(q, qd, qdd) - friction(load_arm(), qd) / load_arm().actuators.gain


def _friction_helps(q, qd, qdd):
    return counts_for(q, qd, qdd) - 2 * friction(load_arm(), qd) / load_arm().actuators.gain


def _no_brake(q, qd, qdd):
    motor = load_arm().actuators
    return counts_for(q, qd, qdd) - motor.back_emf_damping * qd / motor.gain


def _neither(q, qd, qdd):
    return _no_friction(q, qd, qdd) + _no_brake(q, qd, qdd) - counts_for(q, qd, qdd)


_BACK = "a slow joint comes out of it moving backwards: can friction take more speed than there is?"
_SIDE = "forwards it brakes, backwards it pushes along: friction works against the speed, whichever way"
_STAND = "the angles do not change in it: at which rates do they, when the arm moves?"
_ANGLES = "the angles change at the rate of the angles in it: which part of x are speeds?"
_TWICE = "the gear comes into the damping twice: the motor turns faster, and its brake is made stronger"
_PER_VOLT = "the gain is that of one volt: how many volts is one count?"
_RUBS = "friction costs counts, too"
_HELPS = "friction helps in it: friction_alone has its minus already"
_TURNS = "a motor that turns brakes itself: solve motor_torque for the counts, speed and all"
_BOTH = "friction and the motor's own brake cost counts, too"

TASKS = notebook_tasks(
    __file__,
    falling=(falling, _states, "six rates: of three angles and of three speeds", {
        "mistakes": (Mistake(_angles_stand, _STAND), Mistake(_angles_for_speeds, _ANGLES)), "tolerance": 0.02}),
    halve=(halve, _limits, "the shortest time that is enough, s", {"tolerance": 0.01, "unit": "s"}),
    slide=(slide, _slides, "the speed that is left, rad/s", {
        "mistakes": (Mistake(_lets_it_back, _BACK), Mistake(_one_sided, _SIDE))}),
    motor_factors=(motor_factors, _motors, "gain and damping, two numbers", {
        "results": ("gain", "damping"), "mistakes": (Mistake(_one_gear, _TWICE), Mistake(_of_volts, _PER_VOLT))}),
    counts_for=(counts_for, _motions, "the counts, three numbers", {
        "mistakes": (Mistake(_no_friction, _RUBS), Mistake(_friction_helps, _HELPS), Mistake(_no_brake, _TURNS),
                  Mistake(_neither, _BOTH)), "tolerance": 0.05, "unit": "counts"}),
)  # fmt: skip
