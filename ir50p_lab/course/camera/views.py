"""Figures of notebook 17: what a hole does, which pictures a calibration used, how a bent board shows."""

import numpy as np

from ir50p_lab.course.draw.pictures import STAMP, show_picture
from ir50p_lab.course.draw.style import COLOURS, new_figure, subplots
from ir50p_lab.vision import Checkerboard


def bare_picture(ax, image, title=""):
    """A picture without ticks, pixel (0, 0) centred on the origin."""
    show_picture(ax, image, title, interpolation="antialiased")
    ax.set_axis_off()


def pinhole_figure(points):
    """Rays through a pinhole and where they cut the plane at Z = 1 (the idea of Figure 3.10). Returns: LabFigure.

    points: up to three {name: (X, Y, Z) m, camera coordinates}; X over Z is drawn, as seen from above.
    """
    figure, ax = subplots(7.4, 3.2)
    far = 1.12 * max(1.1, *(Z for _, _, Z in points.values()))
    top = max(max(X, X / Z) for X, _, Z in points.values())
    ax.axhline(0, color=COLOURS["dark"], linewidth=1)
    ax.axvline(1, color=COLOURS["blue"], linewidth=2)
    for k, (name, (X, _, Z)) in enumerate(points.items()):
        colour, end = COLOURS[("orange", "green", "purple")[k]], max(1.0, Z)
        if k == 0:  # the similar triangles
            ax.fill([0, 1, 1], [0, 0, X / Z], color=COLOURS["blue"], alpha=0.1)
            ax.fill([0, Z, Z], [0, 0, X], color=colour, alpha=0.2)
            ax.plot([Z, Z], [0, X], color=colour, linewidth=1)
        ax.plot([0, end], [0, X / Z * end], color=colour, linewidth=1, linestyle=("-", "--", ":")[k])
        ax.plot(Z, X, "o", color=colour, markersize=8 - 2 * k)
        ax.annotate(name, (Z, X), (-6, 6), textcoords="offset points", ha="right", color=colour, fontweight="bold")
        ax.plot(1, X / Z, "s", color=COLOURS["blue"], markersize=5, zorder=3)
    for x in sorted({round(X / Z, 6) for X, _, Z in points.values()}):
        ax.annotate(f"x = {x:.2f}", (1, x), (6, -13), textcoords="offset points", color=COLOURS["blue"])
    ax.plot(0, 0, "o", color="white", markeredgecolor=COLOURS["dark"], markersize=9, zorder=3)
    ax.text(0, -0.04 * top, "hole", ha="left", va="top", fontsize=9)
    ax.text(1, -0.04 * top, " plane Z = 1", ha="left", va="top", fontsize=9, color=COLOURS["blue"])
    ax.set(xlim=(-0.03, far), ylim=(-0.2 * top, 1.25 * top), xlabel="Z [m], forward", ylabel="X [m], to the right")
    ax.set_title("Similar triangles: x is to 1 as X is to Z")
    return figure


def contact_sheet(images, calibration):
    """All pictures, small: corners on those that were used, the reason on the others. Returns: LabFigure.

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


def board_residual_figure(picture, flat, bent):
    """One picture, and the residuals by place on the board, mean over the views, as depths: flat model beside bent.

    Args: picture (h, w, 3); flat, bent: Calibration of the same pictures without and with the shape of the board.
    Returns: LabFigure.
    """
    figure, first, *maps = subplots(10.5, 3.1, cols=3, width_ratios=(1.1, 1, 1), note=STAMP)
    bare_picture(first, picture, "One of the pictures")
    for ax, one, name in zip(maps, (flat, bent), ("Board taken for flat", "Its shape free"), strict=True):
        deeper = np.mean([_depths(one, view) for view in one.views], axis=0)
        board = one.board or bent.board or Checkerboard()  # corners that were given name no board
        columns, rows = board.pattern
        place = 1000 * board.square * np.array([-0.5, columns - 0.5, rows - 0.5, -0.5])
        drawn = ax.imshow(1000 * deeper.reshape(rows, columns), cmap="PuOr", vmin=-1, vmax=1, extent=place)
        ax.set(xlabel="along the board [mm]", ylabel="down the board [mm]")
        ax.set_title(f"{name}: rms {one.rms:.3f} px", fontsize=9)
        ax.grid(False)
    figure.colorbar(drawn, ax=maps, label="lies deeper by [mm]", shrink=0.8)
    return figure


def _depths(calibration, view):
    """How much deeper (n,) m each corner of a view would have to lie to be seen where it was found."""
    step = np.array([0, 0, 1e-4])
    there = calibration.pinhole.project(view.T_cam_board, view.points + step)
    back = calibration.pinhole.project(view.T_cam_board, view.points - step)
    direction = (there - back) / 2e-4  # px/m
    return (view.residuals * direction).sum(axis=1) / (direction**2).sum(axis=1)
