"""Pictures of notebook 08: block diagrams, a push against the weight, where pushes end."""

import numpy as np
from matplotlib.patches import FancyBboxPatch

from ir50p_lab.course.style import COLOURS, SETPOINT, subplots
from ir50p_lab.modelling.dynamics import gravity

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


def weight_over_angle(arm, push):
    """What the shoulder's weight asks for in counts over its angle, elbow straight, and a constant push: LabFigure."""
    figure, ax = subplots(7.4, 3.8)
    q2 = np.linspace(arm.q_min[1], arm.q_max[1], 200)
    weight = gravity(arm, np.column_stack([0 * q2, q2, 0 * q2]))[:, 1] / arm.actuators.gain[1]
    low, high = weight + (arm.friction.Tf[1] + np.array([[-1], [1]]) * arm.friction.fs[1]) / arm.actuators.gain[1]
    ax.plot(q2, weight, linewidth=2.5, label="weight")
    ax.fill_between(q2, low, high, color=COLOURS["sky"], alpha=0.3, label="friction holds")
    ax.axhline(push, color=COLOURS["orange"], linewidth=2.5, label=f"a push of {push} counts")
    for k in np.flatnonzero(np.diff(np.sign(weight - push))):
        ax.plot(q2[k], push, "o", ms=9, color=COLOURS["dark"])
        says = "hanging:\nwould come back" if q2[k] < 0 else "standing:\nwould leave"
        ax.annotate(says, (q2[k], push), (0, -14), textcoords="offset points", ha="center", va="top", fontsize=9)
    ax.set(xlabel="angle of the shoulder [rad]", ylabel="push [PWM counts]")
    ax.legend(loc="lower left")
    return figure


def ends(pushes, angles, target):
    """Where the shoulder ends under constant pushes: LabFigure."""
    figure, ax = subplots(7.4, 3.4)
    ax.plot(pushes, angles, "o", ms=8, label="after 30 s")
    ax.axhline(target, **SETPOINT, label="wanted")
    ax.set(xlabel="constant push [PWM counts]", ylabel="angle of the shoulder [rad]")
    ax.legend(loc="upper left")
    return figure


def curves(t, lines, labels, ylabel, targets=()):
    """Lines (k, n) over time (n,) s, each with its label; targets: dashed levels. LabFigure."""
    figure, ax = subplots(8.6, 3.2)
    for target in targets:
        ax.axhline(target, **SETPOINT)
    for values, label in zip(lines, labels, strict=True):
        ax.plot(t, values, label=label, alpha=0.35 if label == "raw" else 1)
    ax.set(xlabel="time [s]", ylabel=ylabel)
    ax.legend()
    return figure


class Trembling:
    """A controller that is shown what the simulated bench would show it: whole steps, and a wobble of one (rms)."""

    unit = "PWM"

    def __init__(self, controller):
        self.controller, self.random = controller, np.random.default_rng(1)
        self.one = np.array([0.005, 0.008, 0.005])  # rad, a step of each converter

    def step(self, t, q, reference):
        """Hand on the angles, shaken."""
        seen = self.one * np.round(q / self.one + self.random.normal(size=3))
        return self.controller.step(t, seen, reference)
