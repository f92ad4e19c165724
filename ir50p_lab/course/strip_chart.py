"""A strip chart: numbers that grow with time on a small canvas, drawn in the browser while a cell runs.

The kernel sends all points as float32 with every frame, so that a browser that leaves frames out is right again with
the next one. Drawing takes the loop at the bench no time: a figure in the loop would make it late.
"""

import time

import anywidget
import numpy as np
import traitlets

from ir50p_lab.course.canvas import CANVAS
from ir50p_lab.course.style import COLOURS

__all__ = ["StripChart"]

_MOST = 600  # points in a frame
_COLOURS = ("blue", "orange", "green", "purple", "amber", "sky")

_DRAW = """
function paint(ctx, data, s, width, height) {
  const columns = s.labels.length + 1, n = Math.floor(data.length / columns);
  const x0 = 62, y0 = 30, w = width - x0 - 150, h = height - y0 - 38;
  const [low, high] = s.ylim, X = (t) => x0 + t / s.duration * w, Y = (v) => y0 + h - (v - low) / (high - low) * h;
  ctx.font = "11px sans-serif"; ctx.lineWidth = 1; ctx.fillStyle = "#555555"; ctx.strokeStyle = "#E6E6E6";
  const yStep = niceStep(high - low, 6), xStep = niceStep(s.duration, 8);
  ctx.textAlign = "right"; ctx.textBaseline = "middle";
  for (let v = Math.ceil(low / yStep) * yStep; v <= high; v += yStep) {
    const y = Math.round(Y(v)) + 0.5;
    ctx.beginPath(); ctx.moveTo(x0, y); ctx.lineTo(x0 + w, y); ctx.stroke();
    ctx.fillText(fixed(v, decimals(yStep)), x0 - 6, y);
  }
  ctx.textAlign = "center"; ctx.textBaseline = "top";
  for (let t = 0; t <= s.duration + 1e-9; t += xStep) {
    const x = Math.round(X(t)) + 0.5;
    ctx.beginPath(); ctx.moveTo(x, y0); ctx.lineTo(x, y0 + h); ctx.stroke();
    ctx.fillText(t.toFixed(decimals(xStep)), x, y0 + h + 5);
  }
  ctx.strokeStyle = "#666666";
  ctx.strokeRect(x0 + 0.5, y0 + 0.5, 0, h); ctx.strokeRect(x0 + 0.5, y0 + h + 0.5, w, 0);
  ctx.save(); ctx.beginPath(); ctx.rect(x0, y0, w, h); ctx.clip();
  for (let c = 1; c < columns; c++) {
    ctx.strokeStyle = s.colours[c - 1];
    if (s.levels.length) {
      ctx.lineWidth = 1.2; ctx.setLineDash([6, 4]);
      ctx.beginPath(); ctx.moveTo(x0, Y(s.levels[c - 1])); ctx.lineTo(x0 + w, Y(s.levels[c - 1])); ctx.stroke();
    }
    ctx.lineWidth = 1.8; ctx.setLineDash([]); ctx.lineJoin = "round"; ctx.beginPath();
    for (let k = 0; k < n; k++) {
      const x = X(data[k * columns]), y = Y(Math.max(-1e6, Math.min(1e6, data[k * columns + c])));
      if (k === 0) ctx.moveTo(x, y); else ctx.lineTo(x, y);
    }
    ctx.stroke();
  }
  ctx.restore();
  ctx.textAlign = "left"; ctx.textBaseline = "middle"; ctx.font = "12px sans-serif";
  for (let c = 1; c < columns; c++) {
    ctx.fillStyle = s.colours[c - 1];
    const last = n ? ":  " + data[(n - 1) * columns + c].toPrecision(3).replace("-", "\\u2212") : "";
    ctx.fillText(s.labels[c - 1] + last, x0 + w + 12, y0 + 14 + 20 * (c - 1));
  }
  ctx.fillStyle = "#333333"; ctx.textAlign = "center"; ctx.textBaseline = "alphabetic";
  ctx.fillText("time [s]", x0 + w / 2, height - 6);
  ctx.font = "bold 13px sans-serif"; ctx.textAlign = "left"; ctx.fillText(s.title, x0, 19);
  ctx.font = "12px sans-serif"; sideways(ctx, s.ylabel, 14, y0 + h / 2);
}
export default { render: (view) => onCanvas(view, paint, 960) };
"""


class StripChart(anywidget.AnyWidget):
    """Some numbers over time, at most 20 pictures a second; `display` it before the loop that feeds it.

    Args: labels: names of the curves, at most six; duration: s that the chart holds; ylim: (low, high); ylabel: with
    unit; title: what is seen; levels: one dashed line for each curve; height: pixels.

    `add(t, values)` takes one point (cheap), `flush()` shows what has not been shown. Attributes: t (n,), values
    (n, k) so far; frames: pictures sent.
    """

    _esm = CANVAS + _DRAW
    samples = traitlets.Bytes(b"").tag(sync=True)
    settings = traitlets.Dict().tag(sync=True)

    def __init__(self, labels, *, duration, ylim, ylabel, title, levels=(), height=300):
        self._count, self._every = len(labels), 1 / 20
        super().__init__(
            settings={
                "labels": list(labels),
                "duration": float(duration),
                "ylim": [float(x) for x in ylim],
                "ylabel": ylabel,
                "title": title,
                "levels": [float(x) for x in levels],
                "height": int(height),
                "colours": [COLOURS[_COLOURS[k % len(_COLOURS)]] for k in range(len(labels))],
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
