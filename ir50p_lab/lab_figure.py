"""What every figure of the package has: one look, and a picture of itself in a notebook without pyplot."""

import base64
import html
from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


def figure_style():
    """Return the style as matplotlib parameters, for `matplotlib.rc_context(figure_style())`; change nothing."""
    return dict(matplotlib.rc_params_from_file(Path(__file__).with_suffix(".mplstyle"), use_default_template=False))


class LabFigure(Figure):
    """A matplotlib Figure that a notebook shows if it is the last line of a cell, with no pyplot behind it."""

    def __init__(self, *args, **options):
        super().__init__(*args, **options)
        FigureCanvasAgg(self)

    def describe(self):
        """Return what is seen, in words, for those who cannot see it: titles, axes, names of curves."""
        said = [self.get_suptitle()]
        for ax in self.axes:
            axes = [getattr(ax, f"get_{axis}label", str)() for axis in "xyz"]
            curves = [text.get_text() for text in (*getattr(ax.get_legend(), "texts", ()), *ax.texts)]
            said += [ax.get_title(), " against ".join(filter(None, axes[::-1])), ", ".join(filter(None, curves))]
        words = [" ".join(one.replace("$", "").split()) for one in said]
        return ". ".join(dict.fromkeys(filter(None, words))) or "a figure without words"

    def _repr_png_(self):
        """PNG at twice the pixels (sharp on dense screens); the size to show it at, and what it shows in words."""
        from IPython.core.pylabtools import retina_figure

        png, size = retina_figure(self, bbox_inches=None)
        return png, size | {"alt": self.describe()}

    def _repr_mimebundle_(self, **kwargs):
        """The PNG, and as HTML: JupyterLab passes over the words beside a PNG."""
        png, about = self._repr_png_()
        data = base64.b64encode(png).decode("ascii")
        words = html.escape(about["alt"])
        image = f'<img src="data:image/png;base64,{data}" width="{about["width"]}" alt="{words}">'
        return {"image/png": data, "text/html": image}, {"image/png": about}
