"""The forearm as one lump on a circle about the elbow: a picture of notebook 05."""

from matplotlib.patches import Circle, FancyArrowPatch

from ir50p_lab.course.draw import sketch
from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import COLOURS, subplots


def on_a_circle(arm, q):
    """Draw the arm at q (3,) rad from the side, the circle of the forearm's centre, force and lever.

    Returns: LabFigure.
    """
    figure, ax = subplots(6.4, 5.0)
    shoulder, elbow, tip = SideView(ax, arm, q).points
    along = (tip - elbow) / arm.l[2]
    lump, foot = elbow + arm.lc[2] * along, elbow + ((shoulder - elbow) @ along) * along
    ax.add_patch(Circle(elbow, arm.lc[2], fill=False, linestyle=":"))
    ax.add_patch(FancyArrowPatch(lump, elbow, color=COLOURS["orange"], mutation_scale=30, zorder=8))
    sketch.line(ax, [lump, foot], "--", "orange", label="force, and its line")
    sketch.line(ax, [shoulder, foot], "--", "green", label="its lever about the shoulder")
    sketch.line(ax, [lump], "o", "dark", ms=14, zorder=9, label="lump")
    ax.set(xlim=(-0.2 * arm.reach, arm.reach), ylim=(-0.05, arm.l[0] + 0.9 * arm.reach))
    ax.legend(loc="upper right")
    return figure
