"""A live scope: joint angles, set points and PWM of the last seconds on a small canvas, twenty times a second.

The kernel sends the whole window as float32 with every frame: a browser that comes late, or leaves frames out, is
right again with the next one.
"""

import numpy as np

from ir50p_lab.course.canvas import Canvas
from ir50p_lab.course.style import COLOURS

__all__ = ["Scope"]

_MOST = 500  # samples in a frame: about two for every pixel column of a joint


class Scope(Canvas):
    """Three joints side by side: angle with its dashed set point above, PWM below, the last `window` seconds.

    window: s; height: pixels; badge: a word in the corner, such as "simulated". `frames` counts what `show` has sent.
    """

    def __init__(self, *, window=10.0, height=360, badge=""):
        colours, panels = [COLOURS[name] for name in ("blue", "orange", "green")], []
        for i, colour in enumerate(colours):
            left, name = 0.35 * i, f"joint {i + 1}" + (f", {badge}" if badge and i == 0 else "")
            angle = [
                {"column": 1 + i, "colour": colour, "label": "deg"},
                {"column": 4 + i, "colour": COLOURS["dark"], "dash": True, "stairs": True},
            ]
            drive = [{"column": 7 + i, "colour": colour, "stairs": True}]
            axes = {"ylabel": "" if i else "angle [deg]", "title": name, "colour": colour}
            panels.append(axes | {"place": [left, 0, 0.3, 0.58], "lines": angle})
            axes = {"ylabel": "" if i else "PWM [counts]", "title": "", "colour": colour, "times": True}
            panels.append(axes | {"place": [left, 0.65, 0.3, 0.35], "lines": drive, "ylim": [-270, 270], "yStep": 255})
        super().__init__(
            settings={
                "window": float(window),
                "height": int(height),
                "columns": 10,
                "panels": panels,
                "description": f"Angle in degrees with set point (dashed), and PWM in counts, of joints 1 to 3, last "
                f"{window:g} s {badge}",
            }
        )
        self.layout.width = "100%"
        self.frames = 0

    def show(self, t, q, reference, u, marks=()):
        """Show these samples; what is older than the window is left out.

        Args: t: (n,) s; q, reference: (n, 3) rad; u: (n, 3) PWM counts; marks: times of dotted
            lines, such as cuts of the drive, s.
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
        self.marks = [float(mark) for mark in marks]
        self.samples = rows.tobytes()
        self.frames += 1
