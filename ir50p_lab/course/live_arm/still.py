"""A picture of the view for viewers without WebGL or without a kernel."""

import io

import numpy as np
from PIL import Image

from ir50p_lab.course.arm3d import ArmView, FrameView
from ir50p_lab.course.live_arm.track import path_of
from ir50p_lab.course.painter import DRAWING
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.modelling.differential import jacobian


def still_png(view):
    """The present pose of a LiveArm, and its path if it plays a run, by matplotlib: bytes of a PNG file."""
    with DRAWING:
        figure = new_figure(7.2, 4.6, projection="3d")
        ax = figure.axes[0]
        arm = ArmView(ax, view.arm, view.q, frames="frames" in view.layers)
        if view.track and "trail" in view.layers:
            arm.trail(path_of(view.arm, view.track, view.shape))
        if "ball" in view.things:
            ax.scatter(*np.transpose([view.things["ball"]["p"]]), s=230, color="#C8102E")
        if view.poses:
            arm.set_visible(False)
            T = np.array(view.poses, dtype=float)
            corners = T[:, :3, 3]
            colour = "#B8C2CC" if "frames" in view.layers else COLOURS["blue"]  # their z is blue
            ax.plot(*corners.T, color=colour, linewidth=8, solid_capstyle="round")
            if "shadow" in view.layers:
                ax.plot(*corners[1:, :2].T, 0, color="#000000", alpha=0.10, linewidth=6, zorder=2)
            if "frames" in view.layers and np.isfinite(T).all():
                ax.view_init(elev=22, azim=-30)
                for k in range(4):
                    FrameView(ax, T[k], str(k), 0.28 * view.arm.reach)
        _ellipsoids(ax, view)
        ax.text2D(0.02, 0.95, view.options["badge"], transform=ax.transAxes, color=COLOURS["dark"], weight="bold")
        stream = io.BytesIO()
        figure.savefig(stream, format="png")
    small = io.BytesIO()
    Image.open(stream).convert("RGB").quantize(64).save(small, format="png", optimize=True)
    return small.getvalue()


def _ellipsoids(ax, view):
    """At the tip, as large as in the browser; at a singular pose that of the forces has no end and is left out."""
    J = jacobian(view.arm, view.q)[:3]
    tip = forward_kinematics(view.arm, view.q)
    turn, height = np.linspace(0, 2 * np.pi, 41), np.linspace(0, np.pi, 21)[:, None]
    ball = np.stack(np.broadcast_arrays(np.sin(height) * np.cos(turn), np.sin(height) * np.sin(turn), np.cos(height)))
    for name, colour, matrix, row in (
        ("velocity ellipsoid", COLOURS["sky"], lambda: 0.25 * J, 0),
        ("force ellipsoid", COLOURS["purple"], lambda: 0.025 * np.linalg.inv(J).T, 1),
    ):
        if name in view.layers and (row == 0 or abs(np.linalg.det(J)) > 1e-4):
            surface = np.einsum("ij,jkl->ikl", matrix(), ball) + tip[:, None, None]
            ax.plot_surface(*surface, color=colour, alpha=0.35, linewidth=0)
            ax.text2D(0.02, 0.88 - 0.06 * row, name, transform=ax.transAxes, color=colour)
