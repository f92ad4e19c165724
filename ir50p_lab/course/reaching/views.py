"""The figure of notebook 18: the looks of many arms as the camera sees them."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, subplots


def looks_figure(tips, goal, lens, names=("one look", "two looks")):
    """Draw tips (n, 2, 3) m about their goal (3,) m, as the lens (3,) m sees them and along its line.

    Returns: LabFigure.
    """
    line = (goal - lens) / np.linalg.norm(goal - lens)
    side = np.cross(line, (0, 0, 1)) / np.hypot(*line[:2])
    up = np.cross(side, line)
    figure, seen, along = subplots(9.6, 4.2, cols=2, note="simulated arms, rendered pictures")
    for ax, axes in ((seen, (side, up)), (along, (line, side))):
        off = 1000 * (tips - goal) @ np.transpose(axes)  # (n, 2, 2) mm
        for one in off:
            ax.plot(*one.T, color=COLOURS["grey"], lw=0.8)
        for k, (name, colour) in enumerate(zip(names, ("orange", "blue"), strict=True)):
            fill = COLOURS[colour] if k else "none"
            ax.plot(*off[:, k].T, "o", mfc=fill, color=COLOURS[colour], label=f"after {name}")
        ax.plot(0, 0, "+", color=COLOURS["dark"], ms=14)
        ax.set(xlim=(-22, 22), ylim=(-22, 22), aspect="equal")
    along.axhline(0, color=COLOURS["dark"], ls=":", lw=1)
    seen.set(xlabel="to the right [mm]", ylabel="upwards [mm]", title="As the camera sees them")
    along.set(xlabel="away from the camera [mm]", ylabel="to the right [mm]", title="Along the line of sight (dotted)")
    seen.legend(fontsize=8, loc="upper left")
    return figure
