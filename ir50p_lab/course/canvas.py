"""One canvas for what lives in the browser: a picture that hears clicks, and plots of samples that come as float32.

The kernel sends all samples with every frame: a browser that comes late, or leaves frames out, is right again with the
next one. Drawing takes a loop at the bench no time.
"""

from pathlib import Path

import anywidget
import traitlets

__all__ = ["Canvas"]


class Canvas(anywidget.AnyWidget):
    """A picture, or plots, in the browser.

    value: PNG file (bytes); width: CSS width, such as "900px"; description: what screen readers say; clicked:
    [right, up, time] of the last click, as fractions 0..1 of the picture from its lower left corner; ratio: pixels of
    the display per CSS pixel, 1 to 2. samples: float32 rows, time first, for the plots that `settings` describes;
    marks: s, where each plot has a dotted line.
    """

    _esm = Path(__file__).with_suffix(".js")
    value = traitlets.Bytes(b"").tag(sync=True)
    width = traitlets.Unicode("auto").tag(sync=True)
    description = traitlets.Unicode("").tag(sync=True)
    clickable = traitlets.Bool(False).tag(sync=True)
    clicked = traitlets.List().tag(sync=True)
    ratio = traitlets.Float(1.0).tag(sync=True)
    samples = traitlets.Bytes(b"").tag(sync=True)
    marks = traitlets.List().tag(sync=True)
    settings = traitlets.Dict().tag(sync=True)

    def on_click(self, function):
        """Call `function(right, up)` for every click from now on."""
        self.clickable = True
        self.observe(lambda change: function(float(change["new"][0]), float(change["new"][1])), "clicked")
