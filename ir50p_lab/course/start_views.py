"""Pictures of notebook 00: a turn seen from above, the arm turned by the student's function, speeds, what is owned."""

import numpy as np

from ir50p_lab.course import my_robot
from ir50p_lab.course.functions.catalogue import NOTEBOOKS, ORDER
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.pose import homogeneous


def from_above(angle):
    """Two points at distance 1 and where a turn by `angle` (rad) takes them: LabFigure."""
    figure = new_figure(5.2, 5.0)
    ax = figure.axes[0]
    circle = np.linspace(0, 2 * np.pi, 181)
    ax.plot(np.cos(circle), np.sin(circle), color=COLOURS["light"], zorder=1)
    for start, colour, name in ((0.0, "orange", "ahead"), (np.pi / 2, "blue", "to the left")):
        end = start + angle
        arc = np.linspace(start, end, 40)
        ax.plot(0.35 * np.cos(arc), 0.35 * np.sin(arc), color=COLOURS[colour])
        ax.plot([0, np.cos(start)], [0, np.sin(start)], "--", color=COLOURS[colour], alpha=0.6)
        ax.plot([0, np.cos(end)], [0, np.sin(end)], color=COLOURS[colour], linewidth=2.5)
        ax.plot(np.cos(start), np.sin(start), "o", mfc="white", color=COLOURS[colour], ms=9)
        ax.plot(np.cos(end), np.sin(end), "o", color=COLOURS[colour], ms=11)
        ax.annotate(name, (np.cos(start), np.sin(start)), (8, 8), textcoords="offset points", color=COLOURS[colour])
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=9)
    ax.annotate("column", (0, 0), (-52, -16), textcoords="offset points")
    ax.set(xlim=(-1.25, 1.45), ylim=(-1.25, 1.35), aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]")
    ax.set_title("From above: the waist turns counter-clockwise")
    return figure


def turned_by(arm):
    """f(q) -> (4, 4, 4): frames of the arm with its waist turned by `my_robot.rot_z`, the rest the course's."""

    def with_own_waist(q):
        level = frames(arm, [0.0, q[1], q[2]])
        waist = homogeneous(my_robot.rot_z(q[0]), np.zeros(3))
        return np.array([np.eye(4), *(waist @ T for T in level[1:])])

    return with_own_waist


def speed_over_time(*runs, joint, labels=None):
    """Speed of one joint (1 to 3) of simulated runs: LabFigure."""
    figure = new_figure(8, 3.4)
    ax = figure.axes[0]
    for run, label in zip(runs, labels or [f"joint {joint}"], strict=True):
        ax.plot(run.t, run.qd[:, joint - 1], label=label, linewidth=2)
    ax.set(xlim=(0, runs[0].t[-1]), ylim=(0, None), xlabel="time [s]", ylabel="speed [rad/s]")
    ax.set_xticks(np.arange(0, runs[0].t[-1] + 0.01, 0.1))
    ax.set_title("Simulated: a constant push from rest")
    ax.legend(loc="lower right")
    return figure


_PARTS = {  # what of the robot a function makes, notebook by notebook: where its mark stands in the drawing
    "column": (("00", "01"), (0.18, 1.1)),
    "joints": (("02", "03"), (0.9, 2.75)),
    "weight": (("04", "05"), (1.75, 2.0)),
    "motion": (("06", "07"), (2.75, 2.35)),
    "control": (("08", "09"), (-1.1, 1.05)),
    "bench": (("10",), (-1.1, 0.45)),
    "model": (("12", "13", "14", "15"), (-1.1, 1.65)),
    "eye": (("16", "17", "18"), (3.5, 3.1)),
}


def owned():
    """The robot with its parts: green what is the student's, amber what is on loan, grey the course's. LabFigure."""
    figure = new_figure(8.6, 3.9)
    ax = figure.axes[0]
    whose = {name: my_robot.whose(name) for name in ORDER}
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
    ax.set(xlim=(-1.4, 4.9), ylim=(-0.3, 3.5), aspect="equal")
    ax.set_axis_off()
    lent = sum(one == "on loan" for one in whose.values())
    ax.set_title(f"{mine} of {len(ORDER)} functions are yours{f', {lent} on loan' if lent else ''}; a square each")
    return figure
