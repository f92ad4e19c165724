"""Where the arm may be let go, and how it gets there: without drive it sinks until friction or an end stop holds it."""

from functools import cache
from itertools import pairwise

import numpy as np

from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.dynamics import energy, gravity

_MARGIN = 0.03  # rad kept from the end stops: the host and the board cut drive that pushes against them
_SPEED = 0.5  # rad/s on the trajectory to the rest pose: joint 2 follows it against gravity at 12 V; at 0.8 it lags


def rest_pose(arm):
    """Return the lowest pose in which stiction and end stops hold the arm against gravity, (3,) rad.

    The search is among poses within the joint limits that keep elbow and tip off the table (height 0): joint 1 is in
    the middle of its travel, joints 2 and 3 go over a grid. Gravity may use 70 % of the breakaway torque; an end stop
    holds a joint that gravity presses against it. If no pose is held, the one that comes nearest to it is taken. A
    payload changes nothing, because it is picked up there.
    Args: arm: Arm. Returns: read-only array (3,).
    """
    return _rest_pose(arm.bare)


@cache
def _rest_pose(arm):
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
    low, high = low + _MARGIN, high - _MARGIN
    q2, q3 = np.meshgrid(np.linspace(low[1], high[1], 81), np.linspace(low[2], high[2], 81), indexing="ij")
    q = np.column_stack([np.full(q2.size, 0.5 * (low[0] + high[0])), q2.ravel(), q3.ravel()])
    pull = -gravity(arm, q)  # torque with which gravity moves the joints, N m
    at_stop = ((q <= low + 1e-9) & (pull < 0)) | ((q >= high - 1e-9) & (pull > 0))
    excess = (np.maximum(np.abs(pull) - 0.7 * np.array(arm.friction.fs), 0) * ~at_stop).sum(axis=1)
    height = energy(arm, q, np.zeros_like(q)).potential
    cost = 1e3 * excess + height
    cost[(frames(arm, q)[:, 2:, 2, 3] < 0.02).any(axis=1)] = np.inf
    pose = q[np.argmin(cost)]
    pose.setflags(write=False)
    return pose


def trajectory_to_rest(arm, q, period, limit_pwm=255, speed=np.inf):
    """Return a controller and a reference that bring the arm from q (3,) rad to its rest pose, joint 2 first.

    Joint 2 lifts the arm off the table before joint 3 folds. The gains are those of Tables 4.1-4.3, except for the
    integral gain of joint 2: with 10 it stops up to 0.3 rad short, and then sinks. limit_pwm, speed: what is allowed,
    PWM counts and rad/s, one number or one per joint. period: s.
    Returns: PID, reference.
    """
    from ir50p_lab.controllers import PID
    from ir50p_lab.signals import through

    goal = rest_pose(arm)
    lifted = np.array([q[0], goal[1], q[2]])
    poses = [np.array(q), lifted, goal]
    # the peak of a quintic's speed is 15/8 of its mean
    durations = [
        max(0.3, 1.875 * np.abs(end - start).max() / np.minimum(_SPEED, speed).min()) for start, end in pairwise(poses)
    ]
    pid = PID(kp=(289, 225, 270), ki=(50, 150, 50), kd=(40, 30, 30), limit_pwm=limit_pwm, period=period)
    return pid, through(poses, durations=durations)
