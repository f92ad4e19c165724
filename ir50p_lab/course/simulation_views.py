"""Figures of simulated runs for notebook 06; each says that nothing in it was measured."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.course.arm3d import SideView
from ir50p_lab.course.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.friction import friction_torque

STAMP = "simulated, not measured"


@dataclass(frozen=True)
class Row:
    """One of the axes of `Traces`.

    ylabel: with unit; ylim: (low, high); curves: their names for the legend ("": not in it);
    levels: heights of dashed lines, in the colours of the curves if there is one for each of several curves;
    style: matplotlib's format string, one for all curves or one for each; legend: its place.
    """

    ylabel: str
    ylim: tuple
    curves: tuple = ("",)
    levels: tuple = ()
    style: str | tuple = "-"
    legend: str = "upper right"


class Traces:
    """Curves over one common axis with fixed limits, so that moving a slider moves the curves only.

    Titles and legends are drawn at every move, about 0.15 ms a letter: keep them short.

    Args: xlabel: with unit; xlim: (low, high); rows: Row, from top to bottom; title: above the first; note: after the
    xlabel, "" for curves of a law, which no simulation had a part in.
    Attributes: figure; axes, one per row; lines, all curves in order, row by row.
    """

    def __init__(self, xlabel, xlim, *rows, title="", note=STAMP):
        height = 1.4 + (2.0 if len(rows) == 1 else 1.5 * len(rows))
        self.figure, *self.axes = subplots(9.0, height, rows=len(rows), sharex=True)
        self.lines = []
        for ax, row in zip(self.axes, rows, strict=True):
            styles = (row.style,) * len(row.curves) if isinstance(row.style, str) else row.style
            for name, style in zip(row.curves, styles, strict=True):
                self.lines += ax.plot([], [], style, markersize=3, label=name)
            colours = [line.get_color() for line in ax.lines]
            if len(row.levels) != len(colours) or len(colours) == 1:
                colours = [SETPOINT["color"]] * len(row.levels)
            for level, colour in zip(row.levels, colours, strict=True):
                ax.axhline(level, **SETPOINT | {"color": colour})
            ax.set(xlim=xlim, ylim=row.ylim, ylabel=row.ylabel)
            if any(row.curves):
                ax.legend(loc=row.legend, ncols=sum(map(bool, row.curves)), fontsize=9)
        # as part of the axis label the note costs a panel nothing; a text of its own is drawn anew each time
        self.axes[-1].set_xlabel(f"{xlabel}  -  {note}" if note else xlabel)
        self.title(title)

    def update(self, x, *ys):
        """Give all curves new points: x (n,), and one y (n,) per curve, in their order.

        Of more than two points a pixel every second, third... is drawn: noisy curves cost time by the point.
        """
        every = max(1, len(x) // 1500)
        for line, y in zip(self.lines, ys, strict=True):
            line.set_data(x[::every], y[::every])

    def clear(self):
        """Empty all curves."""
        for line in self.lines:
            line.set_data([], [])

    def title(self, text):
        """What is seen, above the first row."""
        self.axes[0].set_title(text)


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
