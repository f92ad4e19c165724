"""The controls of a live figure: sliders, whose number can be clicked and typed, and menus."""

import math
from dataclasses import dataclass

import ipywidgets as widgets

from ir50p_lab.errors import InputError


@dataclass(frozen=True)
class Slider:
    """A slider from `min` to `max` in steps of `step`, at `start`; if all are whole, its values are whole (int)."""

    min: float
    max: float
    step: float
    start: float
    label: str | None = None
    unit: str = ""

    def __post_init__(self):
        if not self.min < self.max or not 0 < self.step or not self.min <= self.start <= self.max:
            raise InputError(
                f"slider min={self.min}, max={self.max}, step={self.step}, start={self.start}: "
                "need min < max, step > 0 and min <= start <= max"
            )


def slider(min, max, step, start, *, label=None, unit=""):
    """Describe one slider for `live`: its range, step and start, the text before it and the unit behind it.

    Returns: Slider.
    """
    return Slider(min, max, step, start, label, unit)


def make_control(name, spec, label_width, moved):
    """Return the widget that holds the value, and the row that shows it; `moved()` is called after each change."""
    style, layout = {"description_width": label_width}, {"width": f"calc({label_width} + 230px)"}
    if isinstance(spec, list | dict) and spec:
        control = widgets.Dropdown(options=spec, description=name, style=style, layout=layout)
        control.observe(lambda _: moved(), "value")
        return control, control
    if isinstance(spec, tuple) and len(spec) == 4:
        spec = Slider(*spec)
    if not isinstance(spec, Slider):
        raise InputError(f"{name}={spec!r}: give (min, max, step, start), slider(...) or a list of choices")
    common = {"min": spec.min, "max": spec.max, "step": spec.step, "value": spec.start}
    whole = all(isinstance(v, int) for v in common.values())
    kind = widgets.IntSlider if whole else widgets.FloatSlider
    decimals = 0 if whole else max(0, math.ceil(-math.log10(spec.step)))
    shown = {"readout_format": "d" if whole else f".{decimals}f"}
    control = kind(**common, **shown, description=spec.label or name, style=style, layout=layout)
    control.observe(lambda _: moved(), "value")
    return control, widgets.HBox([control, widgets.Label(spec.unit)])


def value_of(control):
    """Return the value of a control without the rounding noise of the browser's steps (1.0599999999999998 for 1.06)."""
    return round(control.value, 9) if isinstance(control, widgets.FloatSlider) else control.value


def on_scale(control, value):
    """Return the value nearest to `value` at which a slider can stand."""
    steps = round((value - control.min) / control.step)
    return type(control.value)(min(max(control.min + steps * control.step, control.min), control.max))


def refuse_bad_value(name, value, controls):
    """Raise InputError unless `name` is one of the controls and `value` is on its scale."""
    if name not in controls:
        raise InputError(f"no control {name!r}; this panel has {', '.join(controls)}")
    control = controls[name]
    if hasattr(control, "min") and not control.min <= value <= control.max:
        raise InputError(f"{name} = {value} is off its slider ({control.min} to {control.max})")


def close_all(widget):
    """Close a widget and those inside it, which the browser and the kernel would otherwise keep for ever."""
    for child in getattr(widget, "children", ()):
        close_all(child)
    widget.layout.close()
    widgets.Widget.close(widget)
