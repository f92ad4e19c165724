"""Pictures of notebook 02 that move: columns of the Jacobian, the velocity ellipse, the four branches."""

import numpy as np

from ir50p_lab.course.arm3d import ArmView, SideView, arm_points
from ir50p_lab.course.style import COLOURS
from ir50p_lab.errors import UnreachableError
from ir50p_lab.modelling.differential import jacobian
from ir50p_lab.modelling.ik import BRANCHES, inverse_kinematics

JOINT_COLOURS = tuple(COLOURS[name] for name in ("purple", "sky", "amber"))
BRANCH_COLOURS = dict(zip(BRANCHES, (COLOURS[n] for n in ("blue", "sky", "orange", "amber")), strict=True))


class ColumnsView:
    """The arm in 3-D with three arrows at its tip: the tip velocity that each joint alone would give it.

    Args: ax: 3-D axes; arm: Arm; scale: m of arrow per m/s of tip at 1 rad/s.
    """

    def __init__(self, ax, arm, scale=0.5):
        self.arm, self._scale = arm, scale
        self.view = ArmView(ax, arm)
        self.arrows = [
            ax.plot([], [], [], color=colour, linewidth=3.5, marker="o", markevery=[1], ms=7, zorder=40,
                    label=f"joint {k + 1}")[0]
            for k, colour in enumerate(JOINT_COLOURS)
        ]  # fmt: skip
        ax.legend(loc="upper left", title="1 rad/s of", frameon=False)

    def update(self, q):
        """Move the arm to q (3,) rad. Returns: Jv (3, 3) m/rad."""
        self.view.update(q)
        tip, Jv = self.view.points[3], jacobian(self.arm, q)[:3]
        for k, arrow in enumerate(self.arrows):
            arrow.set_data_3d(*np.column_stack([tip, tip + self._scale * Jv[:, k]]))
        return Jv


class EllipseView:
    """The arm from the side and the ellipse of its tip velocities for joint rates of joints 2 and 3 of unit size.

    Args: ax: 2-D axes; arm: Arm; scale: m of drawing per m/s of tip at 1 rad/s.
    """

    def __init__(self, ax, arm, scale=0.5):
        self.arm, self._scale = arm, scale
        self.side = SideView(ax, arm)
        self._curve = ax.fill([0], [0], facecolor=COLOURS["amber"], alpha=0.35, edgecolor=COLOURS["orange"], zorder=3)[
            0
        ]
        self._axes = [ax.plot([], [], color=COLOURS["orange"], linewidth=1.5, zorder=6)[0] for _ in range(2)]

    def update(self, q2, q3):
        """Move the arm to the angles q2, q3 (rad) in its plane q1 = 0. Returns: semi-axes (2,) m/s per rad/s."""
        q = np.array([0.0, q2, q3])
        self.side.update(q)
        tip = arm_points(self.arm, q)[3, [0, 2]]
        U, sigma, _ = np.linalg.svd(jacobian(self.arm, q)[np.ix_([0, 2], [1, 2])])
        turn = np.linspace(0, 2 * np.pi, 91)
        reach = self._scale * U * sigma  # columns: the semi-axes as drawn
        self._curve.set_xy((tip[:, None] + reach @ [np.cos(turn), np.sin(turn)]).T)
        for k, axis in enumerate(self._axes):
            axis.set_data(*np.column_stack([tip - reach[:, k], tip + reach[:, k]]))
        return sigma


class BranchesView:
    """All four poses that reach a target, in 3-D and in the vertical plane through it; pale: outside the limits.

    Args: figure: with a 3-D and a 2-D axes; arm: Arm.
    """

    def __init__(self, figure, arm):
        space, plane = figure.axes
        self.arm = arm
        self.view = ArmView(space, arm)  # the branch nearest to the zero pose, or the last one reached
        self.ghosts, self.sides = {}, {}
        for name, colour in BRANCH_COLOURS.items():
            self.ghosts[name] = ArmView(space, arm, ghost=True, colour=colour)
            self.sides[name] = SideView(plane, arm, colour=colour, ghost=bool(self.sides), label=name)
        plane.legend(loc="upper center", ncols=2, fontsize=8, frameon=False, bbox_to_anchor=(0.5, 1.16))

    def update(self, p):
        """Show the poses for the target p (3,) m.

        Returns: a sentence: which branches the joint limits allow, or how far out of reach the target is.
        """
        self.view.target(p)
        self.sides["front/up"].target(np.hypot(p[0], p[1]), p[2])
        try:
            solutions = inverse_kinematics(self.arm, p)
        except UnreachableError as error:
            self._show(())
            return f"out of reach by {error.distance:.3f} m"
        heading = np.arctan2(p[1], p[0])
        for name, q, allowed in zip(solutions.branches, solutions.q, solutions.within_limits, strict=True):
            self.ghosts[name].update(q)
            self.sides[name].update(q, heading)
            self.sides[name].set_alpha(1.0 if allowed else 0.35)
        self._show(solutions.branches)
        allowed = [n for n, inside in zip(solutions.branches, solutions.within_limits, strict=True) if inside]
        self.view.update(solutions[allowed[0] if allowed else 0])
        return f"within the joint limits: {', '.join(allowed) or 'none of the four'}"

    def _show(self, names):
        for name in BRANCHES:
            self.ghosts[name].set_visible(name in names)
            self.sides[name].set_visible(name in names)
