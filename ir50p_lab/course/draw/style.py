"""Figures of the book: their axes, and how they are shown."""

import html

import matplotlib
from matplotlib.cm import ScalarMappable

from ir50p_lab.lab_figure import LabFigure, figure_style

# Okabe and Ito (2008): told apart with every common kind of colour blindness. Joints 1, 2, 3 take the first three.
COLOURS = {
    "blue": "#0072B2",
    "orange": "#D55E00",
    "green": "#009E73",
    "purple": "#CC79A7",
    "amber": "#E69F00",
    "sky": "#56B4E9",
    "dark": "#333333",
    "grey": "#999999",
    "light": "#DDDDDD",
}
JOINTS = (COLOURS["blue"], COLOURS["orange"], COLOURS["green"])
JOINT_LABELS = ("joint 1", "joint 2", "joint 3")
SETPOINT = {"color": COLOURS["dark"], "linestyle": "--", "linewidth": 1.2}


def new_figure(width=9.0, height=None, *, rows=1, cols=1, projection=None, sharex=False, width_ratios=None, note=""):
    """Return a new figure in the style of the book, with its axes in `figure.axes` (row by row).

    Dashed lines are for set points (`**SETPOINT`), dots or thin grey for measurements, lines for models.

    Args:
        width, height: inches at 100 dots per inch; the default height fits the rows.
        rows, cols: grid of axes. projection: None (2-D), "3d", or a list with one of these for each of the axes.
        sharex: whether the axes of a column share their x limits. width_ratios: relative widths of the columns.
        note: small words in the lower right corner, below the axes: where the data come from.

    Returns: LabFigure. It belongs to nobody but you: pyplot does not know it, and nothing shows it twice.
    """
    kinds = [projection] * (rows * cols) if projection is None or isinstance(projection, str) else list(projection)
    if height is None:
        height = 5.0 if "3d" in kinds else 1.2 + 2.2 * rows
    with matplotlib.rc_context(figure_style()):
        figure = LabFigure(figsize=(width, height), layout="constrained")
        if "3d" in kinds and None in kinds:
            figure.get_layout_engine().set(wspace=0.14)  # the layout does not see the labels of 3-D axes
        grid = figure.add_gridspec(rows, cols, width_ratios=width_ratios)
        for k, kind in enumerate(kinds):
            above = figure.axes[k % cols] if sharex and k >= cols else None
            ax = figure.add_subplot(grid[divmod(k, cols)], projection=kind, sharex=above)
            if kind == "3d":
                ax.computed_zorder = False  # the views of this book order their parts themselves
                for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
                    axis.set_tick_params(labelsize=8, pad=0)
                    axis.line.set_color("#AAAAAA")
            elif sharex and k + cols < rows * cols:
                ax.tick_params(labelbottom=False)
    if note:
        strip = 0.16 / height
        figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
        x, y = 1.0 - 0.04 / width, 0.03 / height
        figure.text(x, y, note, ha="right", va="bottom", fontsize=7.5, color=COLOURS["grey"], style="italic")
    return figure


def subplots(*size, **options):
    """Return figure and axes of `new_figure`, for unpacking: `figure, left, right = subplots(cols=2)`."""
    figure = new_figure(*size, **options)
    return figure, *figure.axes


def alarm(text):
    """Return a sentence in red as HTML, on a background of its own, so that it can be read in a dark notebook, too."""
    return f'<span style="color: #8E1B0E; background: #FDECEA; padding: 0 4px">{html.escape(text)}</span>'


def origin(recording):
    """Return where a recording comes from, in two words: 'simulated arm', 'the real arm' or 'origin unknown'."""
    if "simulated" not in recording.header:
        return "origin unknown"
    return "simulated arm" if recording.simulated else "the real arm"


def colour_map(ax, x, y, values, norm, label):
    """Colour values (m, n) over an evenly spaced grid x (n,), y (m,). Returns a ring, to be put on one place.

    They are coloured once, and above the axis lines of map and bar: both save time at every redraw under a slider.
    """
    half_x, half_y = (x[1] - x[0]) / 2, (y[1] - y[0]) / 2
    extent = (x[0] - half_x, x[-1] + half_x, y[0] - half_y, y[-1] + half_y)
    colours = ScalarMappable(norm, "cividis_r")
    pixels = colours.to_rgba(values, bytes=True)
    ax.imshow(pixels, origin="lower", extent=extent, aspect="auto", interpolation="nearest", zorder=0.6)
    with matplotlib.rc_context(figure_style()):
        bar = ax.figure.colorbar(colours, ax=ax, label=label)
    bar.solids.set_zorder(0.6)
    ax.grid(False)
    return ax.plot([], [], "o", ms=9, mfc="none", mec=COLOURS["orange"], mew=2.5, zorder=9)[0]
