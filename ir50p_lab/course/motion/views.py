"""Figures of simulated runs for notebook 06; each says that nothing in it was measured."""

import numpy as np

from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.draw.traces import STAMP
from ir50p_lab.modelling.friction import friction_torque


def order_figure(steps, errors):
    """Errors against the step on logarithmic axes, with the slope of each line: the order of the method.

    Args: steps (n,) s; errors: {method: errors (n,) rad}. Returns: LabFigure, {method: slope}.
    """
    figure, ax = subplots(8.0, 3.4, note=STAMP)
    slopes = {name: float(np.polyfit(np.log(steps), np.log(error), 1)[0]) for name, error in errors.items()}
    for name, error in errors.items():
        ax.loglog(1000 * np.asarray(steps), error, "o-", label=f"{name}: slope {slopes[name]:.2f}")
    ax.set(xlabel="step h [ms]", ylabel="error of q at the end [rad]")
    ax.set_title("Half the step: half the error, or a sixteenth of it")
    ax.set_xticks(1000 * np.asarray(steps), [f"{1000 * h:.3g}" for h in steps])
    ax.minorticks_off()
    ax.legend()
    return figure, slopes


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


def sinking_figure(arm, q, tips):
    """The arm before and after a run, from the side, and the path of its tip.

    Args: arm: Arm; q (n, 3) rad, a run in one vertical plane; tips (n, 3) m. Returns: LabFigure.
    """
    figure, ax = subplots(5.5, 4.2, note=STAMP)
    for pose, colour, label in ((q[0], "blue", "let go"), (q[-1], "orange", "in the end")):
        SideView(ax, arm, colour=COLOURS[colour], label=label).update(pose, heading=q[0, 0])
    radius = tips[:, :2] @ np.array([np.cos(q[0, 0]), np.sin(q[0, 0])])
    ax.plot(radius, tips[:, 2], color=COLOURS["grey"], linewidth=1)
    height = tips[-1, 2]
    end = "comes to lie on the table" if height < 1e-3 else f"ends {100 * height:.1f} cm above the table"
    ax.set_title(f"Without drive the tip {end}", fontsize=11)
    ax.legend(loc="upper left", fontsize=8, frameon=False)
    return figure


def chatter_figure(naive, stuck):
    """Creep and chatter of the shoulder where sgn() stands for dry friction, beside a step that sticks.

    Args: naive (n, 6): change of q and qd every ms, rad, rad/s; stuck: SimulationResult. Returns: LabFigure.
    """
    figure, *both = subplots(9.0, 3.0, cols=2, note=STAMP)
    for ax, mine, kept in zip(both, (naive[:, 1], naive[:, 4]), (stuck.q - stuck.q[0], stuck.qd), strict=True):
        ax.plot(0.001 * np.arange(len(naive)), mine, color=COLOURS["orange"], label="sgn() in Runge-Kutta")
        ax.plot(stuck.t, kept[:, 1], color=COLOURS["blue"], linewidth=2.5, label="a step that sticks")
        ax.set_xlabel("t [s]")
    both[0].set(xlim=(0, 0.001 * len(naive) - 0.001), title="sgn() creeps...", ylabel="shoulder angle, change [rad]")
    both[1].set(xlim=(0, 0.04), title="...because it chatters", ylabel="shoulder velocity [rad/s]")
    both[0].legend()
    return figure


def turning_points(angle, velocity):
    """Distances |angle| (m,) at which a swing turned or came to rest: where the velocity (n,) changes sign."""
    turned = (velocity[:-1] * velocity[1:] <= 0) & (velocity[:-1] != 0)
    return np.abs(angle[1:][turned])
