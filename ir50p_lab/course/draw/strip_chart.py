"""A strip chart: numbers that grow with time, drawn while a cell runs.

A figure in the loop at the bench would make it late; a picture of the chart takes about a millisecond.
"""

import time

import numpy as np

from ir50p_lab.course.draw.chart import Chart
from ir50p_lab.course.draw.style import COLOURS

_MOST = 600  # largest number of points drawn of a curve


class StripChart(Chart):
    """Some numbers over time, at most 20 pictures a second; `display` it before the loop that feeds it.

    Args: labels: names of the curves, at most six; duration: s that the chart holds; ylim: (low, high); ylabel: with
    unit; title: what is seen; levels: one dashed line for each curve.

    `add(t, values)` takes one point (cheap), `flush()` shows what has not been shown. Attributes: values (n, k) so far;
    frames: pictures sent.
    """

    def __init__(self, labels, *, duration, ylim, ylabel, title, levels=()):
        self._rows, self._shown, self._columns = [], -np.inf, 1 + len(labels)
        colours = list(COLOURS.values())
        lines = [(k, colour, label, False) for k, (label, colour) in enumerate(zip(labels, colours, strict=False), 1)]
        panel = {"place": (62, 30, 920, 222), "lines": lines, "levels": list(zip(levels, colours, strict=False))}
        words = f"{title}: {', '.join(labels)} over {duration:g} s"
        axes = {"ylim": ylim, "title": title, "ylabel": ylabel, "xlabel": "time [s]"}
        super().__init__([panel | axes], window=float(duration), height=290, description=words)

    @property
    def values(self):
        """The points, (n, k)."""
        return self._table(self._rows)[:, 1:]

    def _table(self, rows):
        return np.array(rows, dtype=float).reshape(-1, self._columns)

    def add(self, t, values):
        """One point at t (s); shown at once if the last picture is older than 50 ms."""
        self._rows.append((float(t), *map(float, values)))
        now = time.monotonic()
        if now - self._shown >= 1 / 20:
            self._shown = now
            self.flush()

    def flush(self):
        """Show everything so far."""
        stride = -(-len(self._rows) // _MOST) or 1
        self.draw(self._table(self._rows[::stride] + self._rows[-1:]))
