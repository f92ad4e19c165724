"""Pictures of notebook 02: the arm from above and from the side, its triangle, circles that cross, maps of places."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.modelling.chain import forward_kinematics, frames
from ir50p_lab.modelling.ik import inverse_kinematics, reachability


def seen_from_above(arm, p):
    """The column, the place p (3,) m and the line between them, with the angle to be found: LabFigure.

    For a place behind the column also the line that arctan(y / x) means.
    """
    figure, ax = subplots(6.4, 4.2)
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


def _plane(arm, height=5.0):
    """The vertical plane of the arm, with column and ground."""
    figure, ax = subplots(7.2, height)
    ax.set(aspect="equal", xlabel="outwards from the column [m]", ylabel="height [m]")
    ax.plot([0, 0], [0, arm.l[0]], color=COLOURS["grey"], linewidth=10, solid_capstyle="butt")
    ax.axhline(0, color=COLOURS["dark"], linewidth=1)
    return figure, ax


def _corners(arm, q):
    """Shoulder, elbow, tip in the vertical plane of the arm, (3, 2) m."""
    T = frames(arm, [0.0, q[1], q[2]])
    return T[1:, [0, 2], 3]


def _draw(ax, points, colour, label=None):
    ax.plot(*points.T, linewidth=6, label=label, color=COLOURS[colour], solid_capstyle="round")
    ax.plot(*points.T, "o", color="white", mec=COLOURS[colour], ms=8, mew=2)


def _arc(ax, centre, start, end, radius, colour, text, out=1.35, *, arrow=True):
    """An arc with its name at `out` radii; an angle that has a sign gets an arrow, from start to end."""
    angles = np.linspace(start, end, 40)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    points = centre + radius * directions
    ax.plot(*points.T, color=COLOURS[colour], linewidth=2)
    if arrow:
        style = {"arrowstyle": "-|>", "color": COLOURS[colour], "mutation_scale": 16, "shrinkB": 0}
        ax.annotate("", points[-1], points[-5], arrowprops=style)
    place = centre + out * radius * directions[20]
    ax.text(*place, text, c=COLOURS[colour], size=13, ha="center", va="center", bbox={"fc": "w", "ec": "w", "pad": 1})


def side_view(arm, p):
    """The triangle of shoulder, elbow and place, with its three lengths, the inner angle and q3 (Figure 1.8)."""
    figure, ax = _plane(arm)
    points = _corners(arm, inverse_kinematics(arm, p)["front/up"])
    shoulder, elbow, tip = points
    _draw(ax, points, "blue")
    ax.plot(*np.transpose([shoulder, tip]), "--", color=COLOURS["dark"])
    upper, fore = elbow - shoulder, tip - elbow
    on = elbow + 0.45 * upper  # the upper arm, prolonged
    ax.plot(*np.transpose([elbow, on]), ":", color=COLOURS["orange"], linewidth=2)
    slope, turned = np.arctan2(*upper[::-1]), np.arctan2(*fore[::-1])
    _arc(ax, elbow, slope, turned, 0.07, "orange", "$q_3$", 1.5)
    _arc(ax, elbow, slope - np.pi, turned, 0.05, "green", r"$\alpha$", 0.6, arrow=False)
    for a, b, text, shift in ((shoulder, elbow, "$l_2$", (-0.02, 0.03)), (elbow, tip, "$l_3$", (0.025, 0.025))):
        ax.text(*(0.5 * (a + b) + shift), text, fontsize=13, color=COLOURS["blue"])
    ax.text(*(0.55 * shoulder + 0.45 * tip - [0.01, 0.035]), "$r$", fontsize=13)
    ax.plot(*tip, "o", color="#C8102E", ms=11)
    ax.annotate("", (tip[0], shoulder[1]), shoulder, arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
    ax.text(0.78 * tip[0], shoulder[1] + 0.012, "out", color=COLOURS["dark"])
    ax.annotate("", tip, (tip[0], shoulder[1]), arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
    ax.text(tip[0] + 0.012, 0.5 * (tip[1] + shoulder[1]), "up\n(here < 0)", color=COLOURS["dark"], va="center")
    ax.set_xlim(-0.12, tip[0] + 0.16)
    ax.set_title("From the side: a triangle with three known sides")
    return figure


def triangles(arm, p, *, back=False):
    """Both elbows over each other, facing the place p (3,) m or with the back to it: LabFigure.

    With r, its slope gamma, the angle beta between r and either upper arm (Figure 1.8), both q3, and for the upper
    elbow the perpendicular from the tip onto the upper arm, prolonged.
    """
    figure, ax = _plane(arm)
    answers, waist = inverse_kinematics(arm, p), "back" if back else "front"
    for branch, colour, name in ((f"{waist}/up", "blue", "one elbow"), (f"{waist}/down", "orange", "the other")):
        points = _corners(arm, answers[branch])
        _draw(ax, points, colour, label=name)
        shoulder, elbow, tip = points
        upper, r = elbow - shoulder, tip - shoulder
        ax.plot(*np.transpose([elbow, elbow + 0.35 * upper]), ":", color=COLOURS[colour], linewidth=2)
        if branch == "front/up":  # the perpendicular from the tip onto the upper arm, prolonged
            foot = shoulder + upper * (upper @ r) / (upper @ upper)
            ax.plot(*np.transpose([elbow, foot, tip]), ":", color=COLOURS["dark"], linewidth=2)
            along, across = upper / np.linalg.norm(upper), (tip - foot) / np.linalg.norm(tip - foot)
            ax.plot(*(foot + 0.02 * np.array([-along, across - along, across])).T, color=COLOURS["dark"])
            for name, begin, end, aside in (("along", shoulder, foot, -across), ("across", foot, tip, along)):
                ends = np.array([begin, end]) + 0.025 * aside
                ax.update_datalim(ends)
                ax.annotate("", *ends, arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
                ax.text(*(ends.mean(axis=0) + 0.025 * aside), name, color=COLOURS["dark"], ha="center")
        gamma, slope = np.arctan2(r[1], r[0]), np.arctan2(upper[1], upper[0])
        slope += 2 * np.pi * np.round((gamma - slope) / (2 * np.pi))  # the turn that is nearer to r
        _arc(ax, elbow, slope, slope + answers[branch][2], 0.06, colour, "$q_3$", 1.6)
        _arc(ax, shoulder, gamma, slope, 0.13, colour, r"$\beta$", 0.8, arrow=False)
    ax.plot(*np.transpose([shoulder, tip]), "--", color=COLOURS["dark"])
    ax.text(*(0.25 * shoulder + 0.75 * tip + [0.005, 0.015]), "$r$", fontsize=13)
    ax.plot([0, 1.1 * np.hypot(p[0], p[1])], [shoulder[1], shoulder[1]], color=COLOURS["grey"], linewidth=1)
    _arc(ax, shoulder, 0, gamma, 0.2, "green", r"$\gamma$", 1.12)
    ax.plot(*tip, "o", color="#C8102E", ms=11)
    ax.set_xlim(min(-0.12, tip[0] - 0.06), max(0.5, tip[0] + 0.16))
    ax.legend(loc="lower right")
    ax.set_title("The waist looks right, the place lies left" if back else "One triangle, folded over: two elbows")
    return figure


def circles(arm):
    """Circles with radius l2 about the shoulder and l3 about the place, for `live`.

    Returns: figure; f(out, height) that places them and says how many crossings there are.
    """
    figure, ax = _plane(arm, 6.4)
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


def straight_line(arm, places, q_start, q_end, poses=()):
    """From above: a line of places (n, 3) m, and the tip's path when all joints turn evenly instead: LabFigure.

    poses: for each place the pose that was found, or None; places without one are marked.
    """
    figure, ax = subplots(7.2, 5.4)
    path = forward_kinematics(arm, np.linspace(q_start, q_end, 61))
    ax.plot(*places[:, :2].T, "--", color=COLOURS["dark"], label="the straight line")
    ax.plot(*path[:, :2].T, color=COLOURS["blue"], linewidth=2.5, label="the tip, joints turning evenly")
    beside = 1000 * np.linalg.norm(path[30] - places.mean(axis=0))
    ax.plot(*path[30, :2], "o", color=COLOURS["blue"], ms=9, label=f"halfway, {beside:.0f} mm from the middle")
    refused = [p[:2] for p, pose in zip(places, poses, strict=False) if pose is None]
    if refused:
        ax.plot(*np.transpose(refused), "x", color=COLOURS["orange"], ms=8, mew=2, label="no pose")
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=12)
    ax.set(adjustable="datalim", aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]", title="From above")
    ax.legend(loc="upper left", fontsize=9)
    return figure


def through_column(arm, q):
    """Tell whether the forearm of a pose (3,) rad goes through the axis of the arm's own column."""
    _, elbow, tip = _corners(arm, q)
    if elbow[0] * tip[0] >= 0:
        return False  # both on the same side of it
    height = elbow[1] + (tip[1] - elbow[1]) * elbow[0] / (elbow[0] - tip[0])
    return bool(height < arm.l[0])


def allowed_map(arm, allowed, free=None):
    """How many poses allowed(p) lists at the places 0.03 m above the table, from above: LabFigure.

    free(p): the poses among them that are really free; places that have only others are marked.
    """
    figure, ax = subplots(7.6, 5.0)
    side = np.linspace(-arm.reach, arm.reach, 61)
    places = np.array([[x, y, 0.03] for y in side for x in side])
    places = places[reachability(arm, places) == 0]
    count, left = (np.array([min(len(poses(p)), 2) for p in places]) for poses in (allowed, free or allowed))
    lost = (count > 0) & (left == 0)
    only_lost = f"only through the column ({lost.sum() / (count > 0).sum():.0%} of the blue)"
    kinds = (("light", "no pose"), ("sky", "one pose"), ("blue", "two or more"), ("orange", only_lost))
    for number, (colour, label) in enumerate(kinds):
        here = np.where(lost, 3, left) == number
        if here.any():
            ax.plot(*places[here, :2].T, "s", color=COLOURS[colour], ms=4.5, label=label)
    ax.plot(0, 0, "s", color=COLOURS["dark"], ms=11)
    ax.set(aspect="equal", xlabel="x, ahead [m]", ylabel="y, to the left [m]", title="From above, 3 cm over the table")
    figure.legend(loc="outside upper center", ncols=len(kinds), markerscale=2, fontsize=9)
    return figure
