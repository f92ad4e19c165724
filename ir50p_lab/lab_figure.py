"""What every figure of the package has: one look, and a picture of itself in a notebook without pyplot."""

from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


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
        from IPython.core.pylabtools import retina_figure

        return retina_figure(self, bbox_inches=None)
