"""Picture of A2: the rings of an angle sequence, and where it fails."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, new_figure
from ir50p_lab.course.kinematics.pose_views import Brick, space
from ir50p_lab.modelling.pose import gimbal_lock, rate_matrix, rotation_from_angles, singular_angles

_TURN = np.linspace(0, 2 * np.pi, 73)
_CIRCLE = np.array([np.cos(_TURN), np.sin(_TURN)])
_TURN_COLOURS = (COLOURS["purple"], COLOURS["amber"], COLOURS["sky"])  # first, second, third turn


class GimbalView:
    """Two rings and a brick on three pivots, one for each turn of a sequence, and the price of the next turn.

    The outer ring carries the pivot of the second turn, the inner ring that of the third. At a singularity both
    rings lie in one plane and the first and third pivot in one line: gimbal lock.

    `update(sequence, angles)` moves it. Attributes: figure; gain, the largest angle change per turn (rad/rad).
    """

    def __init__(self):
        self.figure = new_figure(9.6, 4.4, cols=2, projection=["3d", None])
        space_ax, price_ax = self.figure.axes
        space(space_ax)
        self._brick = Brick(space_ax, edges=(0.62, 0.38, 0.14))
        self._pivots, self._rings, self._labels = [], [], []
        for k, colour in enumerate(_TURN_COLOURS):
            style = {"color": colour, "solid_capstyle": "round"}
            self._pivots.append(space_ax.plot([], [], [], linewidth=5.0 - k, zorder=10 + k, **style)[0])
            if k < 2:
                self._rings.append(space_ax.plot([], [], [], linewidth=3.0, zorder=6 + k, **style)[0])
            self._labels.append(space_ax.text(0, 0, 0, "", color=colour, fontsize=10, fontweight="bold", zorder=20))
        self._lost = space_ax.plot([], [], [], "--", color=COLOURS["dark"], linewidth=1.6, zorder=9)[0]
        self._lost_label = space_ax.text(0, 0, 0, "", fontsize=9, zorder=20)
        self._curve = price_ax.plot([], [], color=COLOURS["blue"])[0]
        self._dot = price_ax.plot([], [], "o", color=COLOURS["orange"], ms=9, zorder=5)[0]
        price_ax.set(yscale="log", ylim=(0.8, 300), xlim=(-180, 180), xticks=range(-180, 181, 90))
        price_ax.set(xlabel="middle angle [deg]", ylabel="largest angle change per turn [deg/deg]")
        self._title = price_ax.set_title("")
        self._sequence = None

    def update(self, sequence, angles):
        """Show a sequence at three angles (3,) rad."""
        E, lock = rate_matrix(sequence, angles), gimbal_lock(sequence, angles)
        self.gain = float(lock.gain)
        self._brick.update(rotation_from_angles(sequence, angles))
        for k, (inner, outer) in enumerate(((0.95, 1.15), (0.72, 0.95), (0.15, 0.72))):
            reach = np.array([-outer, -inner, np.nan, inner, outer])
            self._pivots[k].set_data_3d(*np.outer(E[:, k], reach))
            self._labels[k].set_position_3d((-1, 1, 1)[k] * 1.1 * outer * E[:, k])
            self._labels[k].set_text(f"{k + 1}: {sequence[k]}")
        for k, radius in enumerate((0.95, 0.72)):  # a ring holds its own pivot and the next one
            self._rings[k].set_data_3d(*(radius * E[:, k : k + 2] @ _CIRCLE))
        near = lock.sine < 0.5
        self._lost.set_data_3d(*(np.outer(lock.lost_axis, [-1.1, 1.1]) if near else np.empty((3, 0))))
        self._lost_label.set_position_3d(1.2 * lock.lost_axis * np.sign(lock.lost_axis[2] or 1))
        self._lost_label.set_text(("lost" if lock.sine < 1e-9 else "hard") if near else "")
        if sequence != self._sequence:
            self._sequence, middle_deg = sequence, np.arange(-180, 181)
            others = np.tile(angles, (len(middle_deg), 1))
            others[:, 1] = np.radians(middle_deg)
            self._curve.set_data(middle_deg, np.minimum(gimbal_lock(sequence, others).gain, 1e4))
            low, high = np.degrees(singular_angles(sequence))
            self._title.set_text(f"{sequence} is singular at {low:.0f} and {high:.0f} deg")
        self._dot.set_data([np.degrees(angles[1])], [min(self.gain, 280.0)])
