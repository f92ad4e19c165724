"""A picture to click: the hand of the arm goes where the pixel looks, at a height that a slider sets."""

import ipywidgets as widgets

from ir50p_lab.course.draw.picture_view import PictureView
from ir50p_lab.course.draw.style import alarm
from ir50p_lab.course.draw.widgets import explain


class SightView(widgets.VBox):
    """A picture, a slider for the height, and the arm.

    Args:
        picture: (h, w, 3) bytes. pose_for: f(pixel, height m) -> q (3,) rad, or None if the arm cannot go there.
        hand: LiveArm. pixel: (x, y), where it looks at first.
    """

    def __init__(self, picture, pose_for, hand, pixel):
        self._pose_for, self._hand, self._pixel = pose_for, hand, pixel
        self.picture = PictureView(picture, self._clicked, alt="The picture of the camera: a click chooses a pixel")
        self.height = widgets.IntSlider(30, 0, 60, description="height [mm]", style={"description_width": "initial"})
        self.height.observe(self._go, "value")
        seen = widgets.VBox([self.picture, self.height], layout={"width": "46%"})
        super().__init__([widgets.HBox([seen, widgets.Box([hand], layout={"width": "54%"})])])
        self._go()

    def _clicked(self, x, y):
        self._pixel = x, y
        return self._go()

    def _go(self, _=None):
        """Move the hand; the line under the picture says where it looks."""
        x, y = self._pixel
        self.picture.circles = [(x, y, 6, "white")]
        try:
            q = self._pose_for(self._pixel, self.height.value / 1000)
        except Exception as error:  # of the student's function
            self.picture.status.value = alarm(explain(error))
            raise
        words = f"pixel ({x:.0f}, {y:.0f}) at {self.height.value} mm"
        if q is None:
            words += ": the arm does not reach that"
        else:
            self._hand.q = [float(angle) for angle in q]
        self.picture.status.value = words
        return words

    def _repr_mimebundle_(self, **kwargs):
        """The widget, and the picture of this moment for viewers without widgets (an exported page)."""
        data, metadata = self.picture._repr_mimebundle_(**kwargs)
        return super()._repr_mimebundle_(**kwargs) | {"image/png": data["image/png"]}, metadata
