"""Fast redrawing of a LabFigure: what stands still is drawn once, what moves each time (blitting)."""

import io
import threading

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.spines import Spine
from matplotlib.text import Text
from PIL import Image

# Widget callbacks may run in threads beside the cell's; matplotlib is shared by all of them.
DRAWING = threading.RLock()


class Painter:
    """Draws `figure` again and again in a fraction of the usual time, by matplotlib's blitting.

    An artist that has changed once is assumed to move: it becomes `animated`, and so does everything that lies above
    it in its axes. If a grid lies above it, nothing does, and everything is drawn each time. The rest, ticks and grid
    included, is kept as pixels and drawn anew only if matplotlib says that it is stale (a new text in a legend makes
    it so each time). When a 3-D view is turned, matplotlib does not say so: set `axes.stale`. The layout is computed
    once and then held, so that nothing jumps.

    Attributes: backgrounds: how often the background was drawn (for tests and measurements).
    """

    def __init__(self, figure):
        self.figure = figure
        self.backgrounds = 0
        figure.canvas.draw()  # runs the layout engine
        figure.set_layout_engine("none")
        self._background = self._empty = None

    def rgba(self):
        """Return the figure as it is now, (height, width, 4) uint8, valid until the next call."""
        figure, canvas = self.figure, self.figure.canvas
        groups = [_parts(one) for one in (*sorted(figure.axes, key=lambda ax: ax.get_zorder()), figure)]
        empty = sum(_is_empty(artist) for parts in groups for artist in parts)
        if self._background is None or figure.stale or empty != self._empty:
            self._empty = empty
            for parts in groups:
                _animate(parts)
            canvas.draw()
            self._background = canvas.copy_from_bbox(figure.bbox)
            self._titles = [(ax.title, ax.title.get_position()[1]) for ax in figure.axes]
            self.backgrounds += 1
        else:
            canvas.restore_region(self._background)
            for title, height in self._titles:
                if title.get_position()[1] != height:  # set_title has dropped it to the frame
                    title.set_y(height)
        for parts in groups:
            for artist in parts:
                if artist.get_animated() and artist.get_visible():
                    if hasattr(artist, "do_3d_projection"):
                        artist.do_3d_projection()
                    figure.draw_artist(artist)
        figure.stale = False  # a legend calls itself stale while it is drawn
        return np.asarray(canvas.buffer_rgba())

    def png(self):
        """Return the figure as it is now, as the bytes of a PNG file."""
        return encode_png(self.rgba())


def encode_png(image):
    """Return an image (height, width, 3 or 4) uint8 as a PNG file without opacity, much faster than by Pillow."""
    try:
        import cv2
    except ImportError:  # in a browser tab
        file = io.BytesIO()
        Image.fromarray(np.ascontiguousarray(image[..., :3])).save(file, "PNG", compress_level=1)
        return file.getvalue()
    to_bgr = cv2.COLOR_RGBA2BGR if image.shape[2] == 4 else cv2.COLOR_RGB2BGR
    options = (cv2.IMWRITE_PNG_COMPRESSION, 1, cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_DEFAULT)
    options += (cv2.IMWRITE_PNG_FILTER, cv2.IMWRITE_PNG_FILTER_NONE)
    return cv2.imencode(".png", cv2.cvtColor(image, to_bgr), options)[1].tobytes()


def _parts(parent):
    """What may move in an axes or a figure, from below to above."""
    if not parent.get_visible():
        return []
    framed = getattr(parent, "axison", True) and not hasattr(parent, "get_proj")  # 3-D axes have no spines
    fixed = (Axis, Axes) if framed else (Axis, Axes, Spine)
    found = [part for part in parent.get_children() if part is not parent.patch and not isinstance(part, fixed)]
    return sorted(found, key=lambda artist: artist.get_zorder())


def _is_empty(artist):
    return isinstance(artist, Text) and not artist.get_text()


def _animate(parts):
    """Let the lowest artist that has changed move, and what lies above it; nothing if that would cover a grid.

    Empty texts move too: they are stale for ever. They let nothing else move.
    """
    changed = (k for k, one in enumerate(parts) if not _is_empty(one) and (one.get_animated() or one.stale))
    first = next(changed, len(parts))
    covers = first < len(parts) and parts[first].get_zorder() < _grid_height(parts[first].axes)
    for k, artist in enumerate(parts):
        artist.set_animated(_is_empty(artist) or (k >= first and not covers))


def _grid_height(axes):
    """How high the grid of a plane axes lies; below everything if there is none."""
    if axes is None or not axes.axison or hasattr(axes, "get_proj"):
        return -np.inf
    grids = [axis for axis in (axes.xaxis, axes.yaxis) if any(line.get_visible() for line in axis.get_gridlines())]
    return max((axis.get_zorder() for axis in grids), default=-np.inf)
