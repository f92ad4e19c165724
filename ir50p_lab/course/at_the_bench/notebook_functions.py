"""Functions of 11 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.kinematics.functions.reach import reach
from ir50p_lab.course.motion.functions.quintic import quintic
from ir50p_lab.modelling import load_arm

CENTRE, RADIUS, LAP = np.array([0.42, -0.15, 0.13]), 0.06, 6.5  # m, m, s, as in the notebook


def circle(t):
    """Rows (3, 3) of the circle at the time t: angles, speeds, accelerations (zeros)."""
    arm = load_arm()
    l, limits = np.array(arm.l), np.clip([arm.q_min, arm.q_max], -np.pi, np.pi)
    first = reach(CENTRE + np.array([RADIUS, 0, 0]), l, rest_pose(arm), limits)
    turned, rate, _ = quintic(0.0, 2 * np.pi, LAP, t)
    outwards, along = np.array([np.cos(turned), np.sin(turned), 0]), np.array([-np.sin(turned), np.cos(turned), 0])
    place = CENTRE + RADIUS * outwards
    q = reach(place, l, first, limits)
    J = jacobian(frames(q, l), 3, place)[:3]
    return np.array([q, np.linalg.solve(J, RADIUS * rate * along), np.zeros(3)])


def motor_law(t, v, T, L):
    """Turn at the times t after a push, rad: speed v in the end, time constant T, dead time L."""
    on = np.maximum(0, t - L)
    return v * (on - T * (1 - np.exp(-on / T)))


def once_round(kp, w, K, T, late):
    """Size, and degrees of lateness, of a sine of w rad/s after one turn round the loop."""
    return kp * K / (w * np.hypot(1, w * T)), 90 + np.degrees(np.arctan(w * T) + w * late)


# ------------------------------------------------------------------------------------------------------ tried on
def _times():
    return [(t,) for t in (0.7, 2.0, 3.25, 5.1, -1.0, 0.0, LAP, LAP + 1)]


def _pushes():
    times = np.linspace(-0.1, 0.5, 7)
    return [(times, v, T, L) for v, T, L in ((1.0, 0.1, 0.02), (-0.7, 0.2, 0.03), (2.0, 0.05, 0.0))]


def _loops():
    low, high = [200, 3, 0.005, 0.05, 0.01], [4000, 40, 0.02, 0.3, 0.05]
    return [tuple(row) for row in np.random.default_rng(11).uniform(low, high, (6, 5))]


TASKS = notebook_tasks(
    __file__,
    circle=(circle, _times, "three rows: angles, speeds, zeros", {"tolerance": 1e-6}),
    motor_law=(motor_law, _pushes, "a turn for each t"),
    once_round=(once_round, _loops, "size and degrees, two numbers", {"results": ("size", "degrees")}),
)
