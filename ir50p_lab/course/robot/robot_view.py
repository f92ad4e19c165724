"""The robot as a picture that shows which of its functions are the student's."""

from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.robot.catalogue import NOTEBOOKS, ORDER

_PARTS = {  # what of the robot a function makes, notebook by notebook: where its list begins in the drawing
    "column": (("00", "01"), (1.0, 1.4)),
    "joints": (("02", "03"), (1.75, 4.0)),
    "weight": (("04", "05"), (3.3, 1.7)),
    "motion": (("06", "07"), (4.35, 4.0)),
    "control": (("08", "09"), (-1.3, 4.0)),
    "bench": (("10",), (-1.3, 3.05)),
    "model": (("12", "13", "14", "15"), (-1.3, 2.1)),
    "eye": (("16", "17", "18"), (6.0, 3.2)),
}
_LINE = 0.23  # from one name to the next, in units of the drawing


def owned(whose):
    """Return a LabFigure of the robot's parts: green if the student's, amber if on loan, grey if the course's.

    Each square bears the name of its function, and the number of the notebook that asks for it.
    whose: "yours", "on loan" or "the course's" by the name of each function.
    """
    figure, ax = subplots(9.4, 5.0)
    colours = {"yours": COLOURS["green"], "on loan": COLOURS["amber"], "the course's": "#C4C4C4"}
    ax.plot([0.7, 0.7, 2.6, 6.0], [0, 1.6, 2.8, 1.5], color="#EEEEEE", linewidth=16, solid_capstyle="round", zorder=1)
    ax.plot([0.2, 1.2], [0, 0], color="#EEEEEE", linewidth=16, solid_capstyle="round", zorder=1)
    ax.plot([0.7, 2.6], [1.6, 2.8], "o", color="#E0E0E0", ms=22, zorder=2)
    ax.plot(6.6, 0.1, "o", color="#C8102E", ms=14)
    for part, (notebooks, (x, y)) in _PARTS.items():
        ax.text(x - 0.1, y, part, fontsize=10, weight="bold", color=COLOURS["dark"], zorder=4)
        names = [(number, name) for number in notebooks for name in NOTEBOOKS[number]]
        for k, (number, name) in enumerate(names, start=1):
            ax.plot(x, y - _LINE * k, "s", color=colours[whose[name]], mec="white", ms=10, zorder=3)
            label = f"{number} {name}"
            ax.text(x + 0.16, y - _LINE * k, label, fontsize=8, va="center", color=COLOURS["dark"], zorder=4)
    mine = sum(one == "yours" for one in whose.values())
    ax.set(xlim=(-1.5, 8.0), ylim=(-0.3, 4.3), aspect="equal")
    ax.set_axis_off()
    lent = sum(one == "on loan" for one in whose.values())
    lent = f", {lent} on loan" if lent else ""
    ax.set_title(f"{mine} of {len(ORDER)} functions are yours{lent}; each with its notebook's number")
    return figure
