"""A picture that hears clicks: a click in a map moves the sliders of a live figure.

    panel = live(figure, update, kp=slider(20, 1500, 5, 289), kd=slider(0, 200, 1, 40))
    click_sets(panel, figure.axes[0], x="kp", y="kd")

Everything the mouse does the sliders and number boxes of the panel do as well, for keyboards and screen readers.
"""

import html

import anywidget
import traitlets

from ir50p_lab.errors import InputError

__all__ = ["ClickableImage", "click_sets"]

# A new picture replaces the old one only once it is decoded, so that nothing flickers.
_SHOW_AND_LISTEN = """
function render({ model, el }) {
  const img = document.createElement("img");
  img.style.maxWidth = "100%";
  img.style.cursor = "crosshair";
  let shown = null;
  const show = () => {
    const url = URL.createObjectURL(new Blob([model.get("value")], { type: "image/png" }));
    const old = shown;
    shown = url;
    img.onload = () => { if (old) URL.revokeObjectURL(old); };
    img.src = url;
  };
  const describe = () => { img.alt = model.get("description"); img.style.width = model.get("width"); };
  img.addEventListener("click", (event) => {
    const box = img.getBoundingClientRect();
    const right = (event.clientX - box.left) / box.width;
    const up = (box.bottom - event.clientY) / box.height;
    model.set("clicked", [right, up, event.timeStamp]);
    model.save_changes();
  });
  img.addEventListener("dragstart", (event) => event.preventDefault());
  model.on("change:value", show);
  model.on("change:width", describe);
  model.on("change:description", describe);
  describe();
  show();
  el.appendChild(img);
  return () => { model.off("change:value", show); if (shown) URL.revokeObjectURL(shown); };
}
export default { render };
"""


class ClickableImage(anywidget.AnyWidget):
    """A PNG picture that reports where it was clicked.

    value: the PNG file (bytes); width: CSS width, such as "900px"; description: what screen readers say;
    clicked: [right, up, time] of the last click, as fractions 0..1 of the picture from its lower left corner.
    `on_click(function)` calls `function(right, up)` for every click.
    """

    _esm = _SHOW_AND_LISTEN
    value = traitlets.Bytes(b"").tag(sync=True)
    width = traitlets.Unicode("auto").tag(sync=True)
    description = traitlets.Unicode("").tag(sync=True)
    clicked = traitlets.List().tag(sync=True)

    def on_click(self, function):
        """Call `function(right, up)` for every click from now on."""
        self.observe(lambda change: function(float(change["new"][0]), float(change["new"][1])), "clicked")


def click_sets(panel, axes, *, x, y):
    """Let a click in `axes` of a panel of `live` set its sliders `x` and `y` to the clicked values.

    Values are moved to the nearest step of the slider. What goes wrong appears in the panel's status line.

    Args: panel: LivePanel; axes: one of its figure's 2-D axes; x, y: names of two of its sliders.
    Returns: the same panel. Raises InputError if the axes are not of this figure, or x or y is no slider.
    """
    if axes not in panel.figure.axes or hasattr(axes, "get_proj"):
        raise InputError("click_sets needs 2-D axes of the panel's own figure, such as figure.axes[0]")
    for name in (x, y):
        if not hasattr(panel.controls.get(name), "step"):
            raise InputError(f"no slider {name!r}; this panel has {', '.join(panel.controls)}")
    image = ClickableImage(
        value=bytes(panel.image.value),
        width=panel.image.layout.width,
        description=f"A map: a click sets {x} and {y}, as the sliders above do",
    )

    def moved(right, up):
        try:
            place = data_coordinates(axes, right, up)
            if place is None:
                return
            values = {name: _on_scale(panel.controls[name], v) for name, v in zip((x, y), place, strict=True)}
        except Exception as error:  # invisible in a browser otherwise
            panel.status.value = f'<span style="color:#c0392b">{html.escape(f"{type(error).__name__}: {error}")}</span>'
            return
        try:
            panel.set(**values)
        except Exception:
            if panel.error is None:
                raise
            # else the panel has written it into its status line

    image.on_click(moved)
    old, panel.image = panel.image, image
    panel.children = tuple(image if child is old else child for child in panel.children)
    old.close()
    return panel


def data_coordinates(axes, right, up):
    """Data coordinates (x, y) of a point of the picture, fractions from its lower left; None outside the axes."""
    width, height = axes.figure.bbox.size
    pixel = (right * width, up * height)
    if not axes.get_window_extent().contains(*pixel):
        return None
    return tuple(float(v) for v in axes.transData.inverted().transform(pixel))


def _on_scale(control, value):
    steps = round((value - control.min) / control.step)
    return type(control.value)(min(max(control.min + steps * control.step, control.min), control.max))
