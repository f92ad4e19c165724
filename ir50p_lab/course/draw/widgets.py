"""Live figures: sliders under which a persistent matplotlib figure answers at once.

    figure = new_figure(rows=1)
    curve, = figure.axes[0].plot(t, t)
    def update(kp, kd):
        curve.set_ydata(response(kp, kd))
    live(figure, update, kp=(0, 300, 1, 100), kd=slider(0, 60, 0.5, 10, label="Kd1", unit="N m s"))

The figure is made once and `update` changes its artists in place; it never calls pyplot. What `update` prints, its
errors, and warnings appear in a line under the figure (a notebook would swallow them, or heap them up).
"""

import base64
import contextlib
import html
import io
import time
import traceback
import warnings
import weakref
from pathlib import Path
from typing import ClassVar

import ipywidgets as widgets

from ir50p_lab.course.draw.canvas import Canvas
from ir50p_lab.course.draw.controls import Slider, close_all, make_control, refuse_bad_value, slider, value_of
from ir50p_lab.course.draw.painter import DRAWING, Painter
from ir50p_lab.course.draw.style import alarm
from ir50p_lab.errors import InputError, UnstableLoopWarning

__all__ = ["LivePanel", "Slider", "live", "slider"]


def live(figure, update, **controls):
    """Show `figure` with sliders; each change calls `update(**values)` and redraws.

    Args:
        figure: LabFigure, from `new_figure`.
        update: changes artists in place (`line.set_data(...)`); gets every control by its name. It may print or
            return a text, which appears in the line under the figure. If the text takes time, return a function
            that returns it: it is called once the picture is on its way.
        controls: at least one; name=(min, max, step, start) or name=slider(...), name=[choices] or {label: choice}
            for a menu.

    Returns: LivePanel, shown if it is the last line of a cell.
    Raises InputError for a control that makes no sense, and whatever the first `update` raises.
    """
    return LivePanel(figure, update, controls)


class LivePanel(widgets.VBox):
    """A figure, its sliders with number boxes, a reset button and a status line; see `live`.

    Attributes: figure; image, the Canvas that shows it; status, its text line; controls, name -> widget;
    error, the exception of the last update or None; drawn, the values last drawn; updates, how many were drawn.
    `LivePanel.panels` holds the panels that are alive.
    """

    panels: ClassVar = weakref.WeakSet()

    def __init__(self, figure, update, controls):
        if not controls:
            raise InputError("live(figure, update, ...) needs at least one control, such as kp=(0, 10, 0.1, 1)")
        self.figure, self.error, self.drawn, self.updates = figure, None, None, 0
        self._update, self._painter = update, None
        self._stale = self._busy = False
        self.controls, rows = {}, []
        width = max(len(getattr(spec, "label", None) or name) for name, spec in controls.items()) + 2
        for name, spec in controls.items():
            self.controls[name], row = make_control(name, spec, f"{width}ch", self._changed)
            rows.append(row)
        self._start = self.values
        wide = f"{figure.bbox.width:.0f}px"
        self.image = Canvas(layout={"width": wide, "max_width": "100%"})
        self.status = widgets.HTML(layout={"min_height": "1.5em", "width": wide})
        self._changed()
        if self.error is not None:
            raise self.error  # in the cell, where it belongs
        reset = widgets.Button(description="Reset", layout={"width": "80px"})
        reset.on_click(lambda _: self.reset())
        grid = {"grid_template_columns": "max-content " * (1 if len(rows) <= 3 else 2), "grid_gap": "0 24px"}
        super().__init__([widgets.GridBox([*rows, reset], layout=grid), self.image, self.status])
        self.image.observe(self._sharpen, "ratio")
        self._close_those_of_earlier_runs()
        LivePanel.panels.add(self)

    @property
    def values(self):
        """The present values of the controls: name -> value."""
        return {name: value_of(control) for name, control in self.controls.items()}

    def set(self, **values):
        """Move controls from Python and redraw once.

        Raises InputError for an unknown name or a value off the scale, and whatever `update` raises.
        """
        for name, value in values.items():
            refuse_bad_value(name, value, self.controls)
        with DRAWING:
            busy, self._busy = self._busy, True  # one drawing for all of them
            try:
                for name, value in values.items():
                    self.controls[name].value = value
            finally:
                self._busy = busy
            self._changed()
        if self.error is not None:
            raise self.error

    def reset(self):
        """Put every control back to its start."""
        with contextlib.suppress(Exception):  # it is in the status line
            self.set(**self._start)

    def _sharpen(self, change):
        """As many pixels as the display has."""
        with DRAWING:
            self.figure.set_dpi(self.figure.get_dpi() * change["new"] / change["old"])
        self._changed()

    def _changed(self):
        """Draw the latest values, unless another thread has just drawn them; what `update` moves is drawn after it."""
        self._stale = True
        with DRAWING:
            while self._stale and not self._busy:
                self._stale, self._busy = False, True
                try:
                    self._draw()
                finally:
                    self._busy = False

    def _draw(self):
        self.drawn = self.values
        self.status.value, self.error = hear(self._update_and_show)
        self.updates += 1

    def _update_and_show(self):
        words = self._update(**self.drawn)
        self._show()
        return words() if callable(words) else words

    def _show(self):
        if self._painter is None:
            for ax in self.figure.axes:  # what stands still, below what moves: above it, it is drawn each time
                for words in (ax.title, *(() if hasattr(ax, "get_proj") else ax.texts)):  # in space depth decides
                    words.set_zorder(min(words.get_zorder(), 1.9))  # lines: 2, a grid at most 1.5
                for frame in filter(None, (ax.get_legend(), *ax.spines.values())):
                    frame.set_zorder(min(frame.get_zorder(), 1.8))  # below a title that changes
            self._painter = Painter(self.figure)
        self.image.description = self.figure.describe()
        self.image.value = self._painter.png()
        time.sleep(0.001)  # the thread that sends it takes its turn now, not after Python's usual 5 ms

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without widgets (an exported page)."""
        return super()._repr_mimebundle_(**kwargs) | {"image/png": base64.b64encode(self.image.value).decode("ascii")}

    def _close_those_of_earlier_runs(self):
        """A cell that is run again replaces its panels; the old ones would keep their figures for ever."""
        try:
            message = get_ipython().get_parent()
            self._run = message["metadata"]["cellId"], message["header"]["msg_id"]
        except (NameError, AttributeError, KeyError, TypeError):  # not in a notebook, or a front end without cell ids
            self._run = None, None
        for old in list(LivePanel.panels):
            if old._run[0] and old._run[0] == self._run[0] and old._run != self._run:
                LivePanel.panels.discard(old)
                close_all(old)


def hear(do):
    """Return as HTML what `do()` prints, returns as a text, warns of and stops with; and its error or None."""
    said, stopped = io.StringIO(), None
    with contextlib.redirect_stdout(said), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UnstableLoopWarning)
        try:
            words = do()
            if isinstance(words, str):
                print(words)
        except Exception as error:
            stopped = error
    for text in dict.fromkeys(str(warning.message) for warning in caught):
        print(text, file=said)
    text = html.escape(said.getvalue().rstrip()).replace("\n", "<br>")
    return text + ("" if stopped is None else alarm(explain(stopped))), stopped


def explain(error):
    """Return the error in one line, with the line of the caller's function from which it came."""
    ours = str(Path(__file__).parent)
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if not frame.filename.startswith(ours)]
    where = f" (line {frames[0].lineno} in {frames[0].name})" if frames else ""
    return f"{type(error).__name__}: {error}{where}"
