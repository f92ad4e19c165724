"""A picture to look at and to click."""

import base64
import html

import ipywidgets as widgets
import numpy as np
import traitlets
from PIL import Image, ImageDraw

from ir50p_lab.course.draw.canvas import Canvas
from ir50p_lab.course.draw.painter import DRAWING, encode_png
from ir50p_lab.course.draw.pictures import STAMP
from ir50p_lab.course.draw.widgets import hear
from ir50p_lab.errors import InputError


class PictureView(widgets.VBox):
    """A picture, shown if it is the last line of a cell; a line under it holds what a click has said.

    Args:
        picture: (h, w, 3) bytes, red green blue, or (h, w) bool, a mask.
        on_click: f(x, y), called with the pixel that was clicked, column and row. It may print or return a text, which
            appears under the picture, and so does its error.
        alt: what the picture shows, for those who cannot see it. source: where it comes from, in words.

    Attributes: picture, and circles, (x, y, radius, colour) each, px: setting one of them shows it; canvas; status.
    Raises InputError for what is not a picture.
    """

    picture = traitlets.TraitType()
    circles = traitlets.List()

    def __init__(self, picture, on_click=None, alt="A picture", source=STAMP, circles=()):
        self._on_click = on_click
        self.canvas = Canvas(description=alt)
        self.status = widgets.HTML(html.escape(source), layout={"min_height": "1.5em"})
        super().__init__([self.canvas, self.status])
        self.picture, self.circles = picture, list(circles)
        if on_click is not None:
            self.canvas.on_click(self._clicked)

    @traitlets.validate("picture")
    def _bytes(self, proposal):
        picture = np.asarray(proposal["value"])
        if picture.shape[2:] == () and picture.dtype == bool:
            picture = np.repeat(255 * picture[..., None].astype(np.uint8), 3, axis=2)
        if picture.ndim != 3 or picture.shape[2] != 3 or picture.dtype != np.uint8 or picture.size == 0:
            raise InputError(
                f"the picture holds {picture.dtype} numbers of shape {picture.shape}: give bytes (h, w, 3), red green "
                "blue, or a mask (h, w) of True and False"
            )
        return picture

    @traitlets.observe("picture", "circles")
    def _show(self, _):
        shown = Image.fromarray(self.picture)
        pen = ImageDraw.Draw(shown)
        for x, y, radius, colour in self.circles:
            pen.ellipse((x - radius, y - radius, x + radius, y + radius), outline=colour, width=3)
        width = f"{self.picture.shape[1]}px"
        self.canvas.layout = {"width": width, "max_width": "100%", "border": "1px solid #999999"}
        self.canvas.value = encode_png(np.asarray(shown))

    def _clicked(self, right, up):
        """Hand the pixel under the click on; `right` and `up` are fractions of the picture."""
        h, w = self.picture.shape[:2]
        x, y = min(int(right * w), w - 1), min(int((1 - up) * h), h - 1)
        with DRAWING:
            self.status.value, _ = hear(lambda: self._on_click(max(x, 0), max(y, 0)))

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without widgets (an exported page)."""
        data = super()._repr_mimebundle_(**kwargs)
        picture = base64.b64encode(self.canvas.value).decode("ascii")
        return data | {"image/png": picture}, {"image/png": {"alt": self.canvas.description}}
