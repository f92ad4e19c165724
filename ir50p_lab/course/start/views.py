"""Pictures of notebook 00: a turn seen from above, the arm turned by the student's function, a speed."""

import numpy as np

from ir50p_lab.course.checking.calling import array_like
from ir50p_lab.course.draw import sketch
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.modelling.chain import frames


def from_above(angle):
    """Draw two points at distance 1, and where a turn by `angle` (rad) takes them. Returns: LabFigure."""
    figure, ax = sketch.from_above(5.2, title="From above: the waist turns counter-clockwise")
    circle = np.linspace(0, 2 * np.pi, 181)
    ax.plot(np.cos(circle), np.sin(circle), color=COLOURS["light"], zorder=1)
    for start, colour, name in ((0.0, "orange", "ahead"), (np.pi / 2, "blue", "to the left")):
        end = start + angle
        sketch.arc(ax, (0, 0), start, end, 0.35, colour)
        ax.plot([0, np.cos(start)], [0, np.sin(start)], "--", color=COLOURS[colour], alpha=0.6)
        ax.plot([0, np.cos(end)], [0, np.sin(end)], color=COLOURS[colour], linewidth=2.5)
        ax.plot(np.cos(start), np.sin(start), "o", mfc="white", color=COLOURS[colour], ms=9)
        ax.plot(np.cos(end), np.sin(end), "o", color=COLOURS[colour], ms=11)
        ax.annotate(name, (np.cos(start), np.sin(start)), (8, 8), textcoords="offset points", color=COLOURS[colour])
    ax.annotate("column", (0, 0), (-52, -16), textcoords="offset points")
    ax.set(adjustable="box", xlim=(-1.25, 1.45), ylim=(-1.25, 1.35))
    return figure


def turned_by(arm, rot_z):
    """Return f(q) -> (4, 4, 4): frames of the arm with its waist turned by `rot_z`, whether right or wrong.

    The rest of the frames is the course's.

    rot_z: f(angle) -> (3, 3); what is still `...` in it counts as 0.
    """

    def with_own_waist(q):
        waist = np.eye(4)
        waist[:3, :3] = array_like(np.eye(3), rot_z, q[0])
        level = frames(arm, [0.0, q[1], q[2]])
        return np.array([np.eye(4), *(waist @ T for T in level[1:])])

    return with_own_waist


def speed_over_time(run, joint, end=1.4):
    """Draw the speed of one joint (1 to 3) of a simulated run until `end` s. Returns: LabFigure.

    A line marks 63 % of its most.
    """
    figure, ax = subplots(8, 3.4)
    speed = run.qd[:, joint - 1]
    ax.plot(run.t, speed, label=f"joint {joint}", linewidth=2)
    ax.axhline((1 - np.exp(-1)) * speed.max(), color=COLOURS["dark"], linestyle="--", label="63 % of the top speed")
    ax.set(xlim=(0, end), ylim=(0, None), xlabel="time [s]", ylabel="speed [rad/s]")
    ax.set_xticks(np.arange(0, end + 0.01, 0.1))
    ax.set_xticks(np.arange(0, end + 0.01, 0.02), minor=True)
    ax.set_title("Simulated: a push from rest, and then nothing")
    ax.legend(loc="lower center")
    return figure
