"""What sketches of the arm in a plane are made of: lines, names, angles; and the plane seen from above."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, subplots


def line(ax, points, style="-", colour="dark", **options):
    """Draw a line through points (n, 2) in matplotlib's style. Returns it."""
    return ax.plot(*np.transpose(points), style, color=COLOURS[colour], **options)[0]


def name(ax, place, text, colour="dark"):
    """Write a word centred on a place (2,), above everything else there."""
    box = {"fc": "w", "ec": "w", "pad": 1}
    ax.text(*place, text, color=COLOURS[colour], size=12, ha="center", va="center", bbox=box, zorder=6)


def arc(ax, centre, start, end, radius, colour, text="", out=1.35, *, arrow=True):
    """Draw an angle from start to end (rad), with its name at `out` radii; an angle that has a sign gets an arrow."""
    angles = np.linspace(start, end, 40)
    points = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    line(ax, points, "-", colour, linewidth=2)
    if arrow:
        style = {"arrowstyle": "-|>", "color": COLOURS[colour], "mutation_scale": 16, "shrinkB": 0}
        ax.annotate("", points[-1], points[-5], arrowprops=style)
    name(ax, centre + out * (points[20] - centre), text, colour)


def from_above(width=7.2, height=5.0, title="From above"):
    """Draw the table seen from above, with the column of the arm. Returns: LabFigure, with axes in m."""
    figure, ax = subplots(width, height)
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=12)
    ax.set(aspect="equal", adjustable="datalim", xlabel="x, ahead [m]", ylabel="y, to the left [m]", title=title)
    return figure, ax
