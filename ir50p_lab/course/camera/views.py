"""Figures of notebook 17: a grid on the table, two triangles, what a hole does, which pictures a calibration used."""

import numpy as np
from matplotlib.patches import Circle

from ir50p_lab.course.draw.picture_view import PictureView
from ir50p_lab.course.draw.pictures import STAMP, show_picture
from ir50p_lab.course.draw.style import COLOURS, new_figure, subplots


def grid_figure(picture, H, title="Lines 50 mm apart on the table"):
    """Draw a picture, and over it the grid of the table that H (3, 3), pixels to places, gives. Returns: LabFigure."""
    figure, ax = subplots(6.4, 5.0, note=STAMP)
    bare_picture(ax, picture, title)
    along, across = np.arange(0.20, 0.651, 0.05), np.arange(-0.30, 0.301, 0.05)
    lines = [([x, x], across[[0, -1]]) for x in along] + [(along[[0, -1]], [y, y]) for y in across]
    for x, y in lines:
        u, v, w = np.linalg.solve(H, np.array([x, y, np.ones(2)]))
        ax.plot(u / w, v / w, color=COLOURS["orange"], linewidth=0.8)
    h, w = picture.shape[:2]
    ax.set(xlim=(-0.5, w - 0.5), ylim=(h - 0.5, -0.5))
    return figure


def circled(picture, circles, alt, colour="white"):
    """Return a PictureView of a picture with circles (x, y, radius), px, drawn over it."""
    view = PictureView(picture, alt=alt)
    view.circles = [(*circle, colour) for circle in circles]
    return view


def triangles_figure(lens, ball):
    """Draw a lens (3,) m, a ball of 30 mm radius with its centre at (3,) m, and the line of sight.

    Returns: LabFigure.
    """
    away, high, h = np.hypot(*(ball - lens)[:2]), lens[2], ball[2]
    beyond = h * away / (high - h)
    figure, wide, near = subplots(9.6, 3.8, cols=2, width_ratios=(1.5, 1))
    for ax in (wide, near):
        ax.axhline(0, color=COLOURS["dark"], linewidth=2)
        ax.fill([0, 0, away], [h, high, h], color=COLOURS["blue"], alpha=0.12, linewidth=0)
        ax.add_patch(Circle((away, h), 0.03, facecolor="#D4606A", zorder=1))
        ax.fill([away, away, away + beyond], [0, h, 0], color=COLOURS["orange"], alpha=0.8, linewidth=0)
        ax.plot([0, away + beyond], [high, 0], color=COLOURS["blue"], linewidth=1.3)
        ax.plot(away, h, "+", color="white", markersize=9)
        ax.set(aspect="equal", xlabel="away from the camera [m]")
        ax.grid(False)
    wide.plot(0, high, "o", color=COLOURS["dark"])
    wide.text(0.03, high, "lens", va="center")
    wide.text(-0.02, (high + h) / 2, f"{1000 * (high - h):.0f} mm", ha="right", fontsize=9)
    wide.text(away / 2, h + 0.02, f"{1000 * away:.0f} mm", ha="center", fontsize=9)
    wide.set(xlim=(-0.22, away + 0.12), ylim=(-0.05, high + 0.06), ylabel="height [m]", title="Lens, ball and table")
    near.text(away - 0.004, 0.015, f"{1000 * h:.0f} mm", ha="right", va="center", fontsize=9)
    near.text(away + beyond / 2, -0.006, f"{1000 * beyond:.0f} mm", ha="center", va="top", fontsize=9)
    near.set(xlim=(away - 0.06, away + 0.06), ylim=(-0.03, 0.075), title="The last 12 cm of it")
    return figure


def bare_picture(ax, image, title=""):
    """Draw a picture without ticks, with pixel (0, 0) centred on the origin."""
    show_picture(ax, image, title, interpolation="antialiased")
    ax.set_axis_off()


def pinhole_figure(**points):
    """Draw rays through a pinhole and where they cut the plane at Z = 1 (the idea of Figure 3.10). Returns: LabFigure.

    points: up to three by name, (X, Y, Z) m in camera coordinates; X over Z is drawn, as seen from above.
    """
    figure, ax = subplots(7.4, 3.2)
    ax.axvline(1, color=COLOURS["blue"], linewidth=2, label="the plane Z = 1")
    for colour, (name, (X, _, Z)) in zip(("orange", "green", "purple"), points.items(), strict=False):
        end = max(1.0, Z)
        ax.plot([0, end], [0, X / Z * end], color=COLOURS[colour], linewidth=1)
        ax.plot(Z, X, "o", color=COLOURS[colour], label=f"{name}, x = {X / Z:.2f}")
        ax.plot(1, X / Z, "s", color=COLOURS[colour], markersize=5, zorder=3)
    ax.plot(0, 0, "o", color="white", markeredgecolor=COLOURS["dark"], markersize=9, zorder=3, label="the hole")
    ax.set(xlabel="Z [m], forward", ylabel="X [m], to the right", title="Seen from above: x is to 1 as X is to Z")
    ax.legend(fontsize=8, loc="upper left")
    return figure


def contact_sheet(images, calibration):
    """Draw all pictures, small: corners on those that were used, the reason on the others. Returns: LabFigure.

    images: pictures (h, w, 3), in the order given to `calibrate`; calibration: Calibration.
    """
    rows = -(-len(images) // 5)
    figure = new_figure(9.0, 1.62 * rows + 0.2, rows=rows, cols=5, note=STAMP)
    for view in calibration.views:
        ax, corners = figure.axes[view.index], view.corners / 2
        bare_picture(ax, images[view.index][::2, ::2])
        ax.plot(*corners.T, ".", color=COLOURS["green"], markersize=2.5)
        ax.plot(*corners[0], "o", color=COLOURS["amber"], markersize=4)
    for ax in figure.axes[len(images) :]:
        ax.set_visible(False)
    for one in calibration.rejected:
        ax = figure.axes[one.index]
        bare_picture(ax, images[one.index])
        ax.set_title(str(one.reason), fontsize=9, color=COLOURS["orange"], fontweight="bold")
    return figure
