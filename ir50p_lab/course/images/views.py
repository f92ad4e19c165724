"""Figures and panels of notebook 16: pictures, colour, edges, votes, blur; rendered pictures say that they are."""

import html

import ipywidgets as widgets
import numpy as np
from matplotlib.colors import to_rgba_array

from ir50p_lab.course.draw.canvas import Canvas
from ir50p_lab.course.draw.drawings import drawing
from ir50p_lab.course.draw.painter import encode_png
from ir50p_lab.course.draw.pictures import STAMP, pictures_figure, show_picture
from ir50p_lab.course.draw.style import COLOURS, alarm, new_figure, subplots
from ir50p_lab.errors import LabError
from ir50p_lab.vision import (
    RED,
    find_balls,
    learn_colour,
    rgb_to_hsv,
)


def numbers_figure(grey, x, y, n=9, *, title="An image is a matrix of numbers", white=255, source=STAMP):
    """A corner of a grey picture as grey levels and as numbers (Figure 3.1): n x n pixels from (x, y).

    white: the level shown as white.
    """
    part = grey[y : y + n, x : x + n]
    figure, ax = subplots(0.91 + 0.41 * n, 0.71 + 0.41 * n, note=source)
    show_picture(ax, part, title, vmax=white, extent=(x - 0.5, x + n - 0.5, y + n - 0.5, y - 0.5))
    for row in range(n):
        for col in range(n):
            ink = "white" if part[row, col] < white / 2 else "black"
            ax.text(x + col, y + row, str(part[row, col]), ha="center", va="center", fontsize=7.5, color=ink)
    ax.set(xlabel="x [px]", ylabel="y [px]")
    return figure


def colour_solids_figure():
    """The RGB cube and the HSV cone (Figures 3.3, 3.4), each point in its own colour: SVG."""
    return drawing("colour_solids")


def ball_hues_figure(image, ball):
    """Hue and saturation of the pixels of a ball, with the ranges of 4.5.1: what they take and what they lose.

    image: RGB; ball: Ball. Returns: LabFigure, share of the ball's coloured pixels that the ranges of 4.5.1 take.
    """
    rows, cols = np.mgrid[: image.shape[0], : image.shape[1]]
    disc = np.hypot(cols - ball.x, rows - ball.y) < 0.95 * ball.radius
    hue, saturation, _ = rgb_to_hsv(image[disc]).T
    turned = (hue + 180) % 360 - 180  # -180..180: red in the middle
    taken = (turned > -20) & (turned < 0) & (saturation > 0.2) & (saturation < 0.8)
    figure, ax = subplots(6.4, 3.6, note=STAMP)
    ax.fill_between([-20, 0], 0.2, 0.8, color=COLOURS["light"], label="4.5.1: 340 to 360 degrees, 0.2 to 0.8")
    ax.plot(turned[~taken], saturation[~taken], ".", ms=4, color=COLOURS["orange"], label="pixels it loses")
    ax.plot(turned[taken], saturation[taken], ".", ms=4, color=COLOURS["blue"], label="pixels it takes")
    ax.set(xlim=(-40, 40), ylim=(0, 1.02), xlabel="hue [degrees; -20 is 340]", ylabel="saturation [1]")
    ax.set_title(f"4.5.1 keeps {taken.mean():.0%} of the ball")
    ax.legend(fontsize=8, loc="lower right")
    return figure, float(taken.mean())


class MaskView:
    """A picture beside its mask, pixel for pixel, for sliders: `update(mask)`. Attribute figure, for `live`."""

    def __init__(self, image):
        height, width = image.shape[:2]
        # two pictures, of which one stands still: only the mask is drawn anew
        self.figure, left, right = subplots(2 * width / 100, (height + 26) / 100, cols=2)
        self.figure.set_layout_engine("none")
        for ax, x in ((left, 0), (right, 0.5)):
            ax.set_position([x, 0, 0.5, height / (height + 26)])
            ax.set_axis_off()
        left.imshow(image, interpolation="nearest", aspect="auto")
        self._mask = right.imshow(np.zeros_like(image), interpolation="nearest", aspect="auto")
        # a title of the axes lies above the picture and would be drawn anew with it
        self.figure.suptitle(f"The picture ({STAMP}), and white what lies in the ranges", fontsize=10, y=0.99)

    def update(self, mask):
        """Show a mask (h, w) of booleans, and say how much of the picture it is."""
        self._mask.set_data(np.repeat(255 * mask[:, :, None].astype(np.uint8), 3, axis=2))
        return f"{mask.mean():.2%} of the picture"


def canny_figure(steps, low, high):
    """The four steps of Canny, from CannySteps; crests in classes by the thresholds low and high: LabFigure."""
    figure = new_figure(9.6, 2.9, cols=4, note=STAMP)
    colours = to_rgba_array(["black", "#444444", COLOURS["sky"], "white"])[:, :3]
    panels = (
        ("1 smoothed", steps.smoothed),
        ("2 strength of the slope", 255 * steps.strength / steps.strength.max()),
        ("3 crests: weak blue, strong white", colours[np.digitize(steps.thin, (1, low + 1, high + 1))]),
        ("4 edges", 255 * steps.edges),
    )
    for ax, (name, picture) in zip(figure.axes, panels, strict=True):
        show_picture(ax, picture, name)
        ax.set(xticks=[], yticks=[])
    figure.suptitle("Thick slopes, then crests, then what hangs on a strong one", fontsize=11)
    return figure


def votes_figure(points, votes, centre):
    """Edge points on a circle, and their votes for its centre, counted where two or more meet (Figure 3.7): LabFigure.

    points (n, 2): x, y; votes (h, w), as of circle_votes; centre: (x, y), gets a ring.
    """
    figure, left, right = subplots(8.4, 3.3, cols=2)
    show_picture(left, np.zeros(votes.shape), "edge points")
    left.plot(*np.asarray(points).T, ".", ms=5, color="white")
    shown = show_picture(right, votes, "most votes at the centre", cmap="viridis", vmin=None, vmax=None)
    figure.colorbar(shown, ax=right, label="votes [1]", shrink=0.85, ticks=range(int(votes.max()) + 1))
    right.plot(*centre, "o", ms=16, mew=1.5, mfc="none", color=COLOURS["orange"])
    for x, y, count in _meetings(votes):
        right.annotate(str(count), (x, y), (9, 7), textcoords="offset points", color="white", fontsize=10)
    for ax in (left, right):
        ax.set(xlabel="x [px]", ylabel="y [px]")
    return figure


def _meetings(votes, apart=10):
    """Places (x, y, count) of two or more votes, most first, none nearer than `apart` pixels to one with more."""
    found = []
    for y, x in sorted(np.argwhere(votes > 1).tolist(), key=lambda place: -votes[tuple(place)]):
        if all(np.hypot(x - a, y - b) > apart for a, b, _ in found):
            found.append((x, y, int(votes[y, x])))
    return found


def balls_figure(image, balls, title):
    """A picture with the Balls found, ranked, and dashed what had the colour and was no ball: LabFigure."""
    figure = pictures_figure((title, image), width=7.2)
    ax, (height, width) = figure.axes[0], image.shape[:2]
    for (x, y, radius), _ in balls.rejected:
        _circle(ax, x, y, radius, COLOURS["sky"], rim=0, linestyle="--")
    for rank, ball in enumerate(balls, start=1):
        _circle(ax, ball.x, ball.y, ball.radius, COLOURS["blue"])
        ax.plot(ball.x, ball.y, "+", ms=9, color="white")
        x, y = np.clip(ball.x, 0.24 * width, 0.76 * width), ball.y - 1.25 * ball.radius - 4
        if y < 0.05 * height:  # no room above it
            y = ball.y + 1.25 * ball.radius + 4 + 0.04 * height
        words = f"{rank}: ({ball.x:.1f}, {ball.y:.1f}), r {ball.radius:.1f} px, score {ball.score:.2f}"
        ax.text(x, y, words, ha="center", fontsize=8, color="white", backgroundcolor="#0008")
    ax.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    return figure


def sheet_figure(seen):
    """Eight pictures, small, each with the ball found and how far it is off; dashed where one was missed: LabFigure.

    seen: list of (picture, balls found, (x, y, radius) of the true ball).
    """
    figure = new_figure(9.6, 4.3, rows=2, cols=4, note=STAMP)
    for ax, (picture, found, (x, y, radius)) in zip(figure.axes, seen, strict=True):
        height, width = picture.shape[:2]
        ax.set_axis_off()
        ax.imshow(picture[::2, ::2], extent=(-0.5, width - 0.5, height - 0.5, -0.5))
        for ball in found:
            _circle(ax, ball.x, ball.y, ball.radius, COLOURS["blue"])
        if found:
            ax.set_title(f"{np.hypot(found[0].x - x, found[0].y - y):.2f} px off", fontsize=9, color=COLOURS["dark"])
        else:
            _circle(ax, x, y, 1.5 * radius, COLOURS["orange"], linestyle="--")
            ax.set_title("missed", fontsize=9, color=COLOURS["orange"])
        ax.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    return figure


def _circle(ax, x, y, radius, colour, *, rim=2.5, **style):
    """A circle in a colour with a white rim, seen on any picture; rim: its width, points."""
    angle = np.linspace(0, 2 * np.pi, 100)
    x, y = x + radius * np.cos(angle), y + radius * np.sin(angle)
    ax.plot(x, y, color="white", lw=rim)
    ax.plot(x, y, color=colour, lw=1.2, **style)


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
