"""What every figure of the package has: one look, and a picture of itself in a notebook without pyplot."""

import io

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imsave

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

    def __init__(self, *args, **options):
        super().__init__(*args, **options)
        FigureCanvasAgg(self)

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
