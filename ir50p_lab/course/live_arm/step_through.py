"""Poses of the arm, one after the other, by a slider below LiveArm."""

import ipywidgets
import numpy as np

from ir50p_lab.course.live_arm.view import LiveArm


class _Steps(ipywidgets.VBox):
    def _repr_mimebundle_(self, **kwargs):
        """The widgets, and the arm's picture for viewers without them."""
        picture = self.children[0]._repr_mimebundle_(**kwargs)[0]["image/png"]
        return super()._repr_mimebundle_(**kwargs) | {"image/png": picture}


def step_through(arm, poses, p, **options):
    """Return a widget: the arm in one of several poses (n, 3) rad for the place p (3,) m, chosen by a slider."""
    view = LiveArm(arm, poses[0], ball=(p, 0.012), sliders=False, **options)
    chosen = ipywidgets.IntSlider(1, 1, len(poses), description="pose")

    def show(change):
        view.q = np.asarray(poses[change["new"] - 1]).tolist()

    chosen.observe(show, names="value")
    return _Steps([view, chosen])
