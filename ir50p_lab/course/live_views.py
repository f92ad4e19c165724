"""Small panels around LiveArm that several notebooks use."""

import ipywidgets
import numpy as np

from ir50p_lab.course.live_arm import LiveArm


def step_through(arm, poses, p, **options):
    """The arm in one of several poses (n, 3) rad for the place p (3,) m, chosen by a slider: a widget."""
    view = LiveArm(arm, poses[0], ball=(p, 0.012), sliders=False, **options)
    chosen = ipywidgets.IntSlider(1, 1, len(poses), description="pose")
    said = ipywidgets.Label()

    def show(change):
        q = np.asarray(poses[change["new"] - 1])
        view.q = q.tolist()
        kept = bool((q >= arm.q_min).all() and (q <= arm.q_max).all())
        said.value = f"q = {np.degrees(q).round(1)} deg, {'within the limits' if kept else 'beyond a joint limit'}"

    chosen.observe(show, names="value")
    show({"new": 1})
    return ipywidgets.VBox([view, ipywidgets.HBox([chosen, said])])
