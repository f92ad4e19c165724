"""Pictures of notebook 02: columns of the Jacobian, velocities, the way out, workspace, branches, steps to a target."""

import numpy as np

from ir50p_lab.course.arm3d import ArmView, SideView, arm_points
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.errors import UnreachableError
from ir50p_lab.modelling.differential import jacobian
from ir50p_lab.modelling.ik import BRANCHES, inverse_kinematics

JOINT_COLOURS = tuple(COLOURS[name] for name in ("purple", "sky", "amber"))


class ColumnsView:
    """The arm in 3-D with three arrows at its tip: the tip velocity that each joint alone would give it.

    Args: ax: 3-D axes; arm: Arm; scale: m of arrow per m/s of tip at 1 rad/s.
    """

    def __init__(self, ax, arm, scale=0.5):
        self.arm, self._scale = arm, scale
        self.view = ArmView(ax, arm)
        # one line each: tail, head, a gap, and the number of the joint as a marker (a legend takes long to draw)
        self.arrows = [
            ax.plot(
                *np.zeros((3, 4)), color=colour, linewidth=3.5, marker=f"${k + 1}$", markevery=[3], ms=9, zorder=40
            )[0]
            for k, colour in enumerate(JOINT_COLOURS)
        ]

    def update(self, q):
        """Move the arm to q (3,) rad. Returns: Jv (3, 3) m/rad."""
        self.view.update(q)
        tip, Jv = self.view.points[3], jacobian(self.arm, q)[:3]
        for k, arrow in enumerate(self.arrows):
            head = tip + self._scale * Jv[:, k]
            beyond = head + 0.07 * self.arm.reach * Jv[:, k] / max(np.linalg.norm(Jv[:, k]), 1e-9)
            arrow.set_data_3d(*np.column_stack([tip, head, np.full(3, np.nan), beyond]))
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


class WayOutView:
    """The arm from the side on its way to full length, and beside it the rates that joints 2 and 3 need there.

    Args: arm: Arm; reach (n,) m: distances of the tip from the column, increasing; q (n, 3) rad and rates (n, 3) rad/s
    at these. Attributes: figure, to be shown with `live`.
    """

    def __init__(self, arm, reach, q, rates):
        self.figure = new_figure(9.5, 4.2, cols=2)
        plane, ax = self.figure.axes
        self._way = arm.reach, reach, q, np.abs(rates)
        self.side = SideView(plane, arm)
        ax.semilogy(reach, np.abs(rates[:, 1:]), label=["joint 2", "joint 3"])
        ax.set(xlabel="distance of the tip [m]", ylabel="joint rate [rad/s]")
        ax.set_title("0.1 m/s outwards needs ever faster joints")
        ax.legend(loc="upper left")
        (self.dots,) = ax.plot([0, 0], [1, 1], "o", color="black")

    def update(self, share):
        """Go to a share of the way, 0 to 100 %. Returns: a sentence, how far from the end and how fast joint 3."""
        end, reach, q, rates = self._way
        k = round(share / 100 * (len(reach) - 1))
        self.side.update(q[k])
        self.dots.set_data([reach[k]] * 2, rates[k, 1:])
        return f"{(end - reach[k]) * 1000:.2f} mm before the end: joint 3 at {rates[k, 2]:.2f} rad/s"


def workspace_figure(arm, q, outwards, heights):
    """Where tips came to lie (dots), in the plane of the arm, on the shell of all that its links can reach.

    Args: arm: Arm, drawn at q (3,) rad; outwards, heights (n,) m: of the tips; behind the column outwards is negative.
    Returns: LabFigure.
    """
    figure = new_figure(6.2, 5.4)
    ax = figure.axes[0]
    SideView(ax, arm, q)
    ax.plot(outwards, heights, ".", ms=2, color=COLOURS["green"], zorder=2)
    ax.set_title("The joint limits leave a part of the shell")
    return figure


class StepsView:
    """Distance to the target after each step of two searches, a plain and a damped one, on a logarithmic axis.

    Args: steps: how many. Attributes: figure, to be shown with `live`.
    """

    def __init__(self, steps=25):
        self.figure = new_figure(8, 4)
        ax, k = self.figure.axes[0], np.arange(steps)
        self.curves = [
            ax.semilogy(k, np.ones(steps), "o-", ms=4, label=label)[0] for label in ("plain step, no damping", "damped")
        ]
        ax.axhline(1e-16, color=COLOURS["dark"], linestyle="--", label="closed form: no steps at all")
        ax.set(xlabel="step [1]", ylabel="distance to the target [m]", ylim=(1e-17, 1e2))
        ax.set_title("Damping tames the start and slows the end")
        ax.legend(loc="upper right", ncols=3, fontsize=8)

    def update(self, plain, damped):
        """Show the distances (steps,) m; what is below 1e-16 m is drawn there."""
        for curve, distances in zip(self.curves, (plain, damped), strict=True):
            curve.set_ydata(np.maximum(distances, 1e-16))


class BranchesView:
    """One branch of the solutions for a target, with its frames; pale behind it the arm with the other elbow.

    The four branches are four sets of angles but two shapes: in the plane on the right both are drawn.

    Args: arm: Arm. Attributes: figure, with a 3-D and a 2-D axes, to be shown with `live`.
    """

    def __init__(self, arm):
        self.figure = new_figure(9.5, 4.8, cols=2, projection=["3d", None], width_ratios=(1.3, 1))
        space, plane = self.figure.axes
        self.arm = arm
        self.view = ArmView(space, arm, frames=(3,))
        self.ghost = ArmView(space, arm, ghost=True, colour=COLOURS["grey"])
        self.shapes = [
            SideView(plane, arm, colour=COLOURS["blue"]),
            SideView(plane, arm, colour=COLOURS["orange"], ghost=True),
        ]
        names = ((0.0, "left", "blue", "front/up, back/down"), (1.0, "right", "orange", "front/down, back/up"))
        for x, align, colour, text in names:  # a legend takes five times as long to draw
            plane.text(x, 1.02, text, color=COLOURS[colour], ha=align, transform=plane.transAxes)

    def aim(self, branch, heading, distance, height):
        """`update` for a target given by heading (deg), distance from the column and height (m)."""
        a = np.radians(heading)
        return self.update(np.array([distance * np.cos(a), distance * np.sin(a), height]), branch)

    def update(self, p, branch):
        """Show the poses for the target p (3,) m, with the named branch in full.

        Returns: a sentence: the joint angles and whether the limits allow them, or how far out of reach the target is.
        """
        self.view.target(p)
        self.shapes[0].target(np.hypot(p[0], p[1]), p[2])
        try:
            solutions = inverse_kinematics(self.arm, p)
        except UnreachableError as error:
            self._show(False)
            return f"out of reach by {error.distance:.3f} m"
        self._show(True)
        chosen = BRANCHES.index(branch)
        self.view.update(solutions[chosen])
        self.ghost.update(solutions[chosen ^ 1])
        heading = np.arctan2(p[1], p[0])
        for k, shape in enumerate(self.shapes):
            shape.update(solutions[k], heading)
            shape.set_alpha(1.0 if chosen in (k, 3 - k) else 0.3)
        angles = ", ".join(f"{angle:.1f}" for angle in np.degrees(solutions[chosen]))
        verdict = "within the limits" if solutions.within_limits[chosen] else "beyond a joint limit"
        return f"{branch}: q = ({angles}) deg, {verdict}"

    def _show(self, visible):
        for part in (self.view, self.ghost, *self.shapes):
            part.set_visible(visible)
