"""Pictures of notebook 04: centres of the links, what the joints have to move, kilograms by direction."""

from types import SimpleNamespace

import numpy as np

from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.modelling.dynamics import mass_matrix


class InertiaView:
    """The arm from the side, M11 over q2, and the velocities (qd2, qd3) that cost 1 J: 1/2 qd^T M qd = 1, an ellipse.

    Args: arm: Arm. `update(q)` moves all three. Attributes: figure, to be shown with `live`.
    """

    def __init__(self, arm):
        self.arm = arm
        self.figure, self._side, waist, joints = subplots(11.0, 3.6, cols=3)
        self._view = SideView(self._side, arm)
        (self._curve,) = waist.plot([], [])
        (self._dot,) = waist.plot([], [], "o", color=COLOURS["orange"], ms=8)
        (self._ellipse,) = joints.plot([], [], color=COLOURS["green"])
        M = mass_matrix(arm, np.linspace([0, 0, -np.pi], [0, 0, np.pi], 181))
        fastest = 1.05 * np.sqrt(2 / np.linalg.eigvalsh(M[:, 1:, 1:])[:, 0].min())
        waist.set(xlim=(-90, 90), ylim=(0, 1.08 * M[:, 0, 0].max()), xticks=range(-90, 91, 45), box_aspect=1)
        waist.set(xlabel="q2 [deg]", ylabel="M11 [kg m²]", title="What joint 1 has to turn")
        joints.set(xlim=(-fastest, fastest), ylim=(-fastest, fastest), aspect="equal")
        joints.set(xlabel="shoulder [rad/s]", ylabel="elbow [rad/s]", title="These speeds cost 1 J")

    def update(self, q):
        """Move to q (3,) rad."""
        M = mass_matrix(self.arm, q)
        self._view.update(q)
        self._side.set_title(f"M22 = {M[1, 1]:.3f}, M23 = {M[1, 2]:.3f} kg m²")
        poses = np.linspace([0, -np.pi / 2, q[2]], [0, np.pi / 2, q[2]], 91)
        self._curve.set_data(np.degrees(poses[:, 1]), mass_matrix(self.arm, poses)[:, 0, 0])
        self._dot.set_data([np.degrees(q[1])], [M[0, 0]])
        turn = np.linspace(0, 2 * np.pi, 121)
        circle = np.sqrt(2) * np.stack([np.cos(turn), np.sin(turn)])
        self._ellipse.set_data(np.linalg.solve(np.linalg.cholesky(M[1:, 1:]).T, circle))


def centres(arm, q, places):
    """Draw the arm from the side and a dot for each of places (3, 3) m, one row per link: LabFigure (Figure 1.10)."""
    figure, plane = subplots(6.4, 4.6)
    SideView(plane, arm, q)
    radius = places[:, :2] @ [np.cos(q[0]), np.sin(q[0])]
    plane.plot(radius, places[:, 2], "o", ms=13, color=COLOURS["orange"], zorder=6)
    for link, place in enumerate(zip(radius, places[:, 2], strict=True), start=1):
        plane.annotate(str(link), place, ha="center", va="center", color="white", fontweight="bold", zorder=7)
    plane.set(xlim=(-0.35 * arm.reach, None), ylim=(-0.1 * arm.reach, arm.l[0] + 0.6 * arm.reach))
    plane.set_title("Centres of links 1, 2 and 3, as written")
    return figure


def kilograms(arm, q, angles, masses):
    """Draw the arm from the side at q, and how heavy its tip is in each direction. Returns: LabFigure.

    angles: (n,) rad in that plane, from outwards to upwards; masses: {label: kg (n,)}, the heaviest first.
    """
    figure, plane, ax = subplots(9.6, 4.4, cols=2)
    tip = SideView(plane, arm, q).points[2]
    ways = np.array([np.cos(angles), np.sin(angles)])
    for (label, kg), colour in zip(masses.items(), ("orange", "blue"), strict=False):
        ax.fill(*(kg * ways), facecolor=COLOURS[colour], edgecolor=COLOURS[colour], alpha=0.35, label=label)
        ax.plot(*(kg * ways), color=COLOURS[colour])
    heaviest = 0.25 * arm.reach * ways[:, np.argmax(next(iter(masses.values())))]
    plane.plot(
        *np.array([tip - heaviest, tip + heaviest]).T, color=COLOURS["orange"], linewidth=2, label="heaviest way"
    )
    plane.legend(loc="upper left")
    ax.set(aspect="equal", xlabel="outwards [kg]", ylabel="upwards [kg]", title="The farther out, the heavier")
    ax.legend()
    return figure


def motion(way, step):
    """Poses (n, 3) rad, one every `step` s, as `LiveArm` plays them."""
    return SimpleNamespace(t=step * np.arange(len(way)), q=np.array(way), simulated=True)
