"""The arm in pictures that move: in 3-D (`ArmView`) and in the vertical plane through it (`SideView`)."""

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from ir50p_lab.course.draw.style import COLOURS
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.differential import jacobian

_AXIS_COLOURS = (COLOURS["orange"], COLOURS["green"], COLOURS["blue"])  # x, y, z
_LINK_COLOURS = ("#8C8C8C", COLOURS["blue"], COLOURS["orange"])  # column, upper arm, forearm


class FrameView:
    """A coordinate frame in 3-D axes, with x orange, y green and z blue; `update(T)` moves it.

    Args: ax: 3-D axes; T: (4, 4) transform of the frame; name: text at its origin; length: of its axes, in the unit
    of the plot.
    """

    def __init__(self, ax, T, name="", length=0.1):
        self._length = length
        # each axis is one line: origin, end, a gap, and the letter as a marker (a Text costs twice as much to draw)
        style = {"linewidth": 2.2, "solid_capstyle": "round", "markersize": 7, "markeredgewidth": 0.3, "zorder": 30}
        self.axes = [
            ax.plot(*np.zeros((3, 4)), color=colour, marker=f"${letter}$", markevery=[3], clip_on=False, **style)[0]
            for letter, colour in zip("xyz", _AXIS_COLOURS, strict=True)
        ]
        self.title = ax.text(0, 0, 0, name, fontsize=9, fontweight="bold", ha="right", va="top", zorder=31)
        self.update(T)

    def update(self, T):
        """Move the frame. T: (4, 4), takes coordinates of this frame to those of the axes."""
        origin, R = T[:3, 3], T[:3, :3]
        for k in range(3):
            end = origin + self._length * R[:, k]
            gap = np.full(3, np.nan)
            self.axes[k].set_data_3d(*np.column_stack([origin, end, gap, end + 0.22 * self._length * R[:, k]]))
        self.title.set_position_3d(origin - 0.2 * self._length * R.sum(axis=1))


class ArmView:
    """The arm in 3-D axes: column, upper arm and forearm, joint axes, tip, shadow; `update(q)` moves it.

    Args:
        ax: 3-D axes (`new_figure(projection="3d")`). arm: Arm.
        q: (3,) rad, first pose. frames: True also draws frames 0 to 3; a list such as (0, 3) draws those.
        thickness: of the links, points.

    Attributes: q; points: what is drawn, foot, shoulder, elbow and tip, (4, 3) m.
    """

    def __init__(self, ax, arm, q=(0.0, 0.0, 0.0), *, frames=False, thickness=10.0):
        self.ax, self.arm, self.q = ax, arm, None
        _stage(ax, arm)

        def line(width, colour, cap="round", **more):
            return ax.plot([], [], [], linewidth=width, color=colour, solid_capstyle=cap, **more)[0]

        def part(colour, width, cap="butt"):  # outline and fill; `update` orders the parts by depth
            return line(width * thickness + 2, "#222222", cap), line(width * thickness, colour, cap)

        widths, caps = (1.25, 1.0, 0.8), ("butt", "round", "round")
        self._links = [part(*link) for link in zip(_LINK_COLOURS, widths, caps, strict=True)]
        self._hubs = [part("#C8C8C8", 1.45) for _ in range(4)]
        self._shadow = line(0.6 * thickness, "#000000", alpha=0.10, zorder=2, solid_joinstyle="round")
        numbers = range(4) if frames is True else frames or ()
        self._frames = {k: FrameView(ax, np.eye(4), str(k), 0.28 * arm.reach) for k in numbers}
        self._tip = ax.plot([0], [0], [0], "o", ms=0.75 * thickness, color=COLOURS["dark"])[0]
        self.update(q)

    def update(self, q):
        """Move the arm to q (3,) rad."""
        self.q = vectors3("q", q)
        self.place(frames(self.arm, self.q))

    def place(self, T):
        """Move the parts to T (4, 4, 4), the transforms of frames 0 to 3 to the base, whether right or wrong."""
        self.points = corners = T[:, :3, 3]
        parts = [(pair, corners[k : k + 2]) for k, pair in enumerate(self._links)]
        half = 0.08 * self.arm.reach
        for k, pair in enumerate(self._hubs):  # two halves of the shoulder's and of the elbow's axle
            middle, axis = corners[1 + k // 2], T[1, :3, 2]
            parts.append((pair, np.array([middle, middle + half * (-1) ** k * axis])))
        self._order(parts)
        self._tip.set_data_3d(*corners[3:].T)
        self._shadow.set_data_3d(corners[1:, 0], corners[1:, 1], np.zeros(3))
        for k, view in self._frames.items():
            if np.isfinite(T[k]).all():
                view.update(T[k])

    def trail(self, points):
        """Draw a path of the tip through points (n, 3) m."""
        self.ax.plot(*points.T, "-", color=COLOURS["green"], linewidth=1.6, zorder=3)

    def ellipsoids(self, names):
        """Draw those of the "velocity ellipsoid" and the "force ellipsoid" at the tip that are in `names`.

        At a singular pose the ellipsoid of the forces is infinite and is left out.
        """
        J = jacobian(self.arm, self.q)[:3]
        shapes = {"velocity ellipsoid": (0.25 * J, COLOURS["sky"])}
        if abs(np.linalg.det(J)) > 1e-4:
            shapes["force ellipsoid"] = (0.025 * np.linalg.inv(J).T, COLOURS["purple"])
        turn, tilt = np.linspace(0, 2 * np.pi, 41), np.linspace(0, np.pi, 21)[:, None]
        ball = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt) + 0 * turn])
        for row, name in enumerate(name for name in shapes if name in names):
            matrix, colour = shapes[name]
            surface = np.tensordot(matrix, ball, 1) + self.points[3][:, None, None]
            self.ax.plot_surface(*surface, color=colour, alpha=0.35, linewidth=0)
            self.ax.text2D(0.02, 0.88 - 0.06 * row, name, transform=self.ax.transAxes, color=colour)

    def _order(self, parts):
        """Set the ends of each part and draw the far ones first."""
        azimuth, elevation = np.radians([self.ax.azim, self.ax.elev])
        to_eye = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        order = np.argsort([ends.mean(axis=0) @ to_eye for _, ends in parts])
        for rank, k in enumerate(order):
            (outline, fill), ends = parts[k]
            for artist, above in ((outline, 0.0), (fill, 0.5)):
                artist.set_data_3d(*ends.T)
                artist.set_zorder(10 + rank + above)
        self._tip.set_zorder(10 + len(parts))


def _stage(ax, arm):
    """Ground, limits, labels: what stays still."""
    R, top = arm.reach, arm.l[0] + arm.reach
    turn = np.linspace(0, 2 * np.pi, 73)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    ax.add_collection3d(Poly3DCollection([R * circle], facecolor="#F4F4F4", edgecolor="#D0D0D0", zorder=0))
    ax.add_collection3d(Poly3DCollection([0.13 * R * circle], facecolor="#9A9A9A", edgecolor="#222222", zorder=1))
    ax.set(xlim=(-R, R), ylim=(-R, R), zlim=(0, top), xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    ax.set_box_aspect((2 * R, 2 * R, top), zoom=1.3)
    ax.locator_params(nbins=5)
    ax.view_init(elev=22, azim=-60)


class SideView:
    """The arm in the vertical plane through its column and a heading: radius to the right, height upwards.

    `update(q)` moves it; the heading is that of joint 1.

    Args: ax: 2-D axes; arm: Arm; colour: of the links; label: for the legend.
    Attributes: points: what is drawn, shoulder, elbow, tip as (radius, height), (3, 2) m.
    """

    def __init__(self, ax, arm, q=(0.0, 0.0, 0.0), *, colour=COLOURS["blue"], label=None):
        self.arm = arm
        _side_stage(ax, arm)
        style = {"solid_capstyle": "round", "solid_joinstyle": "round", "ms": 8, "mfc": "white", "mew": 2}
        self._line = ax.plot([], [], "-o", color=colour, linewidth=4, label=label, zorder=4, **style)[0]
        self._tip = ax.plot([], [], "o", color=COLOURS["dark"], ms=6, zorder=5)[0]
        self.update(q)

    def update(self, q):
        """Move the arm to q (3,) rad."""
        corners = frames(self.arm, q)[:, :3, 3]
        radius = corners[:, :2] @ np.array([np.cos(q[0]), np.sin(q[0])])
        self.points = np.column_stack([radius, corners[:, 2]])[1:]
        self._line.set_data(*self.points.T)
        self._tip.set_data(*self.points[2:].T)


def _side_stage(ax, arm):
    """Reachable shell (shaded), column, ground and limits."""
    (l1, l2, l3), R = arm.l, arm.reach
    turn = np.linspace(0, 2 * np.pi, 181)
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    inner = abs(l2 - l3)
    outline = np.vstack([R * ring, inner * ring[::-1]]) + np.array([0, l1])
    ax.fill(*outline.T, facecolor="#EDF3F8", edgecolor="none", zorder=0.6)
    for radius in (R, inner):
        ax.plot(*(radius * ring + np.array([0, l1])).T, color="#B5CBDD", linewidth=1.0, zorder=0.7)
    ax.plot([0, 0], [0, l1], color="#8C8C8C", linewidth=8, solid_capstyle="butt", zorder=3)
    ax.axhline(0, color="#BBBBBB", linewidth=1.5, zorder=1)
    margin = 1.08 * R
    ax.set(xlim=(-margin, margin), ylim=(min(l1 - margin, 0), l1 + margin))
    ax.set(xlabel="radius [m]", ylabel="height [m]", aspect="equal")
