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
    blur_diameter,
    find_balls,
    image_distance,
    learn_colour,
    rays_on_sensor,
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


class ThinLensView:
    """Rays of an object through a thin lens onto the sensor (Figure 3.8), and blur over distance; for sliders.

    Three panels: lens and sensor to scale; the place where the rays meet, much larger; the blur over the distance. In
    orange the object, in blue a point that is in focus.

    f: m; pixel: size of a pixel, m. Attribute figure; `update(focused_at, object_at, aperture_mm)`.
    """

    def __init__(self, *, f, pixel):
        self._f, self._pixel = f, pixel
        self._alpha = np.geomspace(0.1, 4.0, 300)
        self.figure, self._whole, self._close, curve = subplots(10.2, 3.5, cols=3, width_ratios=(1.2, 1, 1.3))
        far, near = 1000 * f, 1000 * float(image_distance(0.1, f))  # mm behind the lens: the pictures' range
        self._whole.set(xlim=(-2.5, 1.2 * far), ylim=(-2.1, 2.1), aspect="equal", title="Lens and sensor, to scale")
        self._whole.set(xlabel="behind the lens [mm]", ylabel="height [mm]")
        (self._stop,) = self._whole.plot([], [], color=COLOURS["dark"], linewidth=4, solid_capstyle="butt")
        self._close.set(xlim=(far - 0.03, near + 0.07), ylim=(-30, 30), title="Where they meet; bar: the disc")
        self._close.set(xlabel="behind the lens [mm]", ylabel="height [µm]")
        self._rays, self._sensors = [], []
        for ax in (self._whole, self._close):
            self._sensors += ax.plot([], [], color=COLOURS["grey"], linewidth=3)
            in_focus = ax.plot([], [], color=COLOURS["blue"], linewidth=1.6)
            self._rays.append(in_focus + ax.plot([], [], color=COLOURS["orange"], linewidth=1))
        (self._disc,) = self._close.plot([], [], color=COLOURS["orange"], linewidth=5, solid_capstyle="butt")
        self._whole.text(0, -1.98, "lens", ha="center", fontsize=8, color=COLOURS["dark"])
        self._whole.text(far, -1.98, "sensor", ha="center", fontsize=8, color=COLOURS["dark"])
        self._whole.text(-2.4, 1.72, "point in focus", fontsize=8, color=COLOURS["blue"])
        self._whole.text(0.5, 1.72, "object", fontsize=8, color=COLOURS["orange"])
        (self._curve,) = curve.loglog([], [], color=COLOURS["dark"])
        (self._sharp,) = curve.loglog([], [], "o", color=COLOURS["blue"], clip_on=False)
        (self._mark,) = curve.loglog([], [], "o", color=COLOURS["orange"], clip_on=False)
        curve.axhline(1, color=COLOURS["dark"], linestyle="--", linewidth=1)
        curve.set(xlim=(0.1, 4), ylim=(0.05, 100), xlabel="distance of the object [m]")
        curve.set_ylabel(f"blur [pixels of {1e6 * pixel:g} µm]")
        curve.set_xticks([0.1, 0.2, 0.5, 1, 2, 4], ["0.1", "0.2", "0.5", "1", "2", "4"])
        curve.set_yticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
        curve.minorticks_off()
        curve.set_title("Sharp at one distance, nearly so around it")
        for ax in self.figure.axes:
            ax.title.set_fontsize(10)

    def update(self, focused_at, object_at, aperture_mm):
        """Draw focus and object (m) and aperture (mm). Returns the blur, and where it stays below a pixel, in words."""
        aperture = aperture_mm / 1000
        sensor = 1000 * float(image_distance(focused_at, self._f))
        for line, reach in zip(self._sensors, (1.65, 40), strict=True):
            line.set_data([sensor, sensor], [-reach, reach])
        half = 500 * aperture
        self._stop.set_data([0, 0, np.nan, 0, 0], [-1.65, -half, np.nan, half, 1.65])
        for k, alpha in enumerate((focused_at, object_at)):
            self._rays[0][k].set_data(*self._bundle(alpha, aperture, (-2.5, 0.0, sensor)))
            x, y = self._bundle(alpha, aperture, self._close.get_xlim())
            self._rays[1][k].set_data(x, 1000 * y)
        disc = 1e6 * rays_on_sensor(object_at, focused_at, self._f, aperture)
        self._disc.set_data([sensor, sensor], [disc.min(), disc.max()])
        blur = blur_diameter(self._alpha, focused_at, self._f, aperture) / self._pixel
        self._curve.set_data(self._alpha, np.maximum(blur, 1e-3))
        own = float(blur_diameter(object_at, focused_at, self._f, aperture)) / self._pixel
        self._mark.set_data([object_at], [max(own, 0.05)])
        self._sharp.set_data([focused_at], [0.05])
        sharp = self._alpha[blur < 1]
        where = f"from {sharp.min():.2f} to {sharp.max():.2f} m" if len(sharp) else "nowhere"
        return f"blur of the object {own:.1f} px; below one pixel {where}"

    def _bundle(self, alpha, aperture, places):
        """Five rays of a point at alpha m, at `places` (mm behind the lens): one line with gaps, x and y in mm."""
        h = np.linspace(-500 * aperture, 500 * aperture, 5)[:, None]
        x = np.array([*places, np.nan])
        slope = np.where(x <= 0, h / (1000 * alpha), h / (1000 * alpha) - h / (1000 * self._f))
        return np.tile(x, 5), (h + slope * x).ravel()


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
