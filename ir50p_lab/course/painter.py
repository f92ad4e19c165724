"""Fast redrawing of a matplotlib figure: frames, ticks and grids are drawn once, the rest each time (blitting)."""

import struct
import threading
import zlib

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import Collection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Line3D
from PIL import Image

from ir50p_lab.course.text_cache import TextCache

# Widget callbacks may run in threads beside the cell's; matplotlib is shared by all of them.
DRAWING = threading.RLock()


class Painter:
    """Draws `figure` again and again, pixel for pixel like a full redraw, in a fraction of its time.

    The background (panes, grid, ticks, tick labels, axis labels) is kept as pixels and drawn anew only when it
    changed: limits, ticks, labels, colours of an axis, view of a 3-D axes, position or size. Everything else
    (lines, collections, patches, texts, titles, legends, spines) is drawn over it each time, so artists may be
    changed, added and removed freely. The layout is computed once and then held, so that nothing jumps.

    What it cannot see is a change made to a single tick label; call `forget()` after that. Where axes overlap
    (twinx, labels that outgrow the layout) all backgrounds lie below all data. A title keeps its height while its
    text changes, but for the number of its lines.

    Attributes: backgrounds: how often the background was drawn (for tests and measurements).
    """

    def __init__(self, figure):
        self.figure = figure
        self.backgrounds = 0
        if not isinstance(figure.canvas, FigureCanvasAgg):
            FigureCanvasAgg(figure)
        figure.canvas.draw()  # runs the layout engine
        figure.set_layout_engine("none")
        self._seen = self._region = None
        self._title_heights = {}
        self._texts = TextCache()

    def forget(self):
        """Draw the background anew next time."""
        self._seen = None

    def rgba(self):
        """The figure as it is now: (height, width, 4) uint8, valid until the next call."""
        figure, renderer = self.figure, self.figure.canvas.get_renderer()
        if figure.subfigs:  # rare; not worth a background of their own
            figure.canvas.draw()
            return np.asarray(figure.canvas.buffer_rgba())
        axes = sorted((ax for ax in figure.axes if ax.get_visible()), key=lambda ax: ax.get_zorder())
        seen = self._fingerprint(axes)
        if seen != self._seen or any(part.stale for ax in axes for part in _background_parts(ax)):
            self._draw_background(renderer, axes)
            self._seen = self._fingerprint(axes)  # again: drawing may settle the aspect
        else:
            renderer.restore_region(self._region)
        for ax in axes:
            for title, y in zip(_titles(ax), self._title_heights[id(ax)], strict=True):
                title.set_y(y)  # set_title() has dropped it to the frame
            if hasattr(ax, "get_proj"):
                _project(ax)
        with self._texts.on(renderer):
            for ax in axes:
                _draw_in_order(_foreground(ax), renderer)
            _draw_in_order(_figure_artists(figure), renderer)
        return np.asarray(renderer.buffer_rgba())

    def png(self):
        """The figure as it is now, as the bytes of a PNG file."""
        pixels = self.rgba()
        height, width = pixels.shape[:2]
        image = Image.frombuffer("RGBA", (width, height), pixels, "raw", "RGBA", 0, 1)
        return encode_png(np.frombuffer(image.tobytes("raw", "RGB"), np.uint8).reshape(height, width, 3))

    def _draw_background(self, renderer, axes):
        hidden = [artist for ax in axes for artist in _foreground(ax)] + _figure_artists(self.figure)
        hidden = [artist for artist in hidden if artist.get_visible()]
        for artist in hidden:
            artist.set_visible(False)
        try:
            renderer.clear()
            self.figure.draw(renderer)
        finally:
            for artist in hidden:
                artist.set_visible(True)
        for ax in axes:
            ax._update_title_position(renderer)  # above ticks at the top; Axes.draw does not move hidden titles
            self._title_heights[id(ax)] = [title.get_position()[1] for title in _titles(ax)]
            for part in _background_parts(ax):
                part.stale = False  # an invisible axis does not clear it itself
        self._region = renderer.copy_from_bbox(self.figure.bbox)
        self.backgrounds += 1

    def _fingerprint(self, axes):
        """All that the background depends on and that matplotlib does not flag as stale."""
        figure = self.figure
        seen = [figure.dpi, *figure.bbox.size, figure.get_facecolor()]
        for ax in axes:
            seen += [id(ax), ax.get_zorder(), *ax.get_position().bounds, *ax.get_xlim(), *ax.get_ylim()]
            seen += [axis.get_visible() for axis in _axes_of(ax)] + [ax.axison, *map(id, _foreground_axes(ax))]
            seen += [t.get_text().count("\n") if t.get_text() else None for t in _titles(ax)]
            if hasattr(ax, "get_proj"):
                seen += [*ax.get_zlim(), ax.get_proj().tobytes(), ax._axis3don]
        return seen


def encode_png(rgb):
    """PNG file of an image (height, width, 3) uint8, made for speed.

    Every row is stored as its difference from the row above and compressed by run lengths: for drawings as small as
    Pillow's best guess per row and 2 to 3 times as fast (4 ms against 10 ms for 900 x 600), which a slider notices.
    """
    height, width = rgb.shape[:2]
    flat = rgb.reshape(height, 3 * width)
    rows = np.empty((height, 1 + 3 * width), np.uint8)
    rows[:, 0] = 2  # filter type "up"
    rows[0, 1:] = flat[0]
    np.subtract(flat[1:], flat[:-1], out=rows[1:, 1:])
    deflate = zlib.compressobj(1, strategy=zlib.Z_RLE)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bit, RGB
    data = deflate.compress(rows) + deflate.flush()
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        for kind, body in ((b"IHDR", header), (b"IDAT", data), (b"IEND", b""))
    )


def _axes_of(ax):
    """The x, y (and z) axis of an axes."""
    return [getattr(ax, name + "axis") for name in ax._axis_names]


def _titles(ax):
    return [ax.title, ax._left_title, ax._right_title]


def _foreground_axes(ax):
    """Axis objects that must be drawn above some artist, and so cannot be part of the background."""
    if hasattr(ax, "get_proj"):  # 3-D axes draw theirs first, whatever their zorder
        return []
    fixed = {id(ax.patch), *map(id, _axes_of(ax)), *map(id, ax.spines.values())}
    lowest = min((a.get_zorder() for a in ax.get_children() if id(a) not in fixed), default=0)
    return [axis for axis in _axes_of(ax) if axis.get_zorder() > lowest]


def _background_parts(ax):
    above = _foreground_axes(ax)
    return [ax.patch] + [axis for axis in _axes_of(ax) if axis not in above]


def _foreground(ax):
    drop = {id(part) for part in _background_parts(ax)}
    if hasattr(ax, "get_proj") or not ax.axison:
        drop |= {id(spine) for spine in ax.spines.values()} | {id(axis) for axis in _axes_of(ax)}
    return [artist for artist in ax.get_children() if id(artist) not in drop]


def _figure_artists(figure):
    drop = {id(figure.patch), *map(id, figure.axes)}
    return [artist for artist in figure.get_children() if id(artist) not in drop]


def _draw_in_order(artists, renderer):
    for artist in sorted(artists, key=lambda artist: artist.get_zorder()):
        if type(artist) is Line3D and _is_plain(artist.axes) and not artist._axlim_clip:
            _draw_line3d(artist, renderer)
        else:
            artist.draw(renderer)


def _is_plain(ax):
    """Linear scales, parallel or perspective projection: no point needs masking for its scale."""
    return all(axis.get_scale() == "linear" for axis in _axes_of(ax))


def _draw_line3d(line, renderer):
    """Line3D.draw without its masked arrays, which cost as much as the drawing itself."""
    x, y, z = (np.asarray(values, dtype=float) for values in line.get_data_3d())
    shown = line.axes.M @ np.array([x, y, z, np.ones_like(x)])
    x, y, z = shown[:3] / shown[3]
    if np.isfinite(line.axes._focal_length):  # matplotlib drops what lies outside the perspective view
        outside = ~((-1 <= x) & (x <= 1) & (-1 <= y) & (y <= 1) & (z <= 0))
        x, y = np.where(outside, np.nan, x), np.where(outside, np.nan, y)
    line.set_data(x, y)
    Line2D.draw(line, renderer)
    line.stale = False


def _project(ax):
    """What Axes3D.draw does to collections and patches before it draws them."""
    artists = [a for a in ax.get_children() if isinstance(a, Collection | Patch) and a.get_visible()]
    artists = [a for a in artists if hasattr(a, "do_3d_projection")]
    depths = [(artist.do_3d_projection(), artist) for artist in artists]
    if ax.computed_zorder:
        first = max(axis.get_zorder() for axis in _axes_of(ax)) + 1
        far_to_near = sorted(depths, key=lambda pair: pair[0], reverse=True)
        counts = {Collection: first, Patch: first}
        for _, artist in far_to_near:
            kind = Collection if isinstance(artist, Collection) else Patch
            artist.set_zorder(counts[kind])
            counts[kind] += 1
