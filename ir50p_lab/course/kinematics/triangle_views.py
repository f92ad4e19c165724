"""Pictures of notebook 02: the arm from above and from the side, its triangle, circles that cross, maps of places."""

import numpy as np
from matplotlib.patches import Circle

from ir50p_lab.course.checking.calling import Failed, call_or_fail
from ir50p_lab.course.checking.note import Note, show
from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.sketch import arc, from_above, line, name
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.modelling.chain import forward_kinematics, frames
from ir50p_lab.modelling.ik import inverse_kinematics, reachability


def seen_from_above(arm, p):
    """Draw the column, the place p (3,) m and the line between them, with the angle to be found. Returns: LabFigure.

    For a place behind the column the line that arctan(y / x) means is drawn, too.
    """
    figure, ax = from_above(height=4.2, title="From above the arm is a straight line")
    line(ax, [(0, 0), (arm.reach, 0)], "-", "grey", linewidth=1)
    line(ax, [(0, 0), p[:2]], "-", "blue", linewidth=5, alpha=0.5)
    ax.plot(*p[:2], "o", color="#C8102E", ms=13)
    arc(ax, (0, 0), 0, np.arctan2(p[1], p[0]), 0.15, "blue", "$q_1$", 1.25)
    if p[0] < 0:
        line(ax, [(0, 0), -p[:2]], "--", "orange", linewidth=3)
        name(ax, -0.6 * p[:2], "arctan(y / x)", "orange")
        name(ax, 0.7 * p[:2], "arctan2(y, x)", "blue")
    return figure


def _triangle(ax, arm, q, colour):
    """The arm from the side, r, the prolonged upper arm and q3. Returns shoulder, elbow, tip, (3, 2) m."""
    shoulder, elbow, tip = points = SideView(ax, arm, q, colour=COLOURS[colour]).points
    line(ax, [shoulder, tip], "--")
    line(ax, [elbow, elbow + 0.4 * (elbow - shoulder)], ":", colour, linewidth=2)
    name(ax, 0.3 * shoulder + 0.7 * tip, "$r$")
    arc(ax, elbow, q[1], q[1] + q[2], 0.06, colour, "$q_3$", 1.5)
    ax.set(xlim=tip[0] / 2 + arm.reach * np.array([-0.8, 0.8]), ylim=arm.l[0] + arm.reach * np.array([-0.55, 0.55]))
    return points


def _length(ax, start, end, text, aside=0.0):
    """A length with its name, drawn beside the line from start to end."""
    ends = np.array([start, end]) + aside
    ax.annotate("", *ends, arrowprops={"arrowstyle": "<->", "color": COLOURS["grey"]})
    name(ax, ends.mean(axis=0), text)


def side_view(arm, p):
    """Draw the triangle of shoulder, elbow and place, with its three lengths, the inner angle and q3 (Figure 1.8)."""
    figure, ax = subplots(7.2, 5.0)
    q = inverse_kinematics(arm, p)["front/up"]
    shoulder, elbow, tip = _triangle(ax, arm, q, "blue")
    arc(ax, elbow, q[1] - np.pi, q[1] + q[2], 0.05, "green", r"$\alpha$", 0.6, arrow=False)
    name(ax, (shoulder + elbow) / 2, "$l_2$", "blue")
    name(ax, (elbow + tip) / 2, "$l_3$", "blue")
    _length(ax, shoulder, (tip[0], shoulder[1]), "out")
    _length(ax, (tip[0], shoulder[1]), tip, "up")
    ax.set_title("From the side: a triangle with three known sides")
    return figure


def triangles(arm, p, *, back=False):
    """Draw both elbows, one above the other, facing the place p (3,) m or with the back to it. Returns: LabFigure.

    It shows r, its slope gamma, the angle beta between r and either upper arm (Figure 1.8), both q3, and for the upper
    elbow the perpendicular from the tip onto the upper arm, extended.
    """
    figure, ax = subplots(7.2, 5.0)
    answers = inverse_kinematics(arm, p).q[2:] if back else inverse_kinematics(arm, p).q[:2]
    for q, colour in zip(answers, ("blue", "orange"), strict=True):
        shoulder, elbow, tip = _triangle(ax, arm, q, colour)
        r, along = tip - shoulder, np.array([np.cos(q[1]), np.sin(q[1])])
        gamma, slope = np.unwrap([np.arctan2(r[1], r[0]), q[1]])  # the turn of q2 that is nearer to r
        arc(ax, shoulder, gamma, slope, 0.13, colour, r"$\beta$", 0.8, arrow=False)
        if colour == "blue" and not back:
            foot = shoulder + along * (r @ along)
            line(ax, [elbow, foot, tip], ":", linewidth=2)
            _length(ax, shoulder, foot, "along", 0.04 * np.array([-along[1], along[0]]))
            _length(ax, foot, tip, "across", 0.04 * along)
    ax.axhline(shoulder[1], color=COLOURS["grey"], linewidth=1)
    arc(ax, shoulder, 0, gamma, 0.2, "green", r"$\gamma$", 1.12)
    ax.set_title("The waist faces right, the place is on the left" if back else "One triangle, folded over: two elbows")
    return figure


def circles(arm):
    """Draw circles with radius l2 about the shoulder and l3 about the place, for `live`.

    Returns: figure; f(out, height) that places them and says whether they cross.
    """
    figure, ax = subplots(7.2, 6.4)
    l1, l2, l3 = arm.l
    line(ax, [(0, 0), (0, l1)], "-", "grey", linewidth=10, solid_capstyle="butt")
    style = {"fill": False, "linewidth": 1.5}
    ax.add_patch(Circle((0, l1), l2, color=COLOURS["blue"], label="where the elbow can be, from the shoulder", **style))
    about = ax.add_patch(Circle((0, l1), l3, color=COLOURS["orange"], label="where it can be, from the place", **style))
    links = line(ax, [(0, l1)], "-o", linewidth=3, ms=8, label="the arm, either way")
    ax.set(aspect="equal", xlim=(-0.32 - l3, 0.72 + l3), ylim=(-0.22 - l3, 1.0 + l3))
    ax.set(xlabel="outwards from the column [m]", ylabel="height [m]", title="The elbow is where the circles cross")
    ax.legend(loc="upper left", fontsize=8)

    def show(out, height):
        about.center = out, height
        p = np.array([out, 0.0, height])
        if reachability(arm, p) > 0:
            links.set_data([out], [height])
            return "the circles do not meet, the arm cannot reach this place"
        one, other = frames(arm, inverse_kinematics(arm, p).q[:2])[:, 2]
        links.set_data(*np.transpose([(0, l1), one[[0, 2], 3], (out, height), other[[0, 2], 3], (0, l1)]))
        return "two crossings, two elbows"

    return figure, show


def straight_line(arm, places, q_start, q_end, poses=()):
    """Draw, from above, a line of places (n, 3) m, and the tip's path if all joints turn evenly: LabFigure.

    poses: for each place the pose that was found, or None; places without one are marked.
    """
    figure, ax = from_above()
    path = forward_kinematics(arm, np.linspace(q_start, q_end, 61))
    beside = 1000 * np.linalg.norm(path[30] - places.mean(axis=0))
    line(ax, places[:, :2], "--", label="the straight line")
    line(ax, path[:, :2], "-", "blue", linewidth=2.5, label="the tip, joints turning evenly")
    line(ax, path[30:31, :2], "o", "blue", ms=9, label=f"halfway, {beside:.0f} mm from the middle")
    refused = [p[:2] for p, pose in zip(places, poses, strict=False) if pose is None]
    if refused:
        line(ax, refused, "x", "orange", ms=8, mew=2, label="no pose")
    ax.legend(loc="upper left", fontsize=9)
    return figure


def allowed_map(arm, allowed, free=None):
    """Draw how many poses allowed(p) lists at places 0.03 m above the table, from above. Returns: LabFigure.

    free(p): the poses among them that are really free; places that have only others are marked.
    If one of the functions stops, there is no map, and a sentence says why.
    """
    figure, ax = from_above(title="3 cm over the table")
    side = np.linspace(-arm.reach, arm.reach, 61)
    places = np.array([[x, y, 0.03] for y in side for x in side])
    places = places[reachability(arm, places) == 0]

    def counted(poses):
        return np.array([min(len(poses(p)), 2) for p in places])

    try:
        count, left = call_or_fail(lambda: (counted(allowed), counted(free or allowed)))
    except Failed as failed:
        return show(Note("mistake", "no map", failed.args[0]))
    kind = np.where((count > 0) & (left == 0), 3, left)
    colours = ("light", "sky", "blue", "orange")
    labels = ("no pose", "one pose", "two or more", "only through the column")
    for number in np.unique(kind):
        line(ax, places[kind == number, :2], "s", colours[number], ms=5, label=labels[number], zorder=1.9)
    figure.legend(loc="outside upper center", ncols=len(labels), markerscale=2, fontsize=9)
    return figure
