"""Pictures of notebook 08: a push against the weight, where pushes end, and trembling."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.dynamics import gravity


def weight_over_angle(arm, push):
    """Plot the counts that hold the shoulder over its angle, elbow straight, with a constant push.

    Returns: LabFigure.
    """
    figure, ax = subplots(7.4, 3.8)
    q2 = np.linspace(arm.q_min[1], arm.q_max[1], 200)
    weight = gravity(arm, np.column_stack([0 * q2, q2, 0 * q2]))[:, 1] / arm.actuators.gain[1]
    low, high = weight + (arm.friction.Tf[1] + np.array([[-1], [1]]) * arm.friction.fs[1]) / arm.actuators.gain[1]
    ax.plot(q2, weight, linewidth=2.5, label="weight")
    ax.fill_between(q2, low, high, color=COLOURS["sky"], alpha=0.3, label="friction holds")
    ax.axhline(push, color=COLOURS["orange"], linewidth=2.5, label=f"a push of {push} counts")
    for k in np.flatnonzero(np.diff(np.sign(weight - push))):
        ax.plot(q2[k], push, "o", ms=9, color=COLOURS["dark"])
        says = "hanging:\nwould come back" if q2[k] < 0 else "standing:\nwould leave"
        ax.annotate(says, (q2[k], push), (0, -14), textcoords="offset points", ha="center", va="top", fontsize=9)
    ax.set(xlabel="angle of the shoulder [rad]", ylabel="push [PWM counts]")
    ax.legend(loc="lower left")
    return figure


def ends(pushes, angles, target):
    """Plot where the shoulder ends under constant pushes. Returns: LabFigure."""
    figure, ax = subplots(7.4, 3.4)
    ax.plot(pushes, angles, "o", ms=8, label="after 30 s")
    ax.axhline(target, **SETPOINT, label="wanted")
    ax.set(xlabel="constant push [PWM counts]", ylabel="angle of the shoulder [rad]")
    ax.legend(loc="upper left")
    return figure


class Trembling:
    """A controller that sees angles as the simulated bench shows them: whole steps, and a wobble of one (rms)."""

    unit = "PWM"

    def __init__(self, controller):
        self.controller = controller
        self.one = np.array([0.005, 0.008, 0.005])  # rad, a step of each converter
        self.reset()

    def reset(self):
        """Begin anew with the same trembling; a controller that has a memory forgets."""
        self.random = np.random.default_rng(1)
        if hasattr(self.controller, "reset"):
            self.controller.reset()

    def step(self, t, q, reference):
        """Pass on the angles, shaken, and return the command."""
        seen = self.one * np.round(q / self.one + self.random.normal(size=3))
        return self.controller.step(t, seen, reference)
