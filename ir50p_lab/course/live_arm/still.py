"""A picture of the view for viewers without WebGL or without a kernel."""

import numpy as np

from ir50p_lab.course.arm3d import ArmView
from ir50p_lab.course.painter import DRAWING, Painter
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.modelling.chain import forward_kinematics


def still_png(view):
    """The present pose of a LiveArm, and its path if it plays a run, by matplotlib: bytes of a PNG file."""
    with DRAWING:
        figure = new_figure(7.2, 4.6, projection="3d")
        ax = figure.axes[0]
        arm = ArmView(ax, view.arm, view.q, frames="frames" in view.layers)
        if view.track and "trail" in view.layers:
            rows = np.frombuffer(view.track, "<f4").reshape(-1, view.shape["columns"])
            first = view.shape["runs"][0]["q"]
            arm.trail(forward_kinematics(view.arm, rows[:, first : first + 3]))
        if "ball" in view.options["things"]:
            ax.scatter(*view.options["things"]["ball"][0], s=230, color="#C8102E")
        if view.poses:
            if "frames" in view.layers:
                ax.view_init(elev=22, azim=-30)  # no axis hides another
            arm.place(np.array(view.poses, dtype=float))
        arm.ellipsoids(view.layers)
        ax.text2D(0.02, 0.95, view.options["badge"], transform=ax.transAxes, color=COLOURS["dark"], weight="bold")
        return Painter(figure).png()
