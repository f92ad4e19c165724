"""Pictures of notebook 04 that move: what the joints have to move, and the spinning arm as a governor."""

import numpy as np

from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.dynamics import gravity, mass_matrix


class InertiaView:
    """The arm from the side, M11 over q2, and the velocities (qd2, qd3) that cost 1 J: 1/2 qd^T M qd = 1, an ellipse.

    Args: arm: Arm. `update(q)` moves all three. Attributes: figure, to be shown with `live`.
    """

    def __init__(self, arm):
        self.arm = arm
        self.figure, self._side, waist, joints = subplots(10.0, 3.6, cols=3)
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


class GovernorView:
    """The arm from the side, and beside it the shoulder torque that would hold each q2 while joint 1 spins.

    The arm is drawn where it settles: the highest pose that it is thrown out of upwards, or hanging down.

    Args: arm: Arm; q (n, 3) rad: poses from hanging down to level. Attributes: figure, to be shown with `live`.
    """

    def __init__(self, arm, q):
        self.figure, plane, self._ax = subplots(9.0, 3.8, cols=2, width_ratios=(1, 1.5))
        self._q, self.side = q, SideView(plane, arm)
        top = 1.1 * gravity(arm, np.zeros(3))[1]
        (self.curve,) = self._ax.plot(np.degrees(q[:, 1]), np.zeros(len(q)))
        self._ax.set(xlim=(-90, 0), ylim=(-top, top), xlabel="q2 [deg]", ylabel="shoulder torque to hold q2 [N m]")
        self._ax.axhline(0, **SETPOINT)

    def update(self, spin, torque):
        """Show the torques (n,) N m at the rate spin (rad/s) of joint 1. Returns: where the arm settles, (3,) rad."""
        thrown_up = np.flatnonzero(torque < -1e-9)
        rest = self._q[thrown_up[-1] if len(thrown_up) else 0]
        self.curve.set_ydata(torque)
        self.side.update(rest)
        self._ax.set_title(f"At {spin:.1f} rad/s the arm settles at {np.degrees(rest[1]):.0f} deg")
        return rest
