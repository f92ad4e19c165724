"""A picture in the browser that hears clicks."""

from pathlib import Path

import anywidget
import traitlets


class Canvas(anywidget.AnyWidget):
    """A picture that hears clicks; `layout` says how wide it is shown.

    value: PNG file (bytes); description: what screen readers say; ratio: pixels of the display per CSS pixel, 1 to 2.
    """

    _esm = Path(__file__).with_suffix(".js")
    value = traitlets.Bytes().tag(sync=True)
    description = traitlets.Unicode().tag(sync=True)
    clickable = traitlets.Bool().tag(sync=True)
    ratio = traitlets.Float(1.0).tag(sync=True)

    def on_click(self, function):
        """Call `function(right, up)` for every click from now on: fractions of the picture from its lower left."""
        self.clickable = True
        self.on_msg(lambda _, place, __: function(place["right"], place["up"]))
