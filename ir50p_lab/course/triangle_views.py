"""Pictures of notebook 02: the arm from above and from the side, its triangle, circles that cross, maps of places."""

import numpy as np

from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import forward_kinematics, frames
from ir50p_lab.modelling.ik import inverse_kinematics


def seen_from_above(arm, p):
    """The column, the place p (3,) m and the line between them, with the angle to be found: LabFigure.

    For a place behind the column also the line that arctan(y / x) means.
    """
    figure = new_figure(6.4, 4.2)
    ax = figure.axes[0]
    far = 1.15 * arm.reach
    behind = p[0] < 0
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=13)
    ax.plot([0, far], [0, 0], color=COLOURS["grey"], linewidth=1)
    ax.plot([0, p[0]], [0, p[1]], color=COLOURS["blue"], linewidth=5, solid_capstyle="round", alpha=0.5)
    ax.plot(p[0], p[1], "o", color="#C8102E", ms=13)
    _arc(ax, (0, 0), 0, np.arctan2(p[1], p[0]), 0.2, "blue" if behind else "orange", "$q_1$", 1.2)
    if behind:
        ax.plot([0, -p[0]], [0, -p[1]], "--", color=COLOURS["orange"], linewidth=3)
        ax.text(-0.5 * p[0], -0.5 * p[1] - 0.05, "arctan(y / x)", color=COLOURS["orange"], ha="right", fontsize=11)
        ax.text(p[0], p[1] + 0.04, "arctan2(y, x)", color=COLOURS["blue"], ha="center", fontsize=11)
    ax.set(xlim=(-far if behind else -0.12, far), ylim=(-0.6 * far, 0.4 * far + 0.1 * behind), aspect="equal")
    ax.set(xlabel="x, ahead [m]", ylabel="y, to the left [m]")
    ax.set_title("A place behind the column" if behind else "From above the arm is a straight line")
    return figure


def _plane(figure_or_none=None):
    figure = figure_or_none or new_figure(7.2, 5.0)
    ax = figure.axes[0]
    ax.set(aspect="equal", xlabel="outwards from the column [m]", ylabel="height [m]")
    return figure, ax


def _corners(arm, q):
    """Shoulder, elbow, tip in the vertical plane of the arm, (3, 2) m."""
    T = frames(arm, [0.0, q[1], q[2]])
    return T[1:, [0, 2], 3]


def _draw(ax, points, colour, alpha=1.0, label=None):
    style = {"solid_capstyle": "round", "alpha": alpha, "color": COLOURS[colour]}
    ax.plot(*points.T, linewidth=6, label=label, **style)
    ax.plot(*points.T, "o", color="white", mec=COLOURS[colour], ms=8, mew=2, alpha=alpha)


def _column(ax, arm):
    ax.plot([0, 0], [0, arm.l[0]], color=COLOURS["grey"], linewidth=10, solid_capstyle="butt")
    ax.axhline(0, color=COLOURS["dark"], linewidth=1)


def _arc(ax, centre, start, end, radius, colour, text, out=1.35):
    angles = np.linspace(start, end, 40)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    ax.plot(*(centre + radius * directions).T, color=COLOURS[colour], linewidth=2)
    place = centre + out * radius * directions[20]
    ax.text(*place, text, color=COLOURS[colour], fontsize=13, ha="center", va="center")


def side_view(arm, p):
    """The triangle of shoulder, elbow and place, with its three lengths, the inner angle and q3 (Figure 1.8)."""
    figure, ax = _plane()
    _column(ax, arm)
    points = _corners(arm, inverse_kinematics(arm, p)["front/up"])
    shoulder, elbow, tip = points
    _draw(ax, points, "blue")
    ax.plot(*np.transpose([shoulder, tip]), "--", color=COLOURS["dark"])
    upper, fore = elbow - shoulder, tip - elbow
    on = elbow + 0.45 * upper  # the upper arm, prolonged
    ax.plot(*np.transpose([elbow, on]), ":", color=COLOURS["orange"], linewidth=2)
    slope, turned = np.arctan2(*upper[::-1]), np.arctan2(*fore[::-1])
    _arc(ax, elbow, slope, turned, 0.07, "orange", "$q_3$", 1.5)
    _arc(ax, elbow, slope - np.pi, turned, 0.05, "green", r"$\alpha$", 1.6)
    for a, b, text, shift in ((shoulder, elbow, "$l_2$", (-0.02, 0.03)), (elbow, tip, "$l_3$", (0.025, 0.025))):
        ax.text(*(0.5 * (a + b) + shift), text, fontsize=13, color=COLOURS["blue"])
    ax.text(*(0.55 * shoulder + 0.45 * tip - [0.01, 0.035]), "$r$", fontsize=13)
    ax.plot(*tip, "o", color="#C8102E", ms=11)
    ax.annotate("", (tip[0], shoulder[1]), shoulder, arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
    ax.text(0.78 * tip[0], shoulder[1] + 0.012, r"out ($\Delta$)", color=COLOURS["dark"])
    ax.annotate("", tip, (tip[0], shoulder[1]), arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
    ax.text(tip[0] + 0.012, 0.5 * (tip[1] + shoulder[1]), "up ($z_1$,\nhere < 0)", color=COLOURS["dark"], va="center")
    ax.set_xlim(-0.12, tip[0] + 0.16)
    ax.set_title("From the side: a triangle with three known sides")
    return figure


def triangles(arm, p):
    """Elbow up and elbow down over each other, for the place p (3,) m: LabFigure.

    With r, its slope gamma, the angle beta between r and either upper arm (Figure 1.8), both q3, and for the elbow up
    the perpendicular from the tip onto the upper arm, prolonged.
    """
    figure, ax = _plane()
    _column(ax, arm)
    answers = inverse_kinematics(arm, p)
    for branch, colour, name in (("front/up", "blue", "elbow up"), ("front/down", "orange", "elbow down")):
        points = _corners(arm, answers[branch])
        _draw(ax, points, colour, label=name)
        shoulder, elbow, tip = points
        upper, r = elbow - shoulder, tip - shoulder
        q3 = answers[branch][2]
        ax.plot(*np.transpose([elbow, elbow + 0.35 * upper]), ":", color=COLOURS[colour], linewidth=2)
        if branch == "front/up":  # the perpendicular from the tip onto the upper arm, prolonged
            foot = shoulder + upper * (upper @ r) / (upper @ upper)
            ax.plot(*np.transpose([shoulder + upper, foot, tip]), ":", color=COLOURS["dark"], linewidth=2)
        slope = np.arctan2(upper[1], upper[0])
        _arc(ax, elbow, slope, slope + q3, 0.06, colour, "$q_3$", 1.6)
        gamma = np.arctan2(r[1], r[0])
        _arc(ax, shoulder, gamma, slope, 0.13, colour, r"$\beta$", 1.2)
    ax.plot(*np.transpose([shoulder, tip]), "--", color=COLOURS["dark"])
    ax.text(*(0.25 * shoulder + 0.75 * tip + [0.005, 0.015]), "$r$", fontsize=13)
    ax.plot([0, 1.1 * np.hypot(p[0], p[1])], [shoulder[1], shoulder[1]], color=COLOURS["grey"], linewidth=1)
    _arc(ax, shoulder, 0, gamma, 0.2, "green", r"$\gamma$", 1.12)
    ax.plot(*tip, "o", color="#C8102E", ms=11)
    ax.set_xlim(-0.12, tip[0] + 0.16)
    ax.legend(loc="upper right")
    ax.set_title("One triangle, folded over: two elbows")
    return figure


def circles(arm):
    """Circles with radius l2 about the shoulder and l3 about the place, for `live`.

    Returns: figure; f(out, height) that places them and says how many crossings there are.
    """
    figure, ax = _plane(new_figure(7.2, 6.4))
    _column(ax, arm)
    _, l2, l3 = arm.l
    shoulder = np.array([0.0, arm.l[0]])
    turn = np.linspace(0, 2 * np.pi, 181)
    ring = np.array([np.cos(turn), np.sin(turn)]).T
    ax.plot(*(shoulder + l2 * ring).T, color=COLOURS["blue"], label="where the elbow can be, from the shoulder")
    (about,) = ax.plot([], [], color=COLOURS["orange"], label="where it can be, from the place")
    (links,) = ax.plot([], [], color=COLOURS["grey"], linewidth=4, solid_joinstyle="round", label="the arm")
    (place,) = ax.plot([], [], "o", color="#C8102E", ms=10)
    (elbows,) = ax.plot([], [], "o", color=COLOURS["dark"], ms=9, label="elbow")
    ax.set(xlim=(-0.32 - l3, 0.72 + l3), ylim=(-0.22 - l3, 1.0 + l3))
    ax.legend(loc="upper left", fontsize=8)
    ax.set_title("The elbow is where the circles cross")

    def show(out, height):
        p = np.array([out, height])
        about.set_data(*(p + l3 * ring).T)
        place.set_data([out], [height])
        r = np.linalg.norm(p - shoulder)
        along = (r**2 + l2**2 - l3**2) / (2 * r) if r > 0 else np.inf
        across = l2**2 - along**2
        if across < 0:
            elbows.set_data([], [])
            links.set_data([], [])
            return f"r = {r:.3f} m: the circles do not meet, the arm cannot reach this place"
        direction = (p - shoulder) / r
        foot, side = shoulder + along * direction, np.sqrt(across) * np.array([-direction[1], direction[0]])
        elbows.set_data(*np.transpose([foot + side, foot - side]))
        links.set_data(*np.transpose([shoulder, foot + side, p, foot - side, shoulder]))
        return f"r = {r:.3f} m: {'two crossings, two elbows' if across > 1e-6 else 'they touch: one elbow'}"

    return figure, show


def halfway(arm, q_start, q_end):
    """The tip's path when all joints turn evenly, beside the straight line, from above and from the side: LabFigure."""
    figure = new_figure(9.4, 4.4, cols=2)
    above, side = figure.axes
    share = np.linspace(0, 1, 61)[:, None]
    path = forward_kinematics(arm, q_start + share * (np.asarray(q_end) - q_start))
    line = path[0] + share * (path[-1] - path[0])
    along = (path[-1] - path[0]) / np.linalg.norm(path[-1] - path[0])
    foot = path[0] + ((path[30] - path[0]) @ along) * along
    for ax, view in ((above, [0, 1]), (side, [1, 2])):
        ax.plot(*line[:, view].T, "--", color=COLOURS["dark"], label="straight line")
        ax.plot(*path[:, view].T, color=COLOURS["blue"], linewidth=2.5, label="tip, joints turning evenly")
        ax.plot(*path[30, view], "o", color=COLOURS["blue"], ms=9, label="halfway")
        ax.plot(*np.array([path[30], foot])[:, view].T, color=COLOURS["orange"], linewidth=2, label="distance")
        ax.set_aspect("equal", adjustable="datalim")
    above.plot(0, 0, "s", color=COLOURS["dark"], ms=12)
    above.set(xlabel="x [m]", ylabel="y [m]", title="From above")
    side.set(xlabel="y [m]", ylabel="z [m]", title="From the front")
    side.invert_xaxis()
    above.legend(loc="lower left", fontsize=9)
    return figure


_KINDS = ("a pose that the stops allow", "a pose that the stops forbid", "a pose that misses the place")


def printed_answers(p, hit, within):
    """Places p (n, 3) m from above and from the side, by what a formula says there: LabFigure.

    hit, within: (n,) bool, whether its pose reaches the place, and whether it keeps the joint limits.
    """
    kind = np.where(~hit, 2, np.where(within, 0, 1))
    figure = new_figure(9.4, 4.8, cols=2)
    above, side = figure.axes
    for number, (mark, colour) in enumerate(((".", "blue"), ("+", "grey"), ("x", "orange"))):
        x, y, z = p[kind == number].T
        style = {"linestyle": "", "marker": mark, "color": COLOURS[colour], "ms": 4}
        above.plot(x, y, **style)
        side.plot(np.hypot(x, y), z, label=f"{_KINDS[number]}: {np.mean(kind == number):.0%}", **style)
    above.plot(0, 0, "s", color=COLOURS["dark"], ms=11)
    above.set(aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]", title="From above")
    side.set(aspect="equal", xlabel="distance from the column [m]", ylabel="height [m]", title="From the side")
    figure.legend(loc="outside lower center", ncols=3, markerscale=2, fontsize=9)
    return figure


def allowed_map(side, count):
    """How many poses (n, n), nan out of reach, are allowed at the places side x side (n,) m, from above: LabFigure."""
    figure = new_figure(7.6, 5.0)
    ax = figure.axes[0]
    x, y = np.meshgrid(side, side)
    within = np.isfinite(count).sum()
    for number, colour in enumerate((COLOURS["light"], COLOURS["sky"], COLOURS["blue"])):
        here = count == number
        label = f"{number} poses allowed: {here.sum() / within:.0%}"
        ax.plot(x[here], y[here], "s", color=colour, ms=4.5, label=label)
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=11)
    ax.set(aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]")
    ax.set_title("Places at the height of the ball, from above")
    figure.legend(loc="outside right upper", markerscale=2)
    return figure
