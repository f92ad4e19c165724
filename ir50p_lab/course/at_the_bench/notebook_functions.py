"""Functions of 11 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course.checking.task import Mistake, notebook_tasks
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.kinematics.functions.reach import reach
from ir50p_lab.course.motion.functions.quintic import quintic
from ir50p_lab.modelling import load_arm

CENTRE, RADIUS, LAP = np.array([0.42, -0.15, 0.13]), 0.06, 6.5  # m, m, s, as in the notebook


def circle(t):
    """Rows (3, 3) of the circle at the time t: angles, speeds, accelerations (zeros)."""
    return _circle(t)


def _circle(t, *, growth=1.0, pace=1.0, turn=1.0, at=None):
    arm = load_arm()
    l, limits = np.array(arm.l), np.clip([arm.q_min, arm.q_max], -np.pi, np.pi)
    first = reach(CENTRE + np.array([RADIUS, 0, 0]), l, rest_pose(arm), limits)
    turned, rate, _ = quintic(0.0, 2 * np.pi, LAP, t)
    place = CENTRE + RADIUS * np.array([np.cos(turned), np.sin(turned), 0])
    q = reach(place, l, first, limits)
    J = jacobian(frames(q if at is None else first, l), 3, place)[:3]
    v = growth * (1.0 if pace is None else rate) * np.array([-np.sin(turned), turn * np.cos(turned), 0])
    return np.array([q, np.linalg.solve(J, RADIUS * v), np.zeros(3)])


def motor_law(t, v, T, L):
    """Way after the times t since a push, rad: speed v in the end, time constant T, dead time L."""
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


# ------------------------------------------------------------------------------------------------- typical mistakes
def _no_rate(t):
    return _circle(t, pace=None)


def _no_radius(t):
    return _circle(t, growth=1 / RADIUS)


def _other_sense(t):
    return _circle(t, turn=-1.0)


def _old_jacobian(t):
    return _circle(t, at="first")


def _before(t, v, T, L):
    return v * (t - L - T * (1 - np.exp(-(t - L) / T)))


def _speed(t, v, T, L):
    return v * (1 - np.exp(-np.maximum(0, t - L) / T))


def _radians(kp, w, K, T, late):
    return once_round(kp, w, K, T, late)[0], 90 + np.arctan(w * T) + w * late


def _no_sum(kp, w, K, T, late):
    size, degrees = once_round(kp, w, K, T, late)
    return size * w, degrees - 90


def _prompt(kp, w, K, T, late):
    return once_round(kp, w, K, T, 0.0)


_CLOCK = "the speeds in it do not know how fast the angle round the circle grows: quintic told you"
_METRES = "the tip would have to go a metre for each radian of the circle: how large is it?"
_ACROSS = "its speeds do not point along the circle: what is the slope of the place?"
_ELSEWHERE = "the Jacobian in it belongs to another pose than the one that it returns"
_BEFORE = "before the dead time is over nothing moves: what does it give for a t below L?"
_SPEED = "that is the speed: the way is its sum"
_DEGREES = "arctan gives radians, and so does w times a lateness"
_SUM = "from speed to angle the motor's sine is summed up: that has a size and 90 degrees of its own"
_LATE = "the lateness is left out: w times late, in degrees"

TASKS = notebook_tasks(
    __file__,
    circle=(circle, _times, "three rows: angles, speeds, zeros", {
        "mistakes": (Mistake(_no_rate, _CLOCK), Mistake(_no_radius, _METRES), Mistake(_other_sense, _ACROSS),
                     Mistake(_old_jacobian, _ELSEWHERE)), "tolerance": 1e-6}),
    motor_law=(motor_law, _pushes, "a way for each t", {
        "mistakes": (Mistake(_before, _BEFORE), Mistake(_speed, _SPEED))}),
    once_round=(once_round, _loops, "size and degrees, two numbers", {
        "results": ("size", "degrees"),
        "mistakes": (Mistake(_radians, _DEGREES), Mistake(_no_sum, _SUM), Mistake(_prompt, _LATE))}),
)  # fmt: skip
