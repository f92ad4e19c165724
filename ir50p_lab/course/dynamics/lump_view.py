"""The forearm as one lump on a circle about the elbow: a picture of notebook 05."""

import numpy as np

from ir50p_lab.course.draw import sketch
from ir50p_lab.course.draw.arm3d import SideView
from ir50p_lab.course.draw.style import COLOURS, subplots


def on_a_circle(arm, q):
    """The arm from the side at q (3,) rad; the force on the lump at the forearm's centre, its lever: LabFigure."""
    figure, ax = subplots(6.4, 4.6)
    shoulder, elbow, tip = SideView(ax, arm, q).points
    along, turn = (tip - elbow) / arm.l[2], np.linspace(0, 2 * np.pi, 121)
    lump, aside = elbow + arm.lc[2] * along, 0.09 * arm.reach * np.array([-along[1], along[0]])
    foot = elbow + ((shoulder - elbow) @ along) * along
    sketch.line(ax, elbow + arm.lc[2] * np.column_stack([np.cos(turn), np.sin(turn)]), ":", "grey")
    sketch.line(ax, [lump, foot], "--", "orange", linewidth=1)
    sketch.line(ax, [shoulder, foot], "--", "green", linewidth=2)
    sketch.name(ax, (shoulder + foot) / 2 - 0.13 * arm.reach * along, "lever", "green")
    sketch.name(ax, (lump + elbow) / 2 + aside, "force", "orange")
    ax.annotate("", elbow + 0.2 * (lump - elbow), lump, arrowprops={"color": COLOURS["orange"], "width": 4}, zorder=8)
    ax.plot(*lump, "o", color=COLOURS["dark"], ms=14, zorder=9)
    centre, half = (shoulder + elbow) / 2 + [0.25 * arm.reach, 0], 0.6 * arm.reach
    ax.set(xlim=centre[0] + [-half, half], ylim=centre[1] + [-0.8 * half, 0.8 * half])
    ax.set_title("The elbow turns steadily: the lump is pulled towards it")
    return figure
