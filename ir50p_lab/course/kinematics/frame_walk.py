"""Pictures of notebook 01: a frame that walks up the arm motion by motion, an arm from a table."""

import numpy as np

from ir50p_lab.course.draw.arm3d import ArmView, FrameView
from ir50p_lab.course.draw.style import new_figure
from ir50p_lab.modelling.chain import dh_matrix, dh_table

_MOTIONS = ("turn about z", "shift along z", "shift along x", "turn about x")


def walk(arm, q):
    """Draw a frame that does the twelve motions from the base to the tip, for `live`.

    Args: arm: Arm; q: (3,) rad, the pose of the arm.
    Returns: figure; f(motions) that shows so many of the twelve, names the last in the title, and asks for the next.
    """
    figure = new_figure(7.5, 5.2, projection="3d")
    ArmView(figure.axes[0], arm, q, thickness=5)
    figure.axes[0].view_init(elev=22, azim=-30)  # no axis of the walker hides another
    for line in figure.axes[0].lines:
        line.set_alpha(0.25)  # links and axes of frames have the same colours
    walker = FrameView(figure.axes[0], np.eye(4), length=0.3 * arm.reach)
    rows = dh_table(arm, q)  # theta, d, a, alpha a joint

    def go(motions):
        shares = np.clip(motions - np.arange(12), 0, 1).reshape(3, 4)
        T = np.eye(4)
        for row, share in zip(rows, shares, strict=True):
            T = T @ dh_matrix(*(row * share))
        walker.update(T)
        joint, motion = divmod(max(int(np.ceil(motions)) - 1, 0), 4)
        what = f"joint {joint + 1}, motion {motion + 1} of 4: {_MOTIONS[motion]}" if motions else "frame 0, at the base"
        figure.axes[0].set_title(what)
        ends = {0: "What comes first?", 12: "Frame 3 has arrived at the tip."}
        return ends.get(motions, "Done. What comes next?" if motions == int(motions) else "")

    return figure, go


def chain(q, table, dh_matrix=dh_matrix):
    """Return the frames (n + 1, 4, 4), base first, of an arm given by its DH table.

    table: rows (d, a, alpha); q: (n,) theta, rad.

    What is still `...` in the table counts as 0.
    """
    T = [np.eye(4)]
    for theta, row in zip(q, table, strict=True):
        T.append(T[-1] @ dh_matrix(theta, *(0 if one is ... else one for one in row)))
    return np.array(T)


def arm_by_table(table, dh_matrix):
    """Return f(q): the frames of the `chain` of this table by this `dh_matrix`."""
    return lambda q: chain(q, table, dh_matrix)
