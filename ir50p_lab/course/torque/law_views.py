"""Notebook 14: the path to the ball, runs along it, how far off it the tip is; and P and D with a push beside them."""

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.controllers import ComputedTorque
from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.draw.traces import STAMP
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.course.torque.views import RobustnessView
from ir50p_lab.identification import regressor
from ir50p_lab.signals import quintic
from ir50p_lab.simulation import simulate

ABOVE_THE_BALL = np.array([0.42, -0.15, 0.09])  # m, as in 00


def kept_path(arm):
    """Return 07's path from rest to above the ball, and its seconds: 0.1 s more than the least for 250 counts."""
    rest = rest_pose(arm)
    there = my_robot.reach(ABOVE_THE_BALL, arm.l, rest, parts(arm).limits)

    def most_counts(seconds):
        rows = quintic(rest, there, duration=seconds).sample(np.linspace(0, seconds, 21))
        return np.abs(np.einsum("nij,ij->ni", regressor(*rows.transpose(1, 0, 2)), arm.theta_pwm)).max()

    seconds = next(one for one in np.arange(0.7, 8, 0.1) if most_counts(one) < 250) + 0.1
    return lambda t: np.array(my_robot.quintic(rest, there, seconds, t)), seconds


def driven(arm, controller, reference, seconds, **options):
    """Return a simulated run from where the reference begins."""
    if hasattr(controller, "reset"):
        controller.reset()
    return simulate(arm, controller, reference, q0=reference(0)[0], duration=seconds, **options)


def beside(run, l, calm=1):
    """Return how far the tip is from where the reference is just then, (n,) mm: means of `calm` samples."""
    planned = run.reference if run.reference.ndim == 2 else run.reference[:, 0]
    off = np.lib.stride_tricks.sliding_window_view(_tips(run.q, l) - _tips(planned, l), calm, axis=0)
    return 1000 * np.linalg.norm(off.mean(axis=-1), axis=1)


def clearance(run, l, ball, radius=0.03):
    """Return the least distance of the tip from the skin of the ball, mm."""
    return 1000 * (np.linalg.norm(_tips(run.q, l) - ball, axis=1).min() - radius)


def _tips(q, l):
    return np.array([my_robot.forward_kinematics(row, l) for row in q])


class PushAndPD:
    """P and D of 08 (1000 and 40) and, if asked for, I; plus the counts that `push(q, reference)` returns."""

    unit = "PWM"

    def __init__(self, push, ki=0):
        self.pid, self.push = my_robot.PID(kp=1000, ki=ki, kd=40), push
        self.reset = self.pid.reset

    def step(self, t, q, reference):
        """Return the counts (3,) for one sample."""
        return np.clip(self.pid.step(t, q, reference) + self.push(q, reference), -255, 255)


def robustness(arm, path, seconds):
    """Errors over the scale of the model and the speed of the loop, by the compiled twin of the law: RobustnessView."""
    smooth = arm.without_friction()

    def run(scale, speed):
        law = ComputedTorque(scale * smooth.theta, speed**2, 2 * speed, g=smooth.g, filter_hz=np.inf)
        return simulate(smooth, law, path, q0=path(0)[0], duration=seconds, step=0.002)

    return RobustnessView(np.linspace(0.5, 1.5, 7), np.linspace(3, 33, 7), run, duration=seconds, error_max=200)


def bars(values, ylabel):
    """Draw a bar for each name, {name: value}. Returns: LabFigure."""
    figure, ax = subplots(8.0, 3.2, note=STAMP)
    drawn = ax.bar(list(values), list(values.values()), color=COLOURS["blue"])
    ax.bar_label(drawn, fmt="%.3g")
    ax.set(ylabel=ylabel)
    return figure
