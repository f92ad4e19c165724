"""Pictures of notebook 00: a turn seen from above, the arm turned by the student's function, a speed, the whole way."""

import numpy as np

from ir50p_lab.course import lab_book
from ir50p_lab.course.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.chain import frames

#: How a notebook goes to the ball, and the name under which the lab book has it: `ball.miss.NAME`, `ball.seconds.NAME`.
_WAYS = {
    "00  your hand": "by_hand",
    "00  one turn of the waist": "by_turn",
    "00  one push of the waist": "by_push",
    "01  three angles, guessed": "by_guess",
    "02  your formula": "by_formula",
    "08  your controller": "by_pid",
    "18  a picture": "by_camera",
}


def from_above(angle):
    """Two points at distance 1 and where a turn by `angle` (rad) takes them: LabFigure."""
    figure, ax = subplots(5.2, 5.0)
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


def turned_by(arm, rot_z):
    """f(q) -> (4, 4, 4): frames of the arm with its waist turned by `rot_z`, right or wrong; the rest is the course's.

    rot_z: f(angle) -> (3, 3); what is still `...` in it counts as 0.
    """

    def with_own_waist(q):
        waist, R = np.eye(4), np.asarray(rot_z(q[0]))
        waist[:3, :3] = np.where(R == ..., 0, R)
        level = frames(arm, [0.0, q[1], q[2]])
        return np.array([np.eye(4), *(waist @ T for T in level[1:])])

    return with_own_waist


def speed_over_time(run, joint, end=1.4):
    """Speed of one joint (1 to 3) of a simulated run until `end` s, with a line at 63 % of its most: LabFigure."""
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


def so_far():
    """How far each notebook misses the ball's place, and how long it took, from the student's lab book: LabFigure.

    What is not done yet has an empty row; a miss below 0.01 mm stands at 0.01.
    """
    book = lab_book.read()["predictions"]
    figure, ax = subplots(7.5, 3.4)
    for row, name in enumerate(_WAYS.values()):
        miss, seconds = (book.get(f"ball.{what}.{name}", {}).get("truth") for what in ("miss", "seconds"))
        if miss is None:
            ax.annotate("not yet", (0.012, row), va="center", color=COLOURS["grey"])
            continue
        place = np.clip(miss, 0.01, 1000)
        ax.plot(place, row, "o", ms=9, color=COLOURS["orange"])
        said = f"{miss:.3g} mm" + (f", {seconds:.2g} s" if seconds else "")
        ax.annotate(said, (place, row), (9, 0), textcoords="offset points", va="center")
    ax.axvline(30, label="the ball's radius", **SETPOINT)
    ax.set(xscale="log", xlim=(0.007, 6000), ylim=(len(_WAYS) - 0.5, -0.5), xlabel="miss [mm]")
    ax.set_yticks(range(len(_WAYS)), _WAYS)
    ax.set_title("The ball at (0.42, −0.15, 0.03) m: by how much is its place missed?")
    ax.legend(loc="lower right")
    return figure
