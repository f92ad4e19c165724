"""Curves over one common time axis, drawn once or again as a slider moves."""

from dataclasses import dataclass

from ir50p_lab.course.draw.style import SETPOINT, subplots

STAMP = "simulated, not measured"


@dataclass(frozen=True)
class Row:
    """One of the axes of `Traces`.

    ylabel: with unit; ylim: (low, high); curves: their names for the legend ("": not in it);
    levels: heights of dashed lines, in the colours of the curves if there is one for each of several curves;
    style: matplotlib's format string, one for all curves or one for each.
    """

    ylabel: str
    ylim: tuple
    curves: tuple = ("",)
    levels: tuple = ()
    style: str | tuple = "-"


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
                ax.legend(loc="upper right", ncols=sum(map(bool, row.curves)), fontsize=9)
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

    def title(self, text):
        """What is seen, above the first row."""
        self.axes[0].set_title(text)


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
