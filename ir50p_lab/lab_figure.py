"""What every figure of the package has: one look, and a picture of itself in a notebook without pyplot."""

import io
from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

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


def figure_style():
    """The style as matplotlib parameters, for `matplotlib.rc_context(figure_style())`; changes nothing itself."""
    return dict(matplotlib.rc_params_from_file(Path(__file__).with_suffix(".mplstyle"), use_default_template=False))


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
            self.canvas.print_png(stream)  # draws it once; savefig draws a figure with a layout twice
        finally:
            self.dpi = shown_at
        return stream.getvalue(), {"width": round(width), "height": round(height)}
