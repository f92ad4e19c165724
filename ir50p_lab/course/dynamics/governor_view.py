"""The spinning arm as a governor: a picture of notebook 05 that moves."""

import numpy as np

from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import SETPOINT, subplots
from ir50p_lab.modelling.dynamics import gravity


class GovernorView:
    """The arm from the side, and next to it the shoulder torque that would hold each q2 while joint 1 spins.

    The arm is drawn where it settles: in the highest pose from which it is thrown upwards, or hanging down.

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
