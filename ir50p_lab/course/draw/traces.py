"""Curves over time, drawn once or again as a slider moves: over one common axis, or in a column per joint."""

from dataclasses import dataclass
from itertools import chain

from ir50p_lab.course.draw.style import SETPOINT, joint_columns, subplots

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


class JointPlots:
    """Angles above, commands below, one column per joint. `update(run, ...)` draws simulation results.

    Args: target: (3,) rad, drawn dashed; duration: s; unit: of the command; u_max: the command axis ends there;
    labels: one for each run that will be drawn (a legend if there are several). Runs begin at 0 rad.

    Attributes: figure (LabFigure), to be shown itself or with `live`.
    """

    def __init__(self, target, *, duration, unit, u_max, labels=("",)):
        ranges = [sorted((0.0, angle)) for angle in target]
        self.figure, self._q, self._u = joint_columns(duration, ranges, 1.08 * u_max, labels=labels, room=(0.25, 0.2))
        for ax, angle in zip(self.figure.axes[:3], target, strict=True):
            ax.axhline(angle, zorder=1.9, **SETPOINT)  # below what moves
        for curve in chain(*self._u):
            curve.set_drawstyle("steps-post")
        self.figure.axes[3].set_ylabel(f"command [{unit}]")
        self._titles = [ax.set_title("", fontsize=10) for ax in self.figure.axes[:3]]

    def update(self, *runs, titles=("joint 1", "joint 2", "joint 3")):
        """Draw one SimulationResult per label. Returns the figure.

        Long titles cost a slider more time than all curves together: there, words belong in the status line.
        """
        for joint, title in enumerate(titles):
            self._titles[joint].set_text(title)
            for run, q, u in zip(runs, self._q[joint], self._u[joint], strict=True):
                q.set_data(run.t, run.q[:, joint])
                u.set_data(run.t, run.u[:, joint])
        return self.figure


def curves(t, lines, labels, ylabel, targets=()):
    """Lines (k, n) over time (n,) s, each with its label; targets: dashed levels. LabFigure."""
    figure, ax = subplots(8.6, 3.2)
    for target in targets:
        ax.axhline(target, **SETPOINT)
    for values, label in zip(lines, labels, strict=True):
        ax.plot(t, values, label=label, alpha=0.35 if label == "raw" else 1)
    ax.set(xlabel="time [s]", ylabel=ylabel)
    ax.legend()
    return figure
