"""Figures and panels of notebook 09: pictures, colour, edges, votes, blur; rendered pictures say that they are."""

import html

import ipywidgets as widgets
import numpy as np
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ir50p_lab.course.clickable import ClickableImage
from ir50p_lab.course.painter import encode_png
from ir50p_lab.course.style import COLOURS, new_figure
from ir50p_lab.errors import LabError
from ir50p_lab.vision import RED, blur_diameter, find_balls, learn_colour, rgb_to_hsv

STAMP = "rendered, not photographed"
_GREY = {"cmap": "gray", "vmin": 0, "vmax": 255, "interpolation": "nearest"}


def stamp(figure, text=STAMP):
    """Write in the lower right corner of a figure, below its axes, where its pictures are from. Returns the figure."""
    engine, strip = figure.get_layout_engine(), 0.16 / figure.get_figheight()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0, strip, 1, 1 - strip))
    x, y = 1.0 - 0.04 / figure.get_figwidth(), 0.03 / figure.get_figheight()
    figure.text(x, y, text, ha="right", va="bottom", fontsize=7.5, color=COLOURS["grey"], style="italic")
    return figure


def show_picture(ax, picture, title="", **options):
    """Draw a picture, (h, w, 3) or (h, w), into axes whose units are pixels. Returns the artist."""
    artist = ax.imshow(picture, **({} if picture.ndim == 3 else _GREY) | options)
    ax.grid(False)
    ax.set_title(title, fontsize=10)
    ax.tick_params(labelsize=7)
    return artist


def pictures_figure(*titled, width=9.6, height=None, source=STAMP):
    """Pictures side by side: each (title, picture). source: where they are from, in words. Returns: LabFigure."""
    shape = titled[0][1].shape
    each = width / len(titled)
    figure = new_figure(width, height or min(0.55 + each * shape[0] / shape[1], 5.2), cols=len(titled))
    for ax, (title, picture) in zip(figure.axes, titled, strict=True):
        show_picture(ax, picture, title)
    figure.axes[0].set(xlabel="x [px]", ylabel="y [px]")
    return stamp(figure, source)


def numbers_figure(grey, x, y, n=9, *, source=STAMP):
    """A corner of a grey picture as grey levels and as numbers (Figure 3.1): n x n pixels from (x, y)."""
    part = grey[y : y + n, x : x + n]
    figure = new_figure(4.6, 4.4)
    ax = figure.axes[0]
    show_picture(ax, part, "An image is a matrix of numbers", extent=(x - 0.5, x + n - 0.5, y + n - 0.5, y - 0.5))
    for row in range(n):
        for col in range(n):
            ink = "white" if part[row, col] < 128 else "black"
            ax.text(x + col, y + row, str(part[row, col]), ha="center", va="center", fontsize=7.5, color=ink)
    ax.set(xlabel="x [px]", ylabel="y [px]")
    return stamp(figure, source)


def colour_solids_figure():
    """The RGB cube and the HSV cone (Figures 3.3, 3.4), each point in its own colour."""
    steps = np.linspace(0, 255, 9)
    rgb = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    rgb = rgb[(rgb == 0).any(axis=1) | (rgb == 255).any(axis=1)]
    hue, saturation, value = rgb_to_hsv(rgb).T
    figure = new_figure(9.0, 4.2, cols=2, projection="3d")
    cube, cone = figure.axes
    for ax, points in (
        (cube, rgb),
        (
            cone,
            np.column_stack(
                [p * saturation * value for p in (np.cos(np.radians(hue)), np.sin(np.radians(hue)))] + [value]
            ),
        ),
    ):
        ax.scatter(*points.T, c=rgb / 255, s=22, depthshade=False)
        ax.set_box_aspect(None, zoom=0.85)  # room for the labels, which the layout does not see
    cube.set(xticks=(0, 128, 255), yticks=(0, 128, 255), zticks=(0, 128, 255))
    cone.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1), zticks=(0, 0.5, 1))
    cube.set(xlabel="R [level]", ylabel="G [level]", zlabel="B [level]", title="RGB: a cube")
    cone.set(xlabel="S V cos H [1]", ylabel="S V sin H [1]", zlabel="V [1]", title="HSV: a cone, hue is the angle")
    return figure


def ball_hues_figure(image, ball):
    """Hue and saturation of the pixels of a ball, with the ranges of 4.5.1: what they take and what they lose.

    image: RGB; ball: Ball. Returns: LabFigure, share of the ball's coloured pixels that the ranges of 4.5.1 take.
    """
    rows, cols = np.mgrid[: image.shape[0], : image.shape[1]]
    disc = np.hypot(cols - ball.x, rows - ball.y) < 0.95 * ball.radius
    hue, saturation, _ = rgb_to_hsv(image[disc]).T
    turned = (hue + 180) % 360 - 180  # -180..180: red in the middle
    taken = (turned > -20) & (turned < 0) & (saturation > 0.2) & (saturation < 0.8)
    figure = new_figure(6.4, 3.6)
    ax = figure.axes[0]
    ax.fill_between([-20, 0], 0.2, 0.8, color=COLOURS["light"], label="4.5.1: 340 to 360 degrees, 0.2 to 0.8")
    ax.plot(turned[~taken], saturation[~taken], ".", ms=4, color=COLOURS["orange"], label="pixels it loses")
    ax.plot(turned[taken], saturation[taken], ".", ms=4, color=COLOURS["blue"], label="pixels it takes")
    ax.set(xlim=(-40, 40), ylim=(0, 1.02), xlabel="hue [degrees; -20 is 340]", ylabel="saturation [1]")
    ax.set_title(f"4.5.1 keeps {taken.mean():.0%} of the ball")
    ax.legend(fontsize=8, loc="lower right")
    return stamp(figure), float(taken.mean())


class MaskView:
    """A picture beside its mask, for sliders: `update(mask)`. Attribute figure, for `live`.

    One artist, pixel for pixel, holds both: that is what keeps a slider step short.
    """

    def __init__(self, image):
        height, width = image.shape[:2]
        self._both = np.concatenate([image, np.zeros_like(image)], axis=1)
        self.figure = new_figure(2 * width / 100, (height + 26) / 100)
        self.figure.set_layout_engine("none")
        ax = self.figure.axes[0]
        ax.set_position([0, 0, 1, height / (height + 26)])
        ax.set_axis_off()
        self._shown = ax.imshow(self._both, interpolation="nearest", aspect="auto")
        ax.set_title(f"The picture ({STAMP}), and white what lies in the ranges", fontsize=10)

    def update(self, mask):
        """Show a mask (h, w) uint8 of 0 and 255, and say how much of the picture it is."""
        self._both[:, mask.shape[1] :] = mask[:, :, None]
        self._shown.set_data(self._both)
        return f"{np.count_nonzero(mask) / mask.size:.2%} of the picture"


def mask_between(hsv, hue_low, hue_high, s_low, s_high, v_low):
    """255 where a picture in HSV (degrees, 0..1, 0..1; (h, w, 3)) lies in the ranges; hue_low > hue_high wraps."""
    hue, saturation, value = hsv[..., 0], hsv[..., 1], hsv[..., 2]
    near = (hue - hue_low) % 360 <= (hue_high - hue_low) % 360
    return 255 * (near & (saturation >= s_low) & (saturation <= s_high) & (value >= v_low)).astype(np.uint8)


def canny_figure(steps, *, title="Thick slopes, then crests, then what hangs together"):
    """The four steps of Canny, from CannySteps: LabFigure."""
    figure = new_figure(9.6, 2.9, cols=4)
    strength = 255 * steps.strength / max(steps.strength.max(), 1)
    thin = 255 * np.clip(3 * steps.thin / max(steps.thin.max(), 1), 0, 1)
    panels = (
        ("1 smoothed", steps.smoothed),
        ("2 strength", strength),
        ("3 crests", thin),
        ("4 edges", 255 * steps.edges),
    )
    for ax, (name, picture) in zip(figure.axes, panels, strict=True):
        show_picture(ax, picture, name)
        ax.set(xticks=[], yticks=[])
    figure.suptitle(title, fontsize=11)
    return stamp(figure)


def votes_figure(points, votes, centre):
    """Edge points on a circle, and the votes of four of them or of all (Figure 3.7): LabFigure."""
    figure = new_figure(8.4, 3.8, cols=2)
    left, right = figure.axes
    show_picture(left, np.zeros(votes.shape), "edge points")
    left.plot(*np.asarray(points).T, ".", ms=5, color="white")
    shown = right.imshow(votes, cmap="viridis", interpolation="nearest")
    right.grid(False)
    figure.colorbar(shown, ax=right, label="votes [1]", shrink=0.85, ticks=range(int(votes.max()) + 1))
    right.plot(*centre, "+", ms=14, mew=2, color=COLOURS["orange"])
    right.set_title("most votes at the centre", fontsize=10)
    for ax in (left, right):
        ax.set(xlabel="x [px]", ylabel="y [px]")
    return figure


class LensView:
    """Rays of two points through a thin lens onto the sensor (Figure 3.8), and blur over distance; for sliders.

    f, aperture: m; pixel: size of a pixel, m. Attribute figure; `update(focused_at, aperture)`.
    """

    def __init__(self, *, f=0.004, pixel=3e-6):
        self._f, self._pixel = f, pixel
        self._alpha = np.geomspace(0.1, 4.0, 300)
        self.figure = new_figure(8.6, 3.4)
        ax = self.figure.axes[0]
        (self._curve,) = ax.loglog([], [], color=COLOURS["blue"])
        (self._mark,) = ax.loglog([], [], "o", color=COLOURS["orange"])
        ax.axhline(1, color=COLOURS["dark"], linestyle="--", linewidth=1)
        ax.set(xlim=(0.1, 4), ylim=(0.05, 100), xlabel="distance of the object [m]", ylabel="blur [px]")
        ax.set_xticks([0.1, 0.2, 0.5, 1, 2, 4], ["0.1", "0.2", "0.5", "1", "2", "4"])
        ax.minorticks_off()
        ax.set_title("Sharp at one distance, sharp enough around it")

    def blur_pixels(self, alpha, focused_at, aperture):
        """Diameter of the blur, pixels, of points at alpha m."""
        return blur_diameter(alpha, focused_at, self._f, aperture) / self._pixel

    def update(self, focused_at, aperture):
        """Draw the blur for this focus, m, and aperture, m. Returns where it stays below a pixel, in words."""
        blur = self.blur_pixels(self._alpha, focused_at, aperture)
        self._curve.set_data(self._alpha, np.maximum(blur, 1e-3))
        self._mark.set_data([focused_at], [0.05])
        sharp = self._alpha[blur < 1]
        return (
            f"below one pixel from {sharp.min():.2f} to {sharp.max():.2f} m" if len(sharp) else "nowhere below a pixel"
        )


def balls_figure(image, balls, title, *, source=STAMP):
    """A picture with the balls found, ranked: LabFigure."""
    figure = pictures_figure((title, image), width=7.2, source=source)
    ax = figure.axes[0]
    angle = np.linspace(0, 2 * np.pi, 100)
    for rank, ball in enumerate(balls, start=1):
        ax.plot(ball.x + ball.radius * np.cos(angle), ball.y + ball.radius * np.sin(angle), color="white", lw=2.5)
        ax.plot(
            ball.x + ball.radius * np.cos(angle), ball.y + ball.radius * np.sin(angle), color=COLOURS["blue"], lw=1.2
        )
        ax.plot(ball.x, ball.y, "+", ms=9, color="white")
        text = f"{rank}: ({ball.x:.1f}, {ball.y:.1f}), r {ball.radius:.1f} px, score {ball.score:.2f}"
        ax.text(
            ball.x,
            ball.y - 1.25 * ball.radius - 4,
            text,
            ha="center",
            fontsize=8,
            color="white",
            backgroundcolor="#0008",
        )
    return figure


class ClickColour(widgets.VBox):
    """A picture to click: the colour there is learnt, its mask shown beside the picture, the balls of it outlined.

    Attributes: image_box (ClickableImage), status; colour, the Colour in use; balls, what find_balls says to it.
    `click(x, y)` does from Python what the mouse does.
    """

    def __init__(self, image, colour=RED, *, source=STAMP):
        self._image, self._source = image, source
        self.status = widgets.HTML()
        self.image_box = ClickableImage(
            width="900px", description="Left a picture to click, right the mask of the colour that was clicked"
        )
        super().__init__([self.image_box, self.status])
        self._use(colour)
        self.image_box.on_click(self._clicked)

    def click(self, x, y):
        """Learn the colour at pixel (x, y) and look for balls of it; a refusal appears in the status line."""
        try:
            self._use(learn_colour(self._image, (x, y)))
        except LabError as error:
            self.status.value = f'<span style="color:#c0392b">{html.escape(str(error))}</span>'

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
        self.image_box.value = encode_png(np.concatenate([left, np.repeat(mask[..., None], 3, axis=2)], axis=1))
        found = f"{len(self.balls)} ball{'s' * (len(self.balls) != 1)}" if self.balls else self.balls.reason
        self.status.value = html.escape(
            f"hue {colour.hue:.0f} ± {colour.tolerance:.0f} degrees, saturation from {colour.saturation:.2f}: {found} "
            f"({self._source})"
        )
