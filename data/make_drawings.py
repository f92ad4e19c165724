"""Drawings in `data/drawings/` that never change: block diagrams, a ruler, a lever.

`python -m data.make_drawings` writes the SVG files again.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.colors import rgb_to_hsv
from matplotlib.patches import FancyBboxPatch

from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots

_ARROW = {"arrowstyle": "-|>", "color": COLOURS["dark"], "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}


def _sheet(width, height):
    figure, ax = subplots(width, height)
    ax.set(xlim=(0, width), ylim=(0, height), aspect="equal")
    ax.set_axis_off()
    return figure, ax


def _box(ax, x, y, text, *, width=1.2, height=0.6, colour="dark"):
    """A block about (x, y)."""
    style = {"boxstyle": "square,pad=0", "facecolor": "white", "edgecolor": COLOURS[colour], "linewidth": 1.8}
    ax.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height, zorder=5, **style))
    ax.text(x, y, text, ha="center", va="center", fontsize=11, color=COLOURS[colour], zorder=6)


def _wire(ax, *points, colour="dark"):
    """A line through points, with an arrow at its end."""
    ax.plot(*np.transpose(points), color=COLOURS[colour], linewidth=1.4)
    ax.annotate("", points[-1], points[-2], arrowprops=_ARROW | {"color": COLOURS[colour]})


def _sum(ax, x, y, *signs):
    """A circle where signals are added; signs: (dx, dy, text)."""
    ax.plot(x, y, "o", ms=15, mfc="white", mec=COLOURS["dark"], mew=1.6)
    for dx, dy, text in signs:
        ax.text(x + dx, y + dy, text, ha="center", va="center", fontsize=11)


def one_loop():
    """A joint under its PID: error, three parts, limit, arm, and the way back (Figure 2.1): LabFigure.

    D is drawn as the class has it: from the speed wanted and the angle measured and filtered, not from the error; the
    limit tells I when to rest.
    """
    figure, ax = _sheet(9.4, 3.6)
    middle, low = 2.2, 0.25
    ax.text(0.15, middle + 0.15, "$q_d$", fontsize=13)
    _wire(ax, (0.1, middle), (0.95, middle))
    _sum(ax, 1.1, middle, (-0.27, 0.24, "+"), (0.2, -0.3, "\u2212"))
    _wire(ax, (1.25, middle), (2.35, middle))
    _wire(ax, (2.0, middle), (2.0, 3.2), (2.35, 3.2))
    ax.text(1.55, middle + 0.15, "$e$", fontsize=13)
    ax.text(0.15, 1.35, r"$\dot q_d$", fontsize=13)
    _wire(ax, (0.1, 1.2), (2.1, 1.2))
    parts = (("P:  $K_p e$", "blue"), (r"I:  $K_i\int e\,dt$", "orange"), (r"D:  $K_d(\dot q_d - \dot q)$", "green"))
    for (text, colour), y in zip(parts, (3.2, 2.2, 1.2), strict=True):
        _box(ax, 3.15, y, text, width=1.6 if colour != "green" else 2.1, colour=colour)
    for y, right in ((3.2, 3.95), (1.2, 4.2)):
        _wire(ax, (right, y), (4.6, y), (4.6, middle + np.sign(y - middle) * 0.15))
    _wire(ax, (3.95, middle), (4.45, middle))
    _sum(ax, 4.6, middle)
    _wire(ax, (4.75, middle), (5.3, middle))
    _box(ax, 5.85, middle, "limit", width=1.1)
    _wire(ax, (6.4, middle), (7.15, middle))
    ax.text(6.65, middle + 0.15, "$u$", fontsize=13)
    _box(ax, 7.75, middle, "arm")
    _wire(ax, (8.35, middle), (9.3, middle))
    ax.text(8.9, middle + 0.15, "$q$", fontsize=13)
    _wire(ax, (8.75, middle), (8.75, low), (1.1, low), (1.1, middle - 0.15))
    _wire(ax, (5.85, 2.5), (5.85, 2.85), (3.55, 2.85), (3.55, 2.5))
    ax.text(4.72, 2.93, "at the limit: rest", fontsize=9, color=COLOURS["orange"])
    _wire(ax, (3.15, low), (3.15, 0.38))
    _wire(ax, (3.15, 0.76), (3.15, 0.9))
    _box(ax, 3.15, 0.57, "speed, filtered", width=1.7, height=0.38, colour="green")
    ax.plot([2.0, 3.15, 8.75], [middle, low, middle], "o", ms=5, color=COLOURS["dark"])
    return figure


def three_loops():
    """Three controllers that know nothing of each other, and one arm that couples them (Figure 2.2): LabFigure."""
    figure, ax = _sheet(8.4, 4.0)
    for joint, (y, colour) in enumerate(zip((3.3, 2.15, 1.0), ("blue", "orange", "green"), strict=True), start=1):
        ax.text(0.1, y + 0.13, rf"$q_{{d{joint}}}$", fontsize=12)
        _wire(ax, (0.1, y), (2.1, y))
        _box(ax, 2.85, y, f"controller {joint}", width=1.5, colour=colour)
        _wire(ax, (3.6, y), (4.9, y))
        ax.text(4.15, y + 0.13, f"$u_{joint}$", fontsize=12)
        _wire(ax, (6.5, y), (8.3, y))
        ax.text(7.95, y + 0.13, f"$q_{joint}$", fontsize=12)
        right, low, left = 8.0 - 0.3 * joint, -0.05 + 0.17 * joint, 0.9 + 0.27 * joint  # each its own way round
        way = ((right, y), (right, low), (left, low), (left, y - 0.18), (2.1, y - 0.18))
        _wire(ax, *way, colour=colour)
        ax.plot(right, y, "o", ms=5, color=COLOURS[colour])
    _box(ax, 5.7, 2.15, "one arm:\nwhat one joint\ndoes, the others\nfeel", width=1.6, height=3.0)
    return figure


def axis_and_lever():
    """A point that turns about an axis, two levers from the axis to it, and its one velocity. LabFigure."""
    figure, ax = subplots(5.0, 3.2, projection="3d")
    circle = np.linspace(0, 2 * np.pi, 91)
    ax.plot(np.cos(circle), np.sin(circle), 0, color=COLOURS["light"])
    point = np.array([np.cos(-2.2), np.sin(-2.2), 0])
    arrows_of = (
        ((0, 0, -0.3), (0, 0, 1.5), "dark", "axis", (0.08, 0, 0.95)),
        ((0, 0, 0), point, "blue", "lever", 0.55 * point + [0, 0, -0.2]),
        ((0, 0, 0.8), point - [0, 0, 0.8], "purple", "another lever", 0.75 * point + [-0.85, -0.45, 0.4]),
        (point, (-point[1], point[0], 0), "orange", "velocity", (0.25, -1.1, -0.12)),
    )
    for start, along, colour, name, place in arrows_of:
        ax.quiver(*start, *along, color=COLOURS[colour], linewidth=3, arrow_length_ratio=0.12)
        ax.text(*place, name, color=COLOURS[colour], fontsize=12, weight="bold")
    ax.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-0.4, 1.2))
    ax.set_box_aspect((2, 2, 1.6), zoom=1.4)
    ax.set_axis_off()
    ax.view_init(elev=28, azim=-60)
    return figure


def ruler():
    """The four figures of a step, drawn on a made-up one: LabFigure."""
    figure, ax = subplots(8.0, 3.4)
    t = np.linspace(0, 5, 501)
    q = 0.97 - 0.97 * np.exp(-1.3 * t) * (np.cos(3 * t) + 0.43 * np.sin(3 * t))
    band = 0.06  # drawn wide, to be seen
    rise, settled = t[[np.argmax(q > 0.1), np.argmax(q > 0.9)]], t[np.flatnonzero(np.abs(q - 1) > band)[-1] + 1]
    top = np.argmax(q)
    ax.axhspan(1 - band, 1 + band, color=COLOURS["light"], label="band about the target")
    ax.axhline(1, label="target", **SETPOINT)
    ax.plot(t, q, color=COLOURS["blue"], label="angle")
    arrow = {"arrowprops": {"arrowstyle": "<->", "color": COLOURS["orange"], "shrinkA": 0, "shrinkB": 0}}
    for a, b, words, place in (
        ((rise[0], 0.1), (rise[1], 0.1), "rise time: from 10 % to 90 %", (rise[1] + 0.1, 0.07)),
        ((0, -0.15), (settled, -0.15), "settling time: from here on it stays in the band", (settled + 0.1, -0.18)),
        ((t[top], 1), (t[top], q[top]), "overshoot", (t[top] + 0.1, q[top] + 0.05)),
        ((4.5, q[450]), (4.5, 1), "rest error", (4.1, 0.8)),
    ):
        ax.annotate("", a, b, **arrow)
        ax.text(*place, words, fontsize=9, color=COLOURS["orange"])
    for x, y in ((rise[0], 0.1), (rise[1], 0.9), (settled, q[np.searchsorted(t, settled)])):
        ax.plot([x, x], [-0.15 if x == settled else 0.1, y], ":", color=COLOURS["orange"])
    ax.set(xlim=(0, 5), ylim=(-0.3, 1.35), xlabel="time [s]", ylabel="share of the way [1]")
    ax.legend(fontsize=8, loc="center right")
    return figure


def colour_solids():
    """The RGB cube and the HSV cone (Figures 3.3, 3.4), each point in its own colour."""
    steps = np.linspace(0, 255, 9)
    rgb = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    rgb = rgb[(rgb == 0).any(axis=1) | (rgb == 255).any(axis=1)]
    hue, saturation, value = (rgb_to_hsv(rgb / 255) * (360, 1, 1)).T
    figure, cube, cone = subplots(9.0, 4.2, cols=2, projection="3d")
    chroma, angle = saturation * value, np.radians(hue)
    in_cone = np.column_stack([chroma * np.cos(angle), chroma * np.sin(angle), value])
    for ax, points in ((cube, rgb), (cone, in_cone)):
        ax.scatter(*points.T, c=rgb / 255, s=22, depthshade=False, rasterized=True)
        ax.set_box_aspect(None, zoom=0.85)  # room for the labels, which the layout does not see
    cube.set(xticks=(0, 128, 255), yticks=(0, 128, 255), zticks=(0, 128, 255))
    cone.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1), zticks=(0, 0.5, 1))
    cube.set(xlabel="R [level]", ylabel="G [level]", zlabel="B [level]", title="RGB: a cube")
    cone.set(xlabel="S V cos H [1]", ylabel="S V sin H [1]", zlabel="V [1]", title="HSV: a cone, hue is the angle")
    return figure


DRAWINGS = {draw.__name__: draw for draw in (one_loop, three_loops, axis_and_lever, ruler, colour_solids)}


def main(arguments=None):
    """Write the drawings."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path("data/drawings"), help="folder of the drawings")
    given = parser.parse_args(arguments)
    given.data.mkdir(exist_ok=True)
    for name, draw in DRAWINGS.items():
        with matplotlib.rc_context({"svg.hashsalt": name}):  # the same file each time
            figure = draw()
            figure.savefig(given.data / f"{name}.svg", metadata={"Date": None, "Title": figure.describe()})


if __name__ == "__main__":
    main()
