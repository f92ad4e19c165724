"""A picture to look at and to click."""

import base64
import contextlib
import html
import io

import ipywidgets as widgets
import numpy as np
from PIL import Image, ImageDraw

from ir50p_lab.course.draw.canvas import Canvas
from ir50p_lab.course.draw.painter import DRAWING, encode_png
from ir50p_lab.course.draw.pictures import STAMP
from ir50p_lab.course.draw.style import alarm
from ir50p_lab.course.draw.widgets import explain
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

    def __init__(self, picture, on_click=None, alt="A picture", source=STAMP, circles=()):
        self._on_click, self._circles = on_click, list(circles)
        self.canvas = Canvas(description=alt)
        self.status = widgets.HTML(html.escape(source), layout={"min_height": "1.5em"})
        super().__init__([self.canvas, self.status])
        self.picture = picture
        if on_click is not None:
            self.canvas.on_click(self._clicked)

    @property
    def picture(self):
        """The picture that is shown; set it to show another."""
        return self._picture

    @picture.setter
    def picture(self, picture):
        picture = np.asarray(picture)
        if picture.shape[2:] == () and picture.dtype == bool:
            picture = np.repeat(255 * picture[..., None].astype(np.uint8), 3, axis=2)
        if picture.ndim != 3 or picture.shape[2] != 3 or picture.dtype != np.uint8 or picture.size == 0:
            raise InputError(
                f"the picture holds {picture.dtype} numbers of shape {picture.shape}: give bytes (h, w, 3), red green "
                "blue, or a mask (h, w) of True and False"
            )
        self._picture = picture
        self._show()

    @property
    def circles(self):
        """The circles that are drawn over the picture: (x, y, radius, colour) each, px."""
        return self._circles

    @circles.setter
    def circles(self, circles):
        self._circles = list(circles)
        self._show()

    def _show(self):
        shown = Image.fromarray(self._picture)
        pen = ImageDraw.Draw(shown)
        for x, y, radius, colour in self._circles:
            pen.ellipse((x - radius, y - radius, x + radius, y + radius), outline=colour, width=3)
        width = f"{self._picture.shape[1]}px"
        self.canvas.layout = {"width": width, "max_width": "100%", "border": "1px solid #999999"}
        self.canvas.value = encode_png(np.asarray(shown))

    def _clicked(self, right, up):
        """Hand the pixel under the click on; `right` and `up` are fractions of the picture."""
        h, w = self._picture.shape[:2]
        x, y = min(int(right * w), w - 1), min(int((1 - up) * h), h - 1)
        said, wrong = io.StringIO(), ""
        with DRAWING, contextlib.redirect_stdout(said):
            try:
                words = self._on_click(max(x, 0), max(y, 0))
                if isinstance(words, str):
                    print(words)
            except Exception as error:
                wrong = alarm(explain(error))
        self.status.value = html.escape(said.getvalue().rstrip()).replace("\n", "<br>") + wrong

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without widgets (an exported page)."""
        data = super()._repr_mimebundle_(**kwargs)
        picture = base64.b64encode(self.canvas.value).decode("ascii")
        return data | {"image/png": picture}, {"image/png": {"alt": self.canvas.description}}
