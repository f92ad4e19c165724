"""Pictures of notebook 02: the arm from above and from the side, its triangle, circles that cross, places missed."""

import numpy as np

from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.ik import inverse_kinematics


def seen_from_above(arm, p):
    """The column, the place p (3,) m and the line between them, with the angle to be found: LabFigure."""
    figure = new_figure(6.4, 4.2)
    ax = figure.axes[0]
    far = 1.15 * arm.reach
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=13)
    ax.plot([0, far], [0, 0], color=COLOURS["grey"], linewidth=1)
    ax.plot([0, p[0]], [0, p[1]], color=COLOURS["blue"], linewidth=5, solid_capstyle="round", alpha=0.5)
    ax.plot(p[0], p[1], "o", color="#C8102E", ms=13)
    arc = np.linspace(0, np.arctan2(p[1], p[0]), 40)
    ax.plot(0.2 * np.cos(arc), 0.2 * np.sin(arc), color=COLOURS["orange"], linewidth=2)
    middle = 0.23 * np.array([np.cos(arc[20]), np.sin(arc[20])])
    ax.text(*middle, "$q_1$", color=COLOURS["orange"], fontsize=13, va="center")
    ax.set(xlim=(-0.12, far), ylim=(-0.6 * far, 0.4 * far), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.set_title("From above the arm is a straight line")
    return figure


def _plane(figure_or_none=None):
    figure = figure_or_none or new_figure(7.2, 4.6)
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
    ax.plot(
        centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles), color=COLOURS[colour], linewidth=2
    )
    middle = angles[20]
    ax.text(
        centre[0] + out * radius * np.cos(middle),
        centre[1] + out * radius * np.sin(middle),
        text,
        color=COLOURS[colour],
        fontsize=13,
        ha="center",
        va="center",
    )


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
    """Elbow up and elbow down over each other, for the place p (3,) m: LabFigure."""
    figure, ax = _plane()
    _column(ax, arm)
    answers = inverse_kinematics(arm, p)
    for branch, colour, name in (("front/up", "blue", "elbow up"), ("front/down", "orange", "elbow down")):
        _draw(ax, _corners(arm, answers[branch]), colour, label=name)
    ax.plot(np.hypot(p[0], p[1]), p[2], "o", color="#C8102E", ms=11)
    ax.legend(loc="upper right")
    ax.set_title("One triangle, folded over: two elbows")
    return figure


def circles(arm):
    """Circles with radius l2 about the shoulder and l3 about the place, for `live`.

    Returns: figure; f(out, height) that places them and says how many crossings there are.
    """
    figure, ax = _plane()
    _column(ax, arm)
    _, l2, l3 = arm.l
    shoulder = np.array([0.0, arm.l[0]])
    turn = np.linspace(0, 2 * np.pi, 181)
    ring = np.array([np.cos(turn), np.sin(turn)]).T
    ax.plot(*(shoulder + l2 * ring).T, color=COLOURS["blue"], label="where the elbow can be, from the shoulder")
    (about,) = ax.plot([], [], color=COLOURS["orange"], label="where it can be, from the place")
    (place,) = ax.plot([], [], "o", color="#C8102E", ms=10)
    (elbows,) = ax.plot([], [], "o", color=COLOURS["dark"], ms=9, label="elbow")
    far = 1.3 * arm.reach
    ax.set(xlim=(-0.5 * far, 1.3 * far), ylim=(arm.l[0] - far, arm.l[0] + far))
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
            return f"r = {r:.3f} m: the circles do not meet, the arm cannot reach this place"
        direction = (p - shoulder) / r
        foot, side = shoulder + along * direction, np.sqrt(across) * np.array([-direction[1], direction[0]])
        elbows.set_data(*np.transpose([foot + side, foot - side]))
        return f"r = {r:.3f} m: {'two crossings, two elbows' if across > 1e-6 else 'they touch: one elbow'}"

    return figure, show


def halfway(arm, q_start, q_end):
    """The tip's path when all joints turn evenly from q_start to q_end, beside the straight line, from above."""
    from ir50p_lab.modelling.chain import forward_kinematics

    figure = new_figure(6.4, 4.4)
    ax = figure.axes[0]
    share = np.linspace(0, 1, 61)[:, None]
    path = forward_kinematics(arm, q_start + share * (np.asarray(q_end) - q_start))
    ax.plot(path[:, 0], path[:, 1], color=COLOURS["blue"], linewidth=2.5, label="tip, joints turning evenly")
    ax.plot(path[[0, -1], 0], path[[0, -1], 1], "--", color=COLOURS["dark"], label="straight line")
    ax.plot(path[30, 0], path[30, 1], "o", color=COLOURS["blue"], ms=9)
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=12)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.legend(loc="center", fontsize=9)
    ax.set_title("From above: straight in angles is not straight in space")
    return figure


def missed_places(p, hit):
    """Places p (n, 3) m from above: those that a formula hits, and those it misses. hit: (n,) bool. LabFigure."""
    figure = new_figure(6.4, 5.2)
    ax = figure.axes[0]
    ax.plot(*p[hit, :2].T, ".", color=COLOURS["blue"], ms=4, label=f"hit: {np.mean(hit):.0%}")
    ax.plot(*p[~hit, :2].T, "x", color=COLOURS["orange"], ms=4, label=f"missed: {np.mean(~hit):.0%}")
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=11)
    ax.set(aspect="equal", xlabel="x, ahead [m]", ylabel="y [m]")
    ax.legend(loc="upper right", framealpha=1)
    ax.set_title("From above: places that random poses reach")
    return figure
