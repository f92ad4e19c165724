"""A live scope: joint angles, set points and PWM of the last seconds on a small canvas, twenty times a second.

The kernel sends the whole window as float32 with every frame: a browser that comes late, or leaves frames out, is
right again with the next one.
"""

import anywidget
import numpy as np
import traitlets

from ir50p_lab.course.canvas import CANVAS
from ir50p_lab.course.style import COLOURS

__all__ = ["Scope"]

_MOST = 500  # samples in a frame: about two for every pixel column of a joint

_DRAW = """
// The present range, unless what is shown leaves it or has become small in it.
function rangeFor(old, low, high) {
  const middle = (low + high) / 2, span = Math.max(high - low, 4);
  const need = [Math.min(low, middle - span / 2) - 0.08 * span, Math.max(high, middle + span / 2) + 0.08 * span];
  const edge = old ? 0.03 * (old[1] - old[0]) : 0;
  if (old && low >= old[0] + edge && high <= old[1] - edge && old[1] - old[0] < 3 * (need[1] - need[0])) return old;
  const step = niceStep(need[1] - need[0], 5);
  return [Math.floor(need[0] / step) * step, Math.ceil(need[1] / step) * step];
}

function plot(ctx, x0, y0, w, h, t0, t1, low, high, options) {
  const X = (t) => x0 + (t - t0) / (t1 - t0) * w, Y = (v) => y0 + h - (v - low) / (high - low) * h;
  ctx.lineWidth = 1; ctx.setLineDash([]); ctx.font = "11px sans-serif"; ctx.textBaseline = "middle";
  const yStep = options.yStep || niceStep(high - low, 5), places = decimals(yStep);
  ctx.textAlign = "right";
  for (let v = Math.ceil(low / yStep - 1e-9) * yStep; v <= high + 1e-9; v += yStep) {
    const y = Math.round(Y(v)) + 0.5;
    ctx.strokeStyle = Math.abs(v) < 1e-9 && options.zero ? "#BBBBBB" : "#E6E6E6";
    ctx.beginPath(); ctx.moveTo(x0, y); ctx.lineTo(x0 + w, y); ctx.stroke();
    ctx.fillStyle = "#555555";
    ctx.fillText(fixed(v, places), x0 - 5, y);
  }
  const xStep = niceStep(t1 - t0, 5);
  ctx.textAlign = "center"; ctx.textBaseline = "top";
  for (let t = Math.ceil(t0 / xStep - 1e-9) * xStep; t <= t1 + 1e-9; t += xStep) {
    const x = Math.round(X(t)) + 0.5;
    ctx.strokeStyle = "#E6E6E6";
    ctx.beginPath(); ctx.moveTo(x, y0); ctx.lineTo(x, y0 + h); ctx.stroke();
    if (options.times) { ctx.fillStyle = "#555555"; ctx.fillText(t.toFixed(0), x, y0 + h + 4); }
  }
  ctx.strokeStyle = "#666666";
  ctx.beginPath(); ctx.moveTo(x0 + 0.5, y0); ctx.lineTo(x0 + 0.5, y0 + h + 0.5); ctx.lineTo(x0 + w, y0 + h + 0.5);
  ctx.stroke();
  return [X, Y];
}

function line(ctx, data, n, columns, column, X, Y, colour, width, dash, stairs, box) {
  ctx.save();
  ctx.beginPath(); ctx.rect(...box); ctx.clip();
  ctx.strokeStyle = colour; ctx.lineWidth = width; ctx.setLineDash(dash); ctx.lineJoin = "round";
  ctx.beginPath();
  let last = 0;
  for (let k = 0; k < n; k++) {
    const x = X(data[k * columns]), y = Y(data[k * columns + column]);
    if (k === 0) ctx.moveTo(x, y);
    else { if (stairs) ctx.lineTo(x, last); ctx.lineTo(x, y); }
    last = y;
  }
  ctx.stroke();
  ctx.restore();
}

function render(view) {
  let ranges = [null, null, null];
  return onCanvas(view, (ctx, data, s, width, height) => {
    const columns = 10, n = Math.floor(data.length / columns);
    const t1 = n ? Math.max(data[(n - 1) * columns], s.window) : s.window, t0 = t1 - s.window;
    if (n && data[(n - 1) * columns] < 0.5) ranges = [null, null, null];
    const left = 62, gap = 46, top = 30, below = 36, between = 16;
    const w = (width - left - 8 - 2 * gap) / 3, h = height - top - below - between, upper = h * 0.62, lower = h - upper;
    for (let j = 0; j < 3; j++) {
      const x0 = left + j * (w + gap), colour = s.colours[j];
      let low = Infinity, high = -Infinity;
      for (let k = 0; k < n; k++) for (const c of [1 + j, 4 + j]) {
        const v = data[k * columns + c];
        if (v < low) low = v;
        if (v > high) high = v;
      }
      if (low <= high) ranges[j] = rangeFor(ranges[j], low, high);
      const range = ranges[j] || [-10, 10];
      let [X, Y] = plot(ctx, x0, top, w, upper, t0, t1, range[0], range[1], {});
      line(ctx, data, n, columns, 1 + j, X, Y, colour, 1.8, [], false, [x0, top, w, upper]);
      line(ctx, data, n, columns, 4 + j, X, Y, s.dark, 1.4, [6, 4], true, [x0, top, w, upper]);
      const y1 = top + upper + between;
      [X, Y] = plot(ctx, x0, y1, w, lower, t0, t1, -270, 270, { times: true, yStep: 255, zero: true });
      line(ctx, data, n, columns, 7 + j, X, Y, colour, 1.3, [], true, [x0, y1, w, lower]);
      ctx.setLineDash([]); ctx.textBaseline = "alphabetic"; ctx.textAlign = "left";
      ctx.fillStyle = colour; ctx.font = "bold 13px sans-serif";
      ctx.fillText("joint " + (j + 1), x0, 19);
      if (n) {
        const at = (n - 1) * columns, degrees = (k) => fixed(data[at + k], 1) + "\\u00b0";
        ctx.fillStyle = "#333333"; ctx.font = "12px sans-serif"; ctx.textAlign = "right";
        ctx.fillText(degrees(1 + j) + ",  set " + degrees(4 + j), x0 + w, 19);
      }
      ctx.fillStyle = "#333333"; ctx.font = "12px sans-serif"; ctx.textAlign = "center";
      ctx.fillText("time [s]", x0 + w / 2, height - 5);
    }
    sideways(ctx, "angle [deg]", 14, top + upper / 2);
    sideways(ctx, "PWM [counts]", 14, top + upper + between + lower / 2);
    ctx.textAlign = "left"; ctx.fillStyle = "#777777"; ctx.font = "11px sans-serif";
    if (s.badge) ctx.fillText(s.badge, 2, 12);
  });
}
export default { render };
"""


class Scope(anywidget.AnyWidget):
    """Three joints side by side: angle with its dashed set point above, PWM below, the last `window` seconds.

    window: s; height: pixels; badge: a word in the corner, such as "simulated". `frames` counts what `show` has sent.
    """

    _esm = CANVAS + _DRAW
    samples = traitlets.Bytes(b"").tag(sync=True)
    settings = traitlets.Dict().tag(sync=True)

    def __init__(self, *, window=10.0, height=360, badge=""):
        super().__init__(
            settings={
                "window": float(window),
                "height": int(height),
                "badge": badge,
                "colours": [COLOURS[name] for name in ("blue", "orange", "green")],
                "dark": COLOURS["dark"],
                "description": f"Angle in degrees with set point (dashed), and PWM in counts, of joints 1 to 3, last "
                f"{window:g} s {badge}",
            }
        )
        self.layout.width = "100%"
        self.frames = 0

    def show(self, t, q, reference, u):
        """Show these samples; what is older than the window is left out.

        Args: t: (n,) s; q, reference: (n, 3) rad; u: (n, 3) PWM counts.
        """
        t = np.asarray(t, dtype=float)
        stride = max(1, -(-len(t) // _MOST))
        kept = np.arange(len(t))
        if stride > 1:  # the same samples in every frame, else the picture shimmers
            period = (t[-1] - t[0]) / (len(t) - 1)
            kept = kept[np.round(t / period).astype(int) % stride == 0]
        rows = np.empty((len(kept), 10), dtype="<f4")
        rows[:, 0] = t[kept]
        rows[:, 1:4], rows[:, 4:7], rows[:, 7:] = np.degrees(q[kept]), np.degrees(reference[kept]), u[kept]
        self.samples = rows.tobytes()
        self.frames += 1
