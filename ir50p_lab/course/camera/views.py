"""Figures of notebook 17: what a hole and a lens do, which pictures a calibration used, where its residuals point."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from ir50p_lab.course.draw.pictures import STAMP, show_picture
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, new_figure, subplots
from ir50p_lab.vision import Pinhole


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


class DistortionView:
    """A square grid as a lens shows it: straight lines in grey, what becomes of them in blue; `update` moves them.

    Args: pinhole: Pinhole, whose K and size are used. Attribute: figure.
    """

    def __init__(self, pinhole):
        self.pinhole = pinhole
        w, h = pinhole.size
        across = np.meshgrid(np.linspace(0, w - 1, 41), np.linspace(0, h - 1, 9))
        down = np.meshgrid(np.linspace(0, w - 1, 12), np.linspace(0, h - 1, 41), indexing="ij")
        straight = np.concatenate([np.stack(across, axis=-1), np.stack(down, axis=-1)])  # (21, 41, 2)
        self._rays = pinhole.to_normalised(straight)
        self._radius = np.linspace(0, np.linalg.norm(self._rays, axis=-1).max(), 100)
        self.figure, ax = subplots(6.4, 5.0)
        ax.grid(False)  # it would pass for the grid that is drawn
        ax.add_collection(LineCollection(straight, colors=COLOURS["grey"], linewidths=1))
        self._lines = LineCollection(straight, colors=COLOURS["blue"], linewidths=1.5)
        ax.add_collection(self._lines)
        ax.plot(*pinhole.K[:2, 2], "+", color=COLOURS["orange"], markersize=12)
        ax.set(xlim=(-60, w + 60), ylim=(h + 60, -60), aspect="equal", xlabel="x [px]", ylabel="y [px]")
        ax.set_title("A square grid through the lens")

    def update(self, k1=0.0, k2=0.0, p1=0.0, p2=0.0):
        """Draw the grid for these coefficients; returns in words what it looks like and how far a point moves."""
        lens = Pinhole(self.pinhole.K, (k1, k2, p1, p2), self.pinhole.size)
        xy = lens.to_pixels(lens.distort(self._rays))
        self._lines.set_segments(xy)
        moved = np.linalg.norm(xy - lens.to_pixels(self._rays), axis=-1).max()
        seen = [radial_shape(k1, k2, self._radius), "wider on one side" * bool(p1 or p2)]
        shape = ", ".join(filter(None, seen)) or "straight"
        return f"{shape}: a point moves by up to {moved:.1f} px"


def radial_shape(k1, k2, radius):
    """What k1 and k2 make of straight lines out to `radius`, from 0 upwards: "barrel", "pincushion", both, or ""."""
    magnified = np.diff(k1 * radius**2 + k2 * radius**4)  # outwards less and less: a barrel
    names = ["barrel"] * bool((magnified < 0).any()) + ["pincushion"] * bool((magnified > 0).any())
    return " and further out ".join(names if magnified[0] < 0 else names[::-1])


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


def estimate_figure(calibration, truth):
    """Estimate minus truth, in standard errors, for each number that was estimated. Returns: LabFigure.

    truth: Pinhole that rendered the pictures.
    """
    right = dict(zip(calibration.values, (truth.fx, truth.fy, truth.cx, truth.cy, *truth.distortion), strict=True))
    names = [name for name, error in calibration.stderr.items() if np.isfinite(error)]
    off = [(calibration.values[n] - right[n]) / calibration.stderr[n] for n in names]
    figure, ax = subplots(8.0, 2.8, note=STAMP)
    ax.axhspan(-3, 3, color=COLOURS["light"], alpha=0.4)
    ax.axhline(0, color=COLOURS["dark"], linewidth=1)
    ax.errorbar(range(len(names)), off, yerr=1, fmt="o", capsize=4, color=COLOURS["blue"])
    ax.set(ylim=(-4, 4), ylabel="error [standard errors]", xlabel=" ", xlim=(-0.5, len(names) - 0.5))
    ax.set_xticks(range(len(names)), names)
    ax.set_title(f"The truth is within {max(np.abs(off)):.1f} standard errors of every number")
    return figure


def rms_figure(reports, noise):
    """rms of the residuals and standard error of fx over the number of views, both logarithmic. Returns: LabFigure.

    reports: {views: (rms, standard error of fx), px}; noise: rms to be expected of many views, px.
    """
    figure, ax = subplots(6.4, 3.4)
    views = list(reports)
    rms, error = np.transpose(list(reports.values()))
    ax.plot(views, error, "o-", color=COLOURS["orange"])
    ax.plot(views, rms, "s-", color=COLOURS["blue"])
    ax.axhline(noise, **SETPOINT)
    for words, at, shift, colour in (
        ("standard error of fx", (views[1], error[1]), (10, 4), "orange"),
        ("rms of the residuals", (views[-1], noise), (-120, 5), "blue"),
        ("to be expected of many views", (views[0], noise), (6, 5), "dark"),
    ):
        ax.annotate(words, at, shift, textcoords="offset points", color=COLOURS[colour])
    ax.set(xscale="log", yscale="log", xlabel="number of views [-]", ylabel="[px]")
    ax.set_xticks(views, [str(n) for n in views])
    ax.minorticks_off()
    ticks = [t for t in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20) if 0.7 * rms.min() < t < 1.5 * error.max()]
    ax.set_yticks(ticks, [f"{t:g}" for t in ticks])
    ax.set_title("The rms stays, the camera becomes known")
    return figure


def residual_figure(images, calibration, view):
    """A picture with its residuals as arrows, 500 times longer, beside those of all views. Returns: LabFigure."""
    one, gain = calibration.views[view], 500
    figure, left, right = subplots(9.0, 3.8, cols=2, width_ratios=(1.5, 1), note=STAMP)
    bare_picture(left, images[one.index], f"{one.name}: residuals, {gain} times longer, rms {one.rms:.3f} px")
    arrows = {"angles": "xy", "scale_units": "xy", "scale": 1 / gain, "width": 0.006}
    left.quiver(*one.corners.T, *one.residuals.T, color=COLOURS["orange"], **arrows)
    every = np.concatenate([other.residuals for other in calibration.views])
    right.plot(*every.T, ".", color=COLOURS["grey"], markersize=2)
    right.plot(*one.residuals.T, ".", color=COLOURS["orange"], markersize=5)
    right.add_patch(Circle((0, 0), calibration.rms, fill=False, edgecolor=COLOURS["dark"], linewidth=1, zorder=3))
    reach = 4 * calibration.rms
    right.set(xlim=(-reach, reach), ylim=(reach, -reach), aspect="equal", xlabel="x [px]", ylabel="y [px]")  # y down
    right.set_title(f"All views: rms {calibration.rms:.3f} px (circle)", fontsize=10)
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
        columns, rows = one.board.pattern
        place = 1000 * one.board.square * np.array([-0.5, columns - 0.5, rows - 0.5, -0.5])
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


def table_figure(image, pixels, errors):
    """The picture with the balls that were found, beside the errors of their places. Returns: LabFigure.

    Args: image (h, w, 3); pixels (n, 2) of the balls; errors: {name: estimate minus truth (n, 2) m}.
    """
    figure, left, right = subplots(9.0, 3.7, cols=2, width_ratios=(1.3, 1), note=STAMP)
    bare_picture(left, image, "Balls at the places of Table 4.8")
    left.plot(*np.transpose(pixels), "+", color="white", markersize=12, markeredgewidth=2)
    for (name, error), marker in zip(errors.items(), "xo^", strict=False):
        right.plot(*(1000 * error).T, marker, fillstyle="none", label=name)
    right.plot(0, 0, "+", color=COLOURS["dark"], markersize=14)
    right.set(xlabel="error in x [mm]", ylabel="error in y [mm]", aspect="equal", title="Where the estimates fall")
    right.margins(0.12)
    right.legend(fontsize=8)
    return figure
