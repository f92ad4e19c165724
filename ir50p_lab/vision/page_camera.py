"""The camera of the browser that shows a notebook: the page asks for it, shows it live and sends its pictures here."""

import io
import threading
import time
from pathlib import Path

import anywidget
import numpy as np
import traitlets
from IPython.display import Image, display
from PIL import Image as Picture

from ir50p_lab.errors import CameraError
from ir50p_lab.inputs import vector3
from ir50p_lab.vision.frame import Camera, Frame

_PATIENCE = 3.0  # s: a picture may be so old, and is waited for so long
_WORDS = "Here stood the live picture of a camera; none of it was kept."


class _LivePicture(anywidget.AnyWidget):
    """What the page shows. Pictures come as messages, never as traits: a saved notebook holds none."""

    _esm = Path(__file__).with_suffix(".js")
    size = traitlets.List().tag(sync=True)


class PageCamera(Camera):
    """The camera of the computer that shows the page, live below the cell that opens it.

    The page answers between cells: open the camera in one cell, and read it in the next. size: (width, height) of the
    pictures. `image` is the last picture, (h, w, 3) RGB, or None until one has come.
    """

    name = "the page's camera"

    def __init__(self, *, size=(640, 480)):
        self.size, self.image = tuple(size), None
        self._says, self._functions = "", {}
        self._is_new = False  # whether the last picture has not been read
        self._taken = 0.0  # s, by Python's clock
        self._clocks = np.inf  # s, Python's clock less that of the page, which may be another computer's
        self._arrived = threading.Condition()
        self._thread = None  # in which messages come: one of their own, or that of the cells
        self._live = _LivePicture(size=list(size))
        self._live.on_msg(self._heard)
        data, about = self._live._repr_mimebundle_()
        display(data | {"text/plain": _WORDS, "text/html": f"<p>{_WORDS}</p>"}, metadata=about, raw=True)

    def _heard(self, _, message, buffers):
        """A picture, or a word of the page; every picture is answered, or the page sends no other."""
        if self._thread is None:  # a page that is loaded again waits for its button
            self._live.send({"start": True})
        self._thread = threading.get_ident()
        with self._arrived:
            self._says = message.get("off", "")
            if buffers:
                self.image = np.array(Picture.open(io.BytesIO(buffers[0])))
                self._is_new = True
                at = message["at"] / 1000
                self._clocks = min(self._clocks, time.time() - at)
                self._taken = at + self._clocks
            self._arrived.notify_all()
        if buffers:
            self._live.send(self._answer(self.image))

    def _answer(self, rgb):
        circles, says = [], []
        for name, function in self._functions.items():
            try:
                found = function(rgb.copy())
                if found is not None:
                    circles.append([name, *vector3(f"the circle of {name}", found, unit="px")])
            except Exception as error:  # of the student's function: said below the picture
                says.append(f"{name}: {type(error).__name__}: {error}")
        return {"circles": circles, "says": "; ".join(says)}

    def each(self, **functions):
        """Give every picture to functions, by name: f(rgb) -> (x, y, radius) px, or None.

        Their circles are drawn, with the names, on the picture that was searched. A call without functions ends this.
        They run while other cells run: they must draw no plots.
        """
        self._functions = functions

    def read(self):
        """Return a Frame newer than the last one. Raises CameraError, with what to do, if none comes."""
        if self._thread is None:
            raise CameraError("the page answers between cells: read it in the next cell, when its picture is there")
        asked = time.time()
        with self._arrived:
            if self._thread != threading.get_ident():
                self._arrived.wait_for(lambda: self._taken > asked or self._says, _PATIENCE)
        if self._says or not self._is_new or self._taken < asked - _PATIENCE:
            raise CameraError(self._says or "no new picture: if the camera is on (its button), run this cell again")
        self._is_new = False
        return Frame(image=self.image, simulated=False, source=self.name)

    def keep(self):
        """Show the last picture here, so that the notebook keeps it. Raises CameraError if there is none."""
        if self.image is None:
            raise CameraError("there is no picture to keep: keep one in a later cell, when the camera shows something")
        Picture.fromarray(self.image).save(file := io.BytesIO(), "png")
        display(Image(file.getvalue(), alt=f"A picture of {self.name}"))

    def close(self):
        """Switch the camera off; none of its pictures stays."""
        self.each()
        self._live.send({"start": False})
