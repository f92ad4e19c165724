"""A live scope: joint angles, set points and PWM of the last seconds."""

import numpy as np

from ir50p_lab.course.draw.chart import Chart
from ir50p_lab.course.draw.style import COLOURS, JOINTS

_MOST = 300  # largest number of samples drawn: about one for every pixel column of a joint


class Scope(Chart):
    """Three joints side by side: the angle with its dashed set point above, PWM below, for the last seconds.

    window: s; badge: a word in the corner, such as "simulated". `frames` counts what `show` has sent.
    """

    def __init__(self, *, window=10.0, badge=""):
        panels = []
        for i, colour in enumerate(JOINTS):
            left, first = 62 + 323 * i, i == 0
            title = f"joint {i + 1}, {badge}" if badge and first else f"joint {i + 1}"
            angle = [(1 + i, colour, "deg", False), (4 + i, COLOURS["dark"], "", True)]
            above = {"place": (left, 28, 280, 165), "lines": angle, "title": title}
            below = {"place": (left, 222, 280, 95), "lines": [(7 + i, colour, "", False)], "ylim": (-270, 270)}
            panels.append(above | {"ylabel": "angle [deg]" * first})
            panels.append(below | {"ylabel": "PWM [counts]" * first, "xlabel": "time [s]"})
        words = f"Angle in deg with set point (dashed), PWM in counts, of joints 1 to 3, last {window:g} s {badge}"
        super().__init__(panels, window=float(window), height=360, description=words)

    def show(self, t, q, reference, u, marks=()):
        """Show these samples; those older than the window are left out.

        Args: t: (n,) s; q, reference: (n, 3) rad; u: (n, 3) PWM counts; marks: times of dotted
            lines, such as cuts of the drive, s.
        """
        rows = np.column_stack([t, np.degrees(q), np.degrees(reference), u])
        stride = -(-len(rows) // _MOST)
        if stride > 1:  # the same samples in every picture, else it shimmers
            period = (t[-1] - t[0]) / (len(t) - 1)
            rows = rows[np.round(rows[:, 0] / period) % stride == 0]
        self.draw(rows, marks)
