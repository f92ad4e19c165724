"""The panel of notebook 16: a picture to click; rendered pictures say that they are."""

import html

import ipywidgets as widgets
import numpy as np

from ir50p_lab.course.draw.canvas import Canvas
from ir50p_lab.course.draw.painter import encode_png
from ir50p_lab.course.draw.pictures import STAMP
from ir50p_lab.course.draw.style import alarm
from ir50p_lab.errors import LabError
from ir50p_lab.vision import RED, find_balls, learn_colour


class ClickColour(widgets.VBox):
    """A picture to click: the colour there is learnt, its mask shown beside the picture, the balls of it outlined.

    Attributes: image_box (Canvas), status; colour, the Colour in use; balls, what find_balls says to it.
    `click(x, y)` does from Python what the mouse does.
    """

    def __init__(self, image):
        self._image = image
        self.status = widgets.HTML()
        self.image_box = Canvas(
            description="Left a picture to click, right the mask of the colour that was clicked",
            layout={"width": "900px", "max_width": "100%"},
        )
        super().__init__([self.image_box, self.status])
        self._use(RED)
        self.image_box.on_click(self._clicked)

    def click(self, x, y):
        """Learn the colour at pixel (x, y) and look for balls of it; a refusal appears in the status line."""
        try:
            self._use(learn_colour(self._image, (x, y)))
        except LabError as error:
            self.status.value = alarm(str(error))

    def _clicked(self, right, up):
        height, width = self._image.shape[:2]
        x = right * 2 * width
        self.click((x if x < width else x - width) - 0.5, (1 - up) * height - 0.5)

    def _use(self, colour):
        import cv2

        self.colour, self.balls = colour, find_balls(self._image, colour)
        left, mask = self._image.copy(), colour.mask(self._image)
        for ball in self.balls:
            centre, radius = (round(16 * ball.x), round(16 * ball.y)), round(16 * ball.radius)
            cv2.circle(left, centre, radius, (255, 255, 255), 3, cv2.LINE_AA, 4)
            cv2.circle(left, centre, radius, (0, 114, 178), 1, cv2.LINE_AA, 4)
        right = cv2.cvtColor(mask, cv2.COLOR_GRAY2RGB)
        right[[0, 1, -2, -1]] = right[:, [0, 1, -2, -1]] = 153  # a frame: it may be white on a white page
        self.image_box.value = encode_png(np.hstack([left, right]))
        found = f"{len(self.balls)} ball{'s' * (len(self.balls) != 1)}" if self.balls else self.balls.reason
        self.status.value = html.escape(
            f"hue {colour.hue:.0f} ± {colour.tolerance:.0f} degrees, saturation from {colour.saturation:.2f}: {found} "
            f"({STAMP})"
        )
