"""Figures of notebook 07: friction, found by dragging a joint."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.draw.traces import STAMP
from ir50p_lab.modelling.friction import friction_torque


def friction_figure(friction, speeds, torques):
    """Friction found by dragging joint 1 (dots) on the curve of its law: Figure 1.9.

    Args: friction: Friction; speeds, torques (n,): what was found, rad/s, N m. Returns: LabFigure.
    """
    figure, ax = subplots(8.0, 3.2, note=STAMP)
    v = np.linspace(1e-6, 1.1 * max(speeds), 300)
    ax.plot(v, friction_torque(friction, np.outer(v, [1, 0, 0]))[:, 0], label="(1.115)-(1.117)")
    ax.plot(speeds, torques, "o", color=COLOURS["orange"], label="torque that drags the joint")
    ax.plot([0, 0], [0, friction.fs[0]], color=COLOURS["green"], linewidth=5, label="at rest: any torque up to fs")
    ax.set(ylim=(0, None), xlabel="joint velocity [rad/s]", ylabel="friction torque [N m]")
    ax.set_title("Figure 1.9, found by dragging a joint")
    ax.legend()
    return figure
