"""A picture that hears clicks: a click in a map moves the sliders of a live figure.

    panel = live(figure, update, kp=slider(20, 1500, 5, 289), kd=slider(0, 200, 1, 40))
    click_sets(panel, figure.axes[0], x="kp", y="kd")

Everything the mouse does the sliders and number boxes of the panel do as well, for keyboards and screen readers.
"""

import contextlib

from ir50p_lab.course.draw.controls import on_scale


def click_sets(panel, axes, *, x, y):
    """Let a click in `axes` of a panel of `live` set its sliders `x` and `y` to the clicked values.

    Values are moved to the nearest step of the slider. What goes wrong appears in the panel's status line.

    Args: panel: LivePanel; axes: one of its figure's 2-D axes; x, y: names of two of its sliders.
    Returns: the same panel.
    """
    panel.image.description = f"A map: a click sets {x} and {y}, as the sliders above do"

    def clicked(right, up):
        pixel = (right, up) * panel.figure.bbox.size
        if axes.get_window_extent().contains(*pixel):
            place = zip((x, y), axes.transData.inverted().transform(pixel), strict=True)
            with contextlib.suppress(Exception):  # it is in the status line
                panel.set(**{name: on_scale(panel.controls[name], value) for name, value in place})

    panel.image.on_click(clicked)
    return panel
