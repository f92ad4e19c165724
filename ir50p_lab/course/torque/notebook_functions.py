"""Functions of 14 and 15 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.course.fitting.functions.regressor import regressor
from ir50p_lab.modelling import gravity, inverse_dynamics, load_arm


def carry(q):
    """Return the counts (3,) that hold the weight in the pose q."""
    return gravity(load_arm(), q) / load_arm().actuators.gain


def cancel(x, v):
    """Return the push with which the pendulum in the state x (angle, speed) accelerates with v."""
    return v + 9.81 * np.sin(x[0]) + 0.2 * x[1]


def model(q, qd, qdd):
    """Return the torques (3,) N m that a motion takes, without friction."""
    return inverse_dynamics(load_arm().without_friction(), q, qd, qdd)


def pushes(theta, q, qd, qdd, direction):
    """Return the counts (3,) of a motion, by the rows of a theta (3, 20)."""
    return np.sum(regressor(q, qd, qdd, direction) * theta, axis=1)


def into(q, qd, plan):
    """Return what the model gets on the bench: place, speed and direction."""
    return q, plan[1], np.sign(plan[1])


def planned(model, plan):
    """Return the counts (3,) that the plan takes, by a model; nothing that is measured goes in."""
    return model(plan[0], plan[1], plan[2], np.sign(plan[1]))


# ------------------------------------------------------------------------------------------------------ tried on
def _rows(*shape):
    return np.random.default_rng(140).uniform(-1, 1, (5, *shape))


def _poses():
    return [(q,) for q in _rows(3)]


def _swings():
    return [(x, 3 * v) for x, v in zip(_rows(2), _rows(), strict=True)]


def _motions():
    return [tuple(row) for row in _rows(3, 3)]


def _plans():
    return [(*one[:2], one[2:]) for one in _rows(5, 3)]


def _plans_alone():
    return [(made_up, plan) for plan in _rows(3, 3)]


def _theta_states():
    return [(10 * theta, *states) for theta, states in zip(_rows(3, 20), _rows(4, 3), strict=True)]


def made_up(q, qd, qdd, direction):
    """a made-up arm"""
    return 3 * np.cos(q) + 40 * qd + 5 * qdd + 11 * direction


TASKS = notebook_tasks(
    __file__,
    carry=(carry, _poses, "the counts, three numbers", {"tolerance": 1e-3, "unit": "counts"}),
    cancel=(cancel, _swings, "the push, one number"),
    model=(model, _motions, "the torques, three numbers", {"tolerance": 1e-3, "unit": "N m"}),
    pushes=(pushes, _theta_states, "the counts, three numbers", {"unit": "counts"}),
    into=(into, _plans, "place, speed and direction, three vectors", {"results": ("place", "speed", "direction")}),
    planned=(planned, _plans_alone, "the counts, three numbers", {"unit": "counts"}),
)
