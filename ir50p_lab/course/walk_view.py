"""Pictures of notebook 01: a frame that walks up the arm motion by motion, an arm from a table, a printed tip."""

import numpy as np

from ir50p_lab.course.arm3d import ArmView, FrameView
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling import chain

_MOTIONS = ("turn theta about z", "shift d along z", "shift a along x", "turn alpha about x")


def walk(arm, q):
    """A frame that does the twelve motions from the base to the tip, for `live`.

    Args: arm: Arm; q: (3,) rad, in which it stands.
    Returns: figure; f(motions) that shows so many of the twelve and returns a sentence.
    """
    figure = new_figure(7.5, 5.2, projection="3d")
    ArmView(figure.axes[0], arm, q, thickness=5)
    figure.axes[0].set_title("Four motions a joint carry frame 0 to frame 3")
    figure.axes[0].view_init(elev=22, azim=-30)  # no axis of the walker hides another
    walker = FrameView(figure.axes[0], np.eye(4), length=0.3 * arm.reach)
    rows = chain.dh_table(arm, q)  # theta, d, a, alpha a joint

    def go(motions):
        shares = np.clip(motions - np.arange(12), 0, 1).reshape(3, 4)
        T = np.eye(4)
        for row, share in zip(rows, shares, strict=True):
            T = T @ chain.dh_matrix(*(row * share))
        walker.update(T)
        if motions in (0, 12):
            return "frame 3 has arrived at the tip" if motions else "frame 0: the base. What comes first?"
        last = int(np.ceil(motions)) - 1
        done = ", done. What comes next?" if motions == last + 1 else ""
        return f"joint {last // 4 + 1}: {_MOTIONS[last % 4]}{done}"

    return figure, go


def arm_by_table(table, dh_matrix):
    """f(q) -> (4, 4, 4): frames of an arm given by its DH table, rows (d, a, alpha), by `dh_matrix`; theta is q.

    What is still `...` in the table counts as 0.
    """

    def frames(q):
        T = [np.eye(4)]
        for theta, row in zip(q, table, strict=True):
            T.append(T[-1] @ dh_matrix(theta, *(0 if one is ... else one for one in row)))
        return np.array(T)

    return frames


def printed_tip(arm, q):
    """The tip of (1.31) as printed, y = cos q1 (...), beside the right one: from above, and over the waist: LabFigure.

    arm: Arm; q: (3,) rad.
    """
    waist = np.radians(np.arange(-180, 181))
    x, y = chain.forward_kinematics(arm, q)[:2]
    rho = np.hypot(x, y)
    right, printed = rho * np.array([np.cos(waist), np.sin(waist)]), rho * np.array([np.cos(waist)] * 2)
    figure = new_figure(9.6, 4.4, cols=2)
    above, error = figure.axes
    above.plot(*right, color=COLOURS["green"], label="right, at every waist angle")
    above.plot(*printed, color=COLOURS["orange"], label="as printed, at every waist angle")
    above.plot([0, x], [0, y], color=COLOURS["blue"], linewidth=6, solid_capstyle="round", label="the arm")
    above.plot([x, x], [y, x], "--", color=COLOURS["dark"])
    above.plot(x, y, "o", color=COLOURS["green"], ms=10)
    above.plot(x, x, "o", color=COLOURS["orange"], ms=10)
    above.set(aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]", title="Where the tip is, from above")
    above.set_ylim(-1.8 * rho, 1.15 * rho)
    above.legend(loc="lower center", fontsize=8)
    off = np.linalg.norm(right - printed, axis=0)
    error.plot(np.degrees(waist), off, color=COLOURS["dark"])
    error.plot(np.degrees(q[0]), abs(x - y), "o", color=COLOURS["orange"], ms=10)
    error.set(xticks=range(-180, 181, 45), xlabel="waist [deg]", ylabel="printed tip is off by [m]", ylim=(0, None))
    error.set_title("How far apart they are")
    return figure
