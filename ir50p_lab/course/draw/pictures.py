"""Pictures in figures: pixel for pixel, and with where they come from."""

from ir50p_lab.course.draw.style import new_figure

STAMP = "rendered, not photographed"
_GREY = {"cmap": "gray", "vmin": 0, "vmax": 255, "interpolation": "nearest"}


def show_picture(ax, picture, title="", **options):
    """Draw a picture, (h, w, 3) or (h, w), into axes whose units are pixels. Returns the artist."""
    artist = ax.imshow(picture, **({} if picture.ndim == 3 else _GREY) | options)
    ax.grid(False)
    ax.set_title(title, fontsize=10)
    ax.tick_params(labelsize=7)
    return artist


def pictures_figure(*titled, width=9.6, source=STAMP):
    """Return a LabFigure with pictures side by side, each (title, picture). source: where they come from, in words."""
    rows, columns = titled[0][1].shape[:2]
    height = 0.55 + width / len(titled) * rows / columns
    figure = new_figure(width, min(height, 5.2), cols=len(titled), note=source)
    for ax, (title, picture) in zip(figure.axes, titled, strict=True):
        show_picture(ax, picture, title)
    figure.axes[0].set(xlabel="x [px]", ylabel="y [px]")
    return figure
