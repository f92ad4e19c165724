"""The robot as a picture: which of its functions are the student's."""

from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.robot.catalogue import NOTEBOOKS, ORDER

_PARTS = {  # what of the robot a function makes, notebook by notebook: where its mark stands in the drawing
    "column": (("00", "01"), (0.18, 1.1)),
    "joints": (("02", "03"), (0.9, 3.0)),
    "weight": (("04", "05"), (1.3, 1.6)),
    "motion": (("06", "07"), (2.3, 2.55)),
    "control": (("08", "09"), (-1.5, 1.05)),
    "bench": (("10",), (-1.5, 0.45)),
    "model": (("12", "13", "14", "15"), (-1.5, 1.65)),
    "eye": (("16", "17", "18"), (3.5, 3.1)),
}


def owned(whose):
    """The robot with its parts: green what is the student's, amber what is on loan, grey the course's: LabFigure.

    whose: "yours", "on loan" or "the course's" by the name of each function.
    """
    figure, ax = subplots(8.6, 3.9)
    colours = {"yours": COLOURS["green"], "on loan": COLOURS["amber"], "the course's": "#C4C4C4"}
    ax.plot([0, 0, 1.1, 2.9], [0, 1.6, 2.6, 1.9], color="#E4E4E4", linewidth=16, solid_capstyle="round", zorder=1)
    ax.plot([-0.5, 0.5], [0, 0], color="#E4E4E4", linewidth=16, solid_capstyle="round", zorder=1)
    ax.plot([0, 1.1], [1.6, 2.6], "o", color="#D0D0D0", ms=22, zorder=2)
    ax.plot(3.5, 0.1, "o", color="#C8102E", ms=14)
    for part, (notebooks, (x, y)) in _PARTS.items():
        names = [name for number in notebooks for name in NOTEBOOKS[number]]
        for k, name in enumerate(names):
            ax.plot(x + 0.2 * k, y, "s", color=colours[whose[name]], mec="white", ms=10, zorder=3)
        ax.annotate(part, (x, y), (-4, 9), textcoords="offset points", fontsize=9, color=COLOURS["dark"], zorder=4)
    mine = sum(one == "yours" for one in whose.values())
    ax.set(xlim=(-1.8, 4.7), ylim=(-0.3, 3.5), aspect="equal")
    ax.set_axis_off()
    lent = sum(one == "on loan" for one in whose.values())
    ax.set_title(f"{mine} of {len(ORDER)} functions are yours{f', {lent} on loan' if lent else ''}; a square each")
    return figure
