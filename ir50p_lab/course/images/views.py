"""Figures of notebook 16: pictures, edge pixels that vote, a bench whose ball is moved."""

import numpy as np

from ir50p_lab.course.draw.pictures import STAMP, pictures_figure, show_picture
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.lab_book.data_file import data_file
from ir50p_lab.errors import InputError
from ir50p_lab.vision.image import load_image

__all__ = ["bench_pictures", "bench_with_ball", "pictures_figure", "votes_figure"]

_FILES = {"red": "bench_16", "blue": "bench_16_blue"}
_EVERY = 7  # one edge pixel in so many is drawn


def bench_pictures(colour):
    """Return pictures of the bench with a "red" or a "blue" ball, from files: full light, dim light, without the ball.

    Returns: three pictures (480, 640, 3). Raises InputError for another colour.
    """
    if colour not in _FILES:
        raise InputError(f'bench_pictures({colour!r}): there is a bench in "red" and one in "blue"')
    return tuple(load_image(data_file(f"{_FILES[colour]}{which}.jpg")) for which in ("", "_dim", "_empty"))


def votes_figure(picture, edges, radius, votes):
    """Draw edge pixels with a line one radius inwards, and next to them the votes that they give. Returns: LabFigure.

    picture (h, w, 3); edges: points (n, 2) and unit vectors inwards (n, 2); radius, px; votes (h, w).
    Raises InputError if there is no edge.
    """
    points, inwards = edges
    if not len(points):
        raise InputError(
            "there is no edge pixel: the mask is all True, or all False. Is the tolerance 0, or far too large?"
        )
    figure, left, right = subplots(9.6, 4.2, cols=2, note=STAMP)
    show_picture(left, picture, "Each edge pixel points one radius inwards")
    ends = points + radius * inwards
    for here, there in zip(points[::_EVERY], ends[::_EVERY], strict=True):
        left.plot(*np.transpose([here, there]), color="white", linewidth=0.9)
    left.plot(*points[::_EVERY].T, ".", color=COLOURS["sky"], markersize=3)
    left.plot(*ends[::_EVERY].T, ".", color=COLOURS["amber"], markersize=5)
    show_picture(right, 255 * np.sqrt(votes / votes.max()), f"The votes: {votes.max()} at the brightest")
    low, high = points.min(axis=0) - 10, points.max(axis=0) + 10
    for ax in (left, right):
        ax.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]), xlabel="x [px]", ylabel="y [px]")
    return figure


def bench_with_ball(arm, x, y):
    """Return a small picture (240, 320, 3) of the bench: a red ball at (x, y) m, red tape, and the arm turned away."""
    from ir50p_lab.vision.rendering import Patch, SceneBall, arm_sticks, bench_camera, bench_scene, render_scene

    tape = Patch(position=(0.50, -0.05), size=(0.14, 0.02), angle=0.5)
    small, ball = bench_camera()[0].scaled((320, 240)), SceneBall(position=(x, y, 0.03))
    scene = bench_scene(ball, pinhole=small, patches=(tape,), arm=arm_sticks([2.6, 0.5, -1.0], arm))
    return render_scene(scene, seed=0)[0]
