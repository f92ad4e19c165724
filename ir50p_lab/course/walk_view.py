"""Pictures of notebook 01: a frame that walks up the arm motion by motion, an arm from a table, two tips."""

import numpy as np

from ir50p_lab import modelling
from ir50p_lab.course.arm3d import ArmView, FrameView
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import dh_table

_MOTIONS = ("turn theta about z", "shift d along z", "shift a along x", "turn alpha about x")


def walk(arm, q, dh_matrix=modelling.dh_matrix):
    """A frame that does the twelve motions from the base to the tip, for `live`.

    Args: arm: Arm; q: (3,) rad, in which it stands; dh_matrix: f(theta, d, a, alpha) -> (4, 4) that moves the frame.
    Returns: figure; f(motions) that shows so many of the twelve and returns a sentence.
    """
    figure = new_figure(7.5, 5.2, projection="3d")
    ArmView(figure.axes[0], arm, q, thickness=5)
    figure.axes[0].set_title("Four motions a joint carry frame 0 to frame 3")
    walker = FrameView(figure.axes[0], np.eye(4), length=0.3 * arm.reach)
    rows = dh_table(arm, q)  # theta, d, a, alpha a joint

    def go(motions):
        shares = np.clip(motions - np.arange(12), 0, 1).reshape(3, 4)
        T = np.eye(4)
        for row, share in zip(rows, shares, strict=True):
            T = T @ dh_matrix(*(row * share))
        walker.update(T)
        done = min(int(motions), 11)
        if motions == 0:
            return "frame 0: the base"
        return f"joint {done // 4 + 1}: {_MOTIONS[done % 4]}" if motions < 12 else "frame 3 has arrived at the tip"

    return figure, go


def arm_by_table(table, dh_matrix):
    """f(q) -> (4, 4, 4): frames of an arm given by its DH table, rows (theta offset, d, a, alpha), by `dh_matrix`."""

    def frames(q):
        T = [np.eye(4)]
        for angle, (offset, d, a, alpha) in zip(q, table, strict=True):
            T.append(T[-1] @ dh_matrix(angle + offset, d, a, alpha))
        return np.array(T)

    return frames


def two_tips(arm, q, right, wrong):
    """The arm at q with its tip where it is, and where a wrong formula says it is, both (3,) m: LabFigure."""
    figure = new_figure(7.5, 5.2, projection="3d")
    ax = figure.axes[0]
    ArmView(ax, arm, q)
    for p, colour, name in ((right, "green", "right"), (wrong, "orange", "as printed")):
        ax.plot(*np.transpose([p]), "o", color=COLOURS[colour], ms=9, zorder=50)
        ax.text(*(np.asarray(p) + 0.03), name, color=COLOURS[colour], weight="bold", zorder=51)
    ax.plot(*np.transpose([right, wrong]), "--", color=COLOURS["dark"], zorder=49)
    ax.set_title(f"The printed formula puts the tip {100 * np.linalg.norm(np.subtract(right, wrong)):.0f} cm off")
    return figure
