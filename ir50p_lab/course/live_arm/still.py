"""A picture of the view for viewers without WebGL or without a kernel."""

import io

import numpy as np
from PIL import Image

from ir50p_lab.course.arm3d import ArmView
from ir50p_lab.course.live_arm.track import path_of
from ir50p_lab.course.painter import DRAWING
from ir50p_lab.course.style import COLOURS, new_figure


def still_png(view):
    """The present pose of a LiveArm, and its path if it plays a run, by matplotlib: bytes of a PNG file."""
    with DRAWING:
        figure = new_figure(7.2, 4.6, projection="3d")
        ax = figure.axes[0]
        arm = ArmView(ax, view.arm, view.q, frames="frames" in view.layers)
        if view.track and "trail" in view.layers:
            arm.trail(path_of(view.arm, view.track, view.shape))
        if "ball" in view.things:
            ax.scatter(*np.transpose([view.things["ball"]["p"]]), s=90, color="#C8102E")
        ax.text2D(0.02, 0.95, view.options["badge"], transform=ax.transAxes, color=COLOURS["dark"], weight="bold")
        stream = io.BytesIO()
        figure.savefig(stream, format="png")
    small = io.BytesIO()
    Image.open(stream).convert("RGB").quantize(64).save(small, format="png", optimize=True)
    return small.getvalue()
