"""Picture of notebook 01: bricks that turn (A2 turns one, too)."""

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scipy.linalg import block_diag
from scipy.spatial.transform import Rotation

from ir50p_lab.course.draw.arm3d import FrameView
from ir50p_lab.course.draw.style import COLOURS, new_figure
from ir50p_lab.modelling.pose import rot_x, rot_y

_SIDES = ("#BFD9EA", "#E8C5AE", "#B3DCCD")  # the two faces across x, y, z


def space(ax):
    """Make 3-D axes equal, from -1 to 1, with the grey axes x, y, z of the frame they are drawn in."""
    ax.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    ax.set_box_aspect((1, 1, 1), zoom=1.25)
    ax.view_init(elev=22, azim=35)
    ax.set_axis_off()
    for name, axis in zip("xyz", np.eye(3), strict=True):
        ax.plot(*np.outer(axis, [0, 1]), color=COLOURS["grey"], linewidth=1.0, zorder=1)
        ax.text(*1.08 * axis, name, color=COLOURS["grey"], fontsize=10, ha="center")


class Brick:
    """A box with three different edges; `update(R)` turns it.

    edges: (3,) full lengths along x, y, z. Attributes: corners, as drawn, face by face: (6, 4, 3).
    """

    def __init__(self, ax, *, edges):
        around = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        faces = [np.roll(np.insert(around, 0, side, axis=1), k, axis=1) for k in range(3) for side in (-1, 1)]
        self._faces = np.array(faces) * np.array(edges) / 2
        colours = np.repeat(_SIDES, 2)
        self._box = Poly3DCollection(self._faces, facecolors=colours, edgecolors="#555555", linewidths=0.8, zorder=5)
        ax.add_collection3d(self._box)
        self.update(np.eye(3))

    def update(self, R):
        """Turn the brick. R: (3, 3), takes coordinates of the brick to those of the axes."""
        self.corners = self._faces @ R.T
        self._box.set_verts(self.corners)


def two_bricks(angle):
    """Draw a brick as it lay, and turned by `angle` (rad) about x and its own y in either order. Returns: LabFigure.

    The turn between the two results is shown as well.
    """
    figure = new_figure(11.5, 4.4, cols=4, projection="3d")
    first, second = rot_x(angle) @ rot_y(angle), rot_y(angle) @ rot_x(angle)
    titles = ("as it lay", "first x, then its own y", "first y, then its own x", "the single turn between")
    for ax, R, title in zip(figure.axes, (np.eye(3), first, second, first), titles, strict=True):
        space(ax)
        Brick(ax, edges=(0.9, 0.55, 0.2)).update(R)
        FrameView(ax, block_diag(R, 1), length=0.55)
        ax.set_title(title)
    turn = Rotation.from_matrix(second @ first.T).as_rotvec()
    axis = 1.1 * turn / np.linalg.norm(turn)
    figure.axes[3].plot(*np.outer(axis, [-1, 1]), "--", color=COLOURS["dark"], linewidth=1.6, zorder=40)
    for start, colour in zip(0.55 * first.T, ("orange", "green", "blue"), strict=True):
        path = Rotation.from_rotvec(np.outer(np.linspace(0, 1, 40), turn)).apply(start)
        figure.axes[3].plot(*path.T, ":o", color=COLOURS[colour], linewidth=2.2, ms=7, markevery=[-1], zorder=40)
    return figure
