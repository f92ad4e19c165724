"""Texts that did not change are drawn from memory: shaping and rasterising them is most of a redraw's time."""

from collections import OrderedDict
from contextlib import contextmanager

_KEPT = 600  # texts; a figure has some tens, and those that move leave old places behind


class TextCache:
    """Keeps, for every text drawn at one place, the calls that put its glyphs on the canvas, and repeats them.

    The pixels are those of matplotlib's own drawing, to the bit. For a `RendererAgg`:
    `with cache.on(renderer): artist.draw(renderer)`.

    Attributes: hits: texts drawn from memory so far (for tests and measurements).
    """

    def __init__(self):
        self._calls = OrderedDict()
        self.hits = 0

    @contextmanager
    def on(self, renderer):
        """While this lasts, `renderer` draws known texts from memory and remembers new ones."""
        plain = renderer.draw_text

        def draw_text(gc, x, y, s, prop, angle, ismath=False, mtext=None):
            key = (s, x, y, hash(prop), angle, ismath, renderer.dpi, renderer.width, renderer.height)
            key += (gc.get_rgb(), gc.get_alpha(), gc.get_antialiased(), gc.get_snap(), _clip(gc))
            if mtext is not None:
                key += (mtext.get_parse_math(), mtext.get_fontfeatures(), mtext.get_language())
            calls = self._calls.get(key)
            if calls is None:
                calls = self._calls[key] = []
                canvas, renderer._renderer = renderer._renderer, _Recorder(renderer._renderer, calls)
                try:
                    plain(gc, x, y, s, prop, angle, ismath=ismath, mtext=mtext)
                finally:
                    renderer._renderer = canvas
                if len(self._calls) > _KEPT:
                    self._calls.popitem(last=False)
                return
            self.hits += 1
            self._calls.move_to_end(key)
            for name, arguments in calls:
                getattr(renderer._renderer, name)(*arguments)

        renderer.draw_text = draw_text
        try:
            yield
        finally:
            del renderer.draw_text


class _Recorder:
    """Passes calls on to the canvas and writes them down."""

    def __init__(self, canvas, calls):
        self._canvas, self._calls = canvas, calls

    def __getattr__(self, name):
        method = getattr(self._canvas, name)

        def call(*arguments):
            self._calls.append((name, arguments))
            return method(*arguments)

        return call


def _clip(gc):
    """What cuts a text off, as a key. A clip path (rare) is never the same twice."""
    rectangle, (path, _) = gc.get_clip_rectangle(), gc.get_clip_path()
    return (None if rectangle is None else tuple(rectangle.bounds), None if path is None else object())
