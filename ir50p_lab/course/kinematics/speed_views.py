"""Pictures of notebook 03: arrows of the joints, the way out, where joints are too slow, steps to a place."""

import numpy as np
from matplotlib.patches import Circle

from ir50p_lab.course.draw.arm3d import ArmView, SideView
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.modelling.differential import jacobian
from ir50p_lab.modelling.ik import inverse_kinematics

_JOINTS, _NAMES = ("purple", "sky", "amber"), ("waist", "shoulder", "elbow")


class ColumnsView:
    """The arm in 3-D with three arrows at its tip: the tip velocity that each joint alone would give it.

    Half a metre of arrow stands for 1 m/s of the tip at 1 rad/s.

    Args: ax: 3-D axes; arm: Arm; aside: m by which the third arrow is moved if it would lie on the second.
    """

    def __init__(self, ax, arm, aside=0.0):
        self.arm, self._aside = arm, aside
        self.view = ArmView(ax, arm)
        azimuth, elevation = np.radians([ax.azim, ax.elev])
        self._to_eye = [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
        # one line each: tail, head, barbs, a gap, and the number of the joint as a marker (a legend takes long to draw)
        style = {"linewidth": 3, "markevery": [6], "ms": 9, "zorder": 40}
        self.arrows = [
            ax.plot(*np.zeros((3, 7)), color=COLOURS[name], marker=f"${k + 1}$", **style)[0]
            for k, name in enumerate(_JOINTS)
        ]

    def update(self, q, Jv=None):
        """Move the arm to q (3,) rad. Jv: (3, 3) m/rad, by default the arm's own. Returns Jv."""
        self.view.update(q)
        tip, Jv = self.view.points[3], jacobian(self.arm, q)[:3] if Jv is None else Jv
        for k, arrow in enumerate(self.arrows):
            along = 0.5 * Jv[:, k]
            start = tip + np.array([self._aside * (k == 2), 0, 0])
            head = start + along
            side = np.cross(along, self._to_eye)
            barbs = [head - 0.15 * along + sign * 0.07 * side for sign in (1, -1)]
            beyond = head + 0.07 * self.arm.reach * Jv[:, k] / max(np.linalg.norm(Jv[:, k]), 1e-9)
            arrow.set_data_3d(*np.column_stack([start, head, barbs[0], head, barbs[1], np.full(3, np.nan), beyond]))
        return Jv


def arrows(arm, q, J):
    """Draw the arm at q and the columns of J (3, 3) m/rad at its tip, one arrow per joint. Returns: LabFigure."""
    figure, ax = subplots(7.5, 5.0, projection="3d")
    ColumnsView(ax, arm, aside=0.02).update(q, J)
    ax.set_title("Where the tip goes if joint 1, 2 or 3 turns (arrows drawn at half length)")
    return figure


def arrows_panel(arm):
    """Draw the same for any shoulder and elbow, for `live`. Returns: figure, f(q2, q3) in degrees -> sentence."""
    figure, ax = subplots(7.5, 5.2, projection="3d")
    ax.set_title("One arrow for each joint: its share of the tip's velocity")
    columns = ColumnsView(ax, arm)

    def turn(q2, q3):
        J = columns.update(np.radians([-30.0, q2, q3]))
        across, along = np.linalg.norm(np.cross(J[:, 1], J[:, 2])), J[:, 1] @ J[:, 2]
        return f"arrows 2 and 3 are {np.degrees(np.arctan2(across, along)):.0f} degrees apart"

    return figure, turn


def way_out(arm, distances, speeds, limit):
    """Draw the arm from the side near its full reach, and the elbow's speed while it goes there. Returns: LabFigure."""
    figure, plane, ax = subplots(9.5, 4.0, cols=2)
    halfway = distances[len(distances) // 2]
    SideView(plane, arm, inverse_kinematics(arm, [halfway, 0, arm.l[0]])["front/up"])
    plane.annotate("", (halfway + 0.13, arm.l[0]), (halfway + 0.02, arm.l[0]), arrowprops={"color": COLOURS["orange"]})
    plane.set(xlabel="outwards from the column [m]", title="Outwards at 0.1 m/s")
    still_to_go = 1000 * (arm.reach - distances)
    ax.plot(still_to_go, speeds, linewidth=2.5, label="elbow")
    ax.axhline(limit, **SETPOINT, label=f"its motor: {limit} rad/s")
    ax.set(xlim=(still_to_go[0], 0), xlabel="still to go to the full reach [mm]")
    ax.set(ylim=(0, None), ylabel="speed [rad/s]", title="The tip keeps its pace, the elbow runs away")
    ax.legend(loc="upper left")
    return figure


def pace_along(paces, busiest):
    """Draw the pace (n,) m/s along a path in the colour of the joint (n,), 0 to 2, that sets it. Returns: LabFigure."""
    figure, ax = subplots(7.5, 3.2)
    share = np.linspace(0, 100, len(paces))
    for joint, (name, colour) in enumerate(zip(_NAMES, _JOINTS, strict=True)):
        part = np.where(np.array(busiest) == joint, paces, np.nan)
        if np.isfinite(part).any():
            ax.plot(share, part, linewidth=3, color=COLOURS[colour], label=f"the {name} sets it")
    ax.set(xlabel="share of the line [%]", ylabel="pace [m/s]", ylim=(0, None))
    ax.legend(loc="lower left")
    return figure


def where_not(arm, tips, rates, limit):
    """Draw where in the arm's vertical plane a joint, and which, would exceed limit rad/s. Returns: LabFigure.

    tips: (n, m, 3) m of a grid of poses; rates: (n, m, 3) rad/s, what each joint needs there at worst.
    """
    figure, ax = subplots(6.4, 5.6)
    x, z = tips[..., 0], tips[..., 2]
    ax.contourf(x, z, rates.max(axis=2), levels=[0, limit], colors=["#E6F0F7"])
    for joint, (name, colour) in enumerate(zip(_NAMES, _JOINTS, strict=True)):
        others = np.delete(rates, joint, axis=2).max(axis=2)
        ax.contourf(x, z, rates[..., joint] - np.maximum(others, limit), levels=[0, np.inf], colors=COLOURS[colour])
        ax.plot([], [], "s", color=COLOURS[colour], ms=10, label=f"{joint + 1}, {name}")
    ax.plot([], [], "s", color="#E6F0F7", ms=10, label="every direction open")
    stop = np.abs([arm.q_min[2], arm.q_max[2]]).max()
    if stop < np.pi:
        nearest = np.hypot(arm.l[1] + arm.l[2] * np.cos(stop), arm.l[2] * np.sin(stop))
        ax.add_patch(Circle((0, arm.l[0]), nearest, fill=False, label="elbow at its stop", **SETPOINT))
    ax.plot([0, 0], [0, arm.l[0]], color=COLOURS["dark"], linewidth=8, solid_capstyle="butt", label="column")
    ax.set(aspect="equal", xlabel="outwards [m]", ylabel="height [m]", title="The joint that is too slow for 0.1 m/s")
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def steps_panel(damped_step, arm, q_start, p, steps=40):
    """Draw the miss and the elbow after each step towards p (3,) m from q_start, for `live`.

    Returns: figure, f(damping, start) -> sentence; start: the elbow's angle, in degrees, in place of that of q_start.
    """
    figure, misses, elbows = subplots(9.4, 3.8, cols=2)
    (miss,) = misses.semilogy(np.ones(steps + 1), "o-", ms=4)
    (elbow,) = elbows.plot(np.zeros(steps + 1), "o-", ms=4, color=COLOURS["orange"])
    misses.axhline(1e-3, **SETPOINT)
    elbows.axhline(-90, **SETPOINT)
    misses.set(xlabel="step", ylabel="distance to the place [m]", ylim=(1e-5, 10), title="The tip (dashed: 1 mm)")
    elbows.set(xlabel="step", ylabel="elbow [deg]", ylim=(-200, 40), title="The elbow (dashed: the cable)")

    def search(damping, start):
        q, path = np.array([*q_start[:2], np.radians(start)]), []
        for _ in range(steps + 1):
            path.append(q)
            q = damped_step(q, p, arm.l, max(damping, 1e-9))
        path = np.array(path)
        left = np.linalg.norm(forward_kinematics(arm, path) - p, axis=1)
        miss.set_ydata(np.maximum(left, 1e-12))
        elbow.set_ydata(np.degrees(path[:, 2]))
        arrived = np.flatnonzero(left < 1e-3)
        lowest, highest = np.degrees([path[:, 2].min(), path[:, 2].max()])
        end = f"within 1 mm after {arrived[0]} steps" if len(arrived) else f"in the end {1000 * left[-1]:.3g} mm away"
        return f"{end}; the elbow was between {lowest:.0f} and {highest:.0f} degrees"

    return figure, search
