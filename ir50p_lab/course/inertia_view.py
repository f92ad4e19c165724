"""What the joints have to move, in pictures: the arm, M11 over the pose, and the velocities of equal energy."""

import numpy as np

from ir50p_lab.course.arm3d import SideView
from ir50p_lab.course.style import COLOURS, subplots
from ir50p_lab.modelling.dynamics import mass_matrix


def equal_energy(M, kinetic=1.0, points=121):
    """Velocities with 1/2 qd^T M qd = kinetic (J), an ellipse. M: (2, 2) kg m^2. Returns: (points, 2) rad/s."""
    turn = np.linspace(0, 2 * np.pi, points)
    circle = np.sqrt(2 * kinetic) * np.stack([np.cos(turn), np.sin(turn)])
    return np.linalg.solve(np.linalg.cholesky(M).T, circle).T


class InertiaView:
    """The arm from the side, M11 over q2, and the ellipse of 1 J in (qd2, qd3). `update(q)` moves all three.

    Attributes: figure (LabFigure), to be shown with `live`.
    """

    def __init__(self, arm):
        self.arm = arm
        self.figure, self._side, waist, joints = subplots(10.0, 3.6, cols=3)
        self._view = SideView(self._side, arm)
        self._q2 = np.linspace(-np.pi / 2, np.pi / 2, 91)
        (self._curve,) = waist.plot([], [])
        (self._dot,) = waist.plot([], [], "o", color=COLOURS["orange"], ms=8)
        (self._loop,) = joints.plot([], [], color=COLOURS["green"])
        q = np.zeros((181, 3))
        q[:, 2] = np.linspace(-np.pi, np.pi, 181)
        M = mass_matrix(arm, q)
        fastest = 1.05 * np.sqrt(2 / np.linalg.eigvalsh(M[:, 1:, 1:])[:, 0].min())
        waist.set(xlim=(-90, 90), ylim=(0, 1.08 * M[:, 0, 0].max()), xticks=range(-90, 91, 45))
        waist.set(xlabel="q2 [deg]", ylabel="M11 [kg m²]", title="What joint 1 has to turn")
        waist.set_box_aspect(1)
        joints.set(xlim=(-fastest, fastest), ylim=(-fastest, fastest), aspect="equal")
        joints.set(xlabel="shoulder [rad/s]", ylabel="elbow [rad/s]", title="These speeds cost 1 J")
        self.update((0.0, 0.0, 0.0))

    def update(self, q):
        """Move to q (3,) rad."""
        q = np.asarray(q, dtype=float)
        M = mass_matrix(self.arm, q)
        self._view.update(q)
        poses = np.stack([np.zeros_like(self._q2), self._q2, np.full_like(self._q2, q[2])], axis=1)
        self._curve.set_data(np.degrees(self._q2), mass_matrix(self.arm, poses)[:, 0, 0])
        self._dot.set_data([np.degrees(q[1])], [M[0, 0]])
        self._loop.set_data(*equal_energy(M[1:, 1:]).T)
        self._side.set_title(f"M22 = {M[1, 1]:.3f}, M23 = {M[1, 2]:.3f} kg m²")
