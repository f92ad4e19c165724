"""Figures of notebook 18: the looks of many arms as the camera sees them, and balls that roll."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, subplots

_ARRIVED = 1.5  # s after which a followed ball has been caught up with


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


def follow_figure(logs, simulated):
    """Draw followed balls: the table from above for the first FollowLog; how far ahead each tip is.

    Returns: LabFigure.
    """
    import pandas as pd

    note = "rendered pictures, simulated arm" if simulated else "real arm"
    figure, above, time = subplots(9.5, 4.0, cols=2, width_ratios=(1, 1.6), note=note)
    above.plot(*(1e3 * logs[0].ball.T), color="#C8202D", label="ball, as seen")
    settled = logs[0].t > _ARRIVED
    above.plot(*(1e3 * logs[0].tip[settled, :2].T), ".", ms=2, color=COLOURS["blue"], label="tip")
    above.set(xlabel="x [mm]", ylabel="y [mm]", title=f"From above, lead {logs[0].lead:g} s")
    above.set_aspect("equal", adjustable="datalim")
    above.legend(fontsize=8)
    for log, colour in zip(logs, (COLOURS["blue"], COLOURS["orange"]), strict=True):
        settled = log.t > _ARRIVED
        t, ahead = log.t[settled], 1e3 * log.ahead[settled]
        time.plot(t, ahead, ".", ms=2, color=colour, alpha=0.35)
        smooth = pd.Series(ahead).rolling(31, center=True, min_periods=1).mean()
        time.plot(t, smooth, color=colour, lw=2, label=f"lead {log.lead:g} s")
        time.plot(t, 1e3 * log.lead * log.speed[settled], color=colour, lw=1.2, ls="--")
    time.plot([], [], color=COLOURS["dark"], lw=1.2, ls="--", label="lead × speed")
    time.axhline(0, color=COLOURS["dark"], lw=0.8)
    time.set(xlabel="t [s]", ylabel="tip before the ball [mm]", title="A lead puts the tip before the ball")
    time.legend(fontsize=8, loc="upper center", ncols=len(logs) + 1)
    low, high = time.get_ylim()
    time.set_ylim(low, high + 0.15 * (high - low))
    return figure
