"""Live figures: sliders under which a persistent matplotlib figure answers at once.

    figure = new_figure(rows=1)
    curve, = figure.axes[0].plot(t, t)
    def update(kp, kd):
        curve.set_ydata(response(kp, kd))
    live(figure, update, kp=(0, 300, 1, 100), kd=slider(0, 60, 0.5, 10, label="Kd1", unit="N m s"))

The figure is made once and `update` changes its artists in place; it never calls pyplot. What `update` prints, its
errors, and the warning of a loop that looks unstable appear in a line under the figure (a notebook would swallow
them, or heap them up).
"""

import base64
import contextlib
import html
import io
import threading
import time
import traceback
import warnings
import weakref
from typing import ClassVar

import ipywidgets as widgets

from ir50p_lab.course.canvas import Canvas
from ir50p_lab.course.controls import Slider, close_all, label_of, make_control, refuse_bad_value, slider, value_of
from ir50p_lab.course.painter import DRAWING, Painter
from ir50p_lab.errors import InputError, UnstableLoopWarning

__all__ = ["LivePanel", "Slider", "live", "slider"]


def live(figure, update, **controls):
    """Show `figure` with sliders; each change calls `update(**values)` and redraws.

    Args:
        figure: a matplotlib Figure, best from `figures.new_figure`; not one of pyplot.
        update: changes artists in place (`line.set_data(...)`); gets every control by its name. May print or
            return a text: it appears in the line under the figure. If the text takes time, return a function
            that returns it: it is called once the picture is on its way.
        controls: name=(min, max, step, start) or name=slider(...), name=[choices] or {label: choice} for a
            menu, name=True/False for a checkbox.

    Returns: LivePanel, shown when it is the last line of a cell.
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
        self.controls, rows = {}, []
        width = max(len(label) for label in (label_of(name, spec) for name, spec in controls.items())) + 2
        for name, spec in controls.items():
            self.controls[name], row = make_control(name, spec, f"{width}ch", self._changed)
            rows.append(row)
        self._start = self.values
        self._update, self._warned = update, set()
        self._drawing, self._drawer, self._wanted = threading.Lock(), None, None
        self._quiet = threading.local()

        said = io.StringIO()
        with DRAWING:
            words = self._call(said, update, **self._start)  # directly: an error belongs in the cell
            self._call(said, words)
            _words_below_curves(figure)
            self._painter = Painter(figure)
            pixels = round(figure.bbox.width)
            self.image = Canvas(value=self._painter.png(), width=f"{pixels}px")
        self.drawn, self.updates = self._start, 1
        self.status = widgets.HTML(_as_html(said), layout=widgets.Layout(min_height="1.5em", width=f"{pixels}px"))
        reset = widgets.Button(description="Reset", layout=widgets.Layout(width="80px"))
        reset.on_click(lambda _: self.reset())
        columns = 1 if len(rows) <= 3 else 2
        grid = widgets.Layout(grid_template_columns="max-content " * columns, grid_gap="0 24px")
        super().__init__([widgets.GridBox([*rows, reset], layout=grid), self.image, self.status])
        self.image.observe(self._sharpen, "ratio")
        _close_panels_of_earlier_runs(self)
        LivePanel.panels.add(self)

    @property
    def values(self):
        """What the controls say now: name -> value."""
        return {name: value_of(control) for name, control in self.controls.items()}

    def set(self, **values):
        """Move controls from Python, redraw once, and raise what `update` raises.

        Raises InputError for an unknown name or a value off the scale.
        """
        for name, value in values.items():
            refuse_bad_value(name, value, self.controls)
        self._quiet.on = True
        try:
            for name, value in values.items():
                self.controls[name].value = value
        finally:
            self._quiet.on = False
        self._draw_latest(wait=self._drawer != threading.get_ident())
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
        self.redraw()

    def redraw(self):
        """Draw everything anew, background included."""
        with DRAWING:
            self._painter.forget()
            self._draw(self.values)

    def _changed(self):
        if not getattr(self._quiet, "on", False):
            self._draw_latest(wait=False)

    def _draw_latest(self, wait):
        """Draw the latest values. If a drawing is under way, its thread draws them next: there is no queue."""
        self._wanted = self.values
        while (wait or self._wanted is not None) and self._drawing.acquire(blocking=wait):
            wait = False
            try:
                self._drawer = threading.get_ident()
                values, self._wanted = self._wanted, None
                if values is not None:
                    self._draw(values)
            finally:
                self._drawer = None
                self._drawing.release()

    def _call(self, said, function, /, **values):
        """Call `function`, if it is one, and return its answer.

        What it prints, an answer that is a text, and the warning of an unstable loop go into `said`.
        """
        with contextlib.redirect_stdout(said), warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UnstableLoopWarning)
            answer = function(**values) if callable(function) else None
            if isinstance(answer, str):
                print(answer)
        for text in dict.fromkeys(str(w.message) for w in caught if issubclass(w.category, UnstableLoopWarning)):
            print(text, file=said)
        for w in caught:  # the others go where warnings go, each once
            place = (str(w.message), w.category, w.filename, w.lineno)
            if not issubclass(w.category, UnstableLoopWarning) and place not in self._warned:
                self._warned.add(place)
                warnings.warn_explicit(w.message, w.category, w.filename, w.lineno)
        return answer

    def _draw(self, values):
        said = io.StringIO()
        with DRAWING:
            try:
                words = self._call(said, self._update, **values)
                self.image.value = self._painter.png()
                time.sleep(0.001)  # the thread that sends it takes its turn now, not after Python's usual 5 ms
                self._call(said, words)
                self.error = None
            except Exception as error:
                self.error = error
        self.drawn, self.updates = values, self.updates + 1
        text = _as_html(said)
        if self.error is not None:
            text += f'<span style="color:#c0392b">{html.escape(_explain(self.error))}</span>'
        if text != self.status.value:
            self.status.value = text

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without widgets (an exported page)."""
        bundle = super()._repr_mimebundle_(**kwargs)
        data = bundle[0] if isinstance(bundle, tuple) else bundle
        if data is not None:
            data["image/png"] = base64.b64encode(self.image.value).decode("ascii")
        return bundle


def _words_below_curves(figure):
    """Titles and legends below what moves: drawn each time, they would cost as much as all curves."""
    for ax in figure.axes:
        for words in filter(None, (ax.title, ax.get_legend())):
            words.set_zorder(min(words.get_zorder(), 1.9))  # lines: 2, a grid at most 1.5


def _as_html(said):
    """What was said, for the status line."""
    return html.escape(said.getvalue().rstrip()).replace("\n", "<br>")


def _explain(error):
    """The error in one line, with the line of `update` it came from."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename != __file__]
    where = f" (line {frames[0].lineno} in {frames[0].name})" if frames else ""
    return f"{type(error).__name__}: {error}{where}"


def _close_panels_of_earlier_runs(panel):
    """A cell that is run again replaces its panels; the old ones would keep their figures for ever."""
    try:
        message = get_ipython().get_parent()
        panel._run = (message["metadata"]["cellId"], message["header"]["msg_id"])
    except (NameError, AttributeError, KeyError, TypeError):  # not in a notebook, or a front end without cell ids
        panel._run = None
        return
    cell, run = panel._run
    for old in list(LivePanel.panels):
        if old._run and old._run[0] == cell and old._run[1] != run:
            LivePanel.panels.discard(old)
            close_all(old)
