"""A strip chart: numbers that grow with time on a small canvas, drawn in the browser while a cell runs.

The kernel sends all points as float32 with every frame, so that a browser that leaves frames out is right again with
the next one. Drawing takes the loop at the bench no time: a figure in the loop would make it late.
"""

import time
from itertools import zip_longest

import numpy as np

from ir50p_lab.course.canvas import Canvas
from ir50p_lab.course.style import COLOURS

__all__ = ["StripChart"]

_MOST = 600  # points in a frame
_COLOURS = ("blue", "orange", "green", "purple", "amber", "sky")


class StripChart(Canvas):
    """Some numbers over time, at most 20 pictures a second; `display` it before the loop that feeds it.

    Args: labels: names of the curves, at most six; duration: s that the chart holds; ylim: (low, high); ylabel: with
    unit; title: what is seen; levels: one dashed line for each curve; height: pixels.

    `add(t, values)` takes one point (cheap), `flush()` shows what has not been shown. Attributes: t (n,), values
    (n, k) so far; frames: pictures sent.
    """

    def __init__(self, labels, *, duration, ylim, ylabel, title, levels=(), height=300):
        self._count, self._every = len(labels), 1 / 20
        lines = [
            {"column": k + 1, "colour": COLOURS[_COLOURS[k % len(_COLOURS)]], "label": label, "level": level}
            for k, (label, level) in enumerate(zip_longest(labels, map(float, levels)))
        ]
        panel = {"place": [0, 0, 1, 1], "ylim": [float(x) for x in ylim], "ylabel": ylabel, "times": True}
        super().__init__(
            settings={
                "window": float(duration),
                "height": int(height),
                "columns": 1 + self._count,
                "side": 150,
                "panels": [panel | {"title": title, "colour": COLOURS["dark"], "lines": lines}],
                "description": f"{title}: {', '.join(labels)} over {duration:g} s",
            }
        )
        self.layout.width = "100%"
        self._rows, self._shown, self.frames = [], -np.inf, 0

    @property
    def t(self):
        """Times of the points, (n,) s."""
        return np.array([row[0] for row in self._rows])

    @property
    def values(self):
        """The points, (n, k)."""
        return np.array([row[1:] for row in self._rows]).reshape(-1, self._count)

    def add(self, t, values):
        """One point at t (s); shown at once if the last picture is older than 50 ms."""
        self._rows.append((float(t), *map(float, values)))
        now = time.monotonic()
        if now - self._shown >= self._every:
            self._shown = now
            self.flush()

    def flush(self):
        """Show everything so far."""
        stride = max(1, -(-len(self._rows) // _MOST))
        rows = self._rows[::stride]
        if rows and rows[-1] is not self._rows[-1]:
            rows = [*rows, self._rows[-1]]
        self.samples = np.array(rows, dtype="<f4").tobytes()
        self.frames += 1
