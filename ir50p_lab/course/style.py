"""One look for all figures of the book: colours, sizes, grid; figures that show themselves without pyplot."""

import io

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imsave

from ir50p_lab.errors import InputError

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
SETPOINT = {"color": COLOURS["dark"], "linestyle": "--", "linewidth": 1.2}

# Only what matplotlib reads when axes are made: what comes later keeps its defaults (titles are centred everywhere).
_STYLE = {
    "axes.prop_cycle": matplotlib.cycler(
        color=[COLOURS[n] for n in ("blue", "orange", "green", "purple", "amber", "sky")]
    ),
    "axes.axisbelow": True,  # data above the grid; also what lets the Painter keep the grid as pixels
    "axes.edgecolor": "#666666",
    "axes.grid": True,
    "axes.labelcolor": COLOURS["dark"],
    "axes.labelsize": 10,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.xmargin": 0.02,
    "axes3d.xaxis.panecolor": (1, 1, 1, 0),
    "axes3d.yaxis.panecolor": (1, 1, 1, 0),
    "axes3d.zaxis.panecolor": (1, 1, 1, 0),
    "figure.dpi": 100,
    "figure.facecolor": "white",
    "grid.color": "#E6E6E6",
    "grid.linewidth": 0.8,
    "xtick.color": "#666666",
    "xtick.labelsize": 9,
    "ytick.color": "#666666",
    "ytick.labelsize": 9,
}


def figure_style():
    """The style as matplotlib parameters, for `matplotlib.rc_context(figure_style())`; changes nothing itself."""
    return dict(_STYLE)


class LabFigure(Figure):
    """A matplotlib Figure that a notebook displays when it is the last line of a cell, with no pyplot behind it."""

    def _repr_png_(self):
        """PNG at twice the pixels (sharp on dense screens), and the size to show it at."""
        width, height = self.bbox.size
        shown_at = self.dpi
        stream = io.BytesIO()
        try:
            self.dpi = 2 * shown_at
            self.canvas.draw()  # once; savefig draws a figure with a layout twice
            imsave(stream, self.canvas.buffer_rgba(), format="png")
        finally:
            self.dpi = shown_at
        return stream.getvalue(), {"width": round(width), "height": round(height)}


def new_figure(width=9.0, height=None, *, rows=1, cols=1, projection=None, sharex=False, width_ratios=None):
    """A new figure in the style of the book, with its axes in `figure.axes` (row by row).

    Dashed lines are for set points (`**SETPOINT`), dots or thin grey for measurements, lines for models.

    Args:
        width, height: inches at 100 dots per inch; the default height fits the rows.
        rows, cols: grid of axes. projection: None (2-D), "3d", or a list with one of these per axes.
        sharex: the axes of a column share their x limits. width_ratios: relative widths of the columns.

    Returns: LabFigure. It belongs to nobody but you: pyplot does not know it, nothing shows it twice.
    """
    if rows < 1 or cols < 1:
        raise InputError(f"rows={rows}, cols={cols}: a figure needs at least one axes")
    kinds = [projection] * (rows * cols) if projection is None or isinstance(projection, str) else list(projection)
    if len(kinds) != rows * cols:
        raise InputError(f"projection lists {len(kinds)} axes, the figure has {rows} x {cols}")
    if height is None:
        height = 5.0 if "3d" in kinds else 1.2 + 2.2 * rows
    with matplotlib.rc_context(_STYLE):
        figure = LabFigure(figsize=(width, height), layout="constrained")
        FigureCanvasAgg(figure)
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
    return figure


def show(figure):
    """Display a figure now, in the middle of a cell; at the end of a cell the figure's name alone does it."""
    from IPython.display import display  # only notebooks have it

    display(figure)
