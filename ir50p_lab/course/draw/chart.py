"""Curves over time as a picture of lines (SVG), which Python writes in some milliseconds without drawing a figure.

Every picture holds all that is shown: a browser that leaves some out is right again with the next one, and a page
without a kernel keeps the last one.
"""

import html
import time

import ipywidgets
import numpy as np
from matplotlib.colors import to_hex, to_rgb
from matplotlib.ticker import MaxNLocator

from ir50p_lab.course.draw.style import COLOURS

_INK = COLOURS["dark"]
_LOCATOR = MaxNLocator(7, steps=[1, 2, 5, 10])


class Chart(ipywidgets.HTML):
    """Panels of curves over time; `frames` counts the pictures, including the first, which has no curves.

    Args: panels: for each the arguments of `_panel` from `place`. window: how many s they hold; height: pixels, for a
    width of 1000; description: what screen readers say.
    """

    def __init__(self, panels, *, window, height, description):
        self._panels, self._window, self.frames = panels, window, 0
        columns = [column for panel in panels for column, *_ in panel["lines"]]
        self._head = (
            f'<svg viewBox="0 0 1000 {height}" role="img" aria-label="{html.escape(description)}" fill="none" '
            'style="display: block; min-width: 600px; font: 12px sans-serif; background: white">'
        )
        super().__init__(layout={"width": "100%", "max_width": "1060px"})
        self.draw(np.empty((0, 1 + max(columns))))

    def draw(self, rows, marks=()):
        """Show rows (n, k), with the time (s) first, and a dotted line at each of the times `marks`."""
        end = max([self._window, *rows[-1:, 0]])
        times = _ticks(end - self._window, end)
        panels = (_panel(rows, marks, end - self._window, end, times, **panel) for panel in self._panels)
        self.value = f"{self._head}{''.join(panels)}</svg>"
        self.frames += 1


def _panel(rows, marks, start, end, times, *, place, lines, levels=(), ylim=None, title="", ylabel="", xlabel=""):
    """One panel. place: left, top, width, height; lines: (column, colour, label, dashed) each.

    levels: (value, colour) of dashed lines; ylim: if it is fixed.
    """
    left, top, width, height = place
    if ylim is None:
        shown = rows[:, [column for column, *_ in lines]]
        shown = shown[np.isfinite(shown)]
        low, high = (shown.min() - 2, shown.max() + 2) if shown.size else (-10, 10)
        ylim = _LOCATOR.tick_values(low, high)[[0, -1]]
    low, high = ylim

    def x(t):
        return width * (t - start) / (end - start)

    def y(value):
        return height * (high - value) / (high - low)

    parts = [f'<g transform="translate({left} {top})">', _text(0, -10, "start", (title, _INK))]
    for value, words in _ticks(low, high):
        parts.append(_line(f"M0 {y(value):.1f}h{width}", "#E6E6E6") + _text(-5, y(value) + 4, "end", (words, _INK)))
    for t, words in times:
        parts.append(_line(f"M{x(t):.1f} 0v{height}", "#E6E6E6") + _text(x(t), height + 14, "middle", (words, _INK)))
    parts += [_line(f"M0 0v{height}h{width}", "#666666"), _text(width / 2, height + 31, "middle", (xlabel, _INK))]
    parts.append(f'<g transform="translate(-44 {height / 2}) rotate(-90)">{_text(0, 0, "middle", (ylabel, _INK))}</g>')
    named = [(f"{label}: {_said(rows[-1, k])}" if len(rows) else label, ink) for k, ink, label, _ in lines if label]
    parts += [_text(width, -10, "end", *named), f'<svg width="{width}" height="{height}">']  # cuts off the rest
    parts += [_line(f"M{x(mark):.1f} 0v{height}", "#C0392B", 'stroke-dasharray="2 3"') for mark in marks]
    parts += [_line(f"M0 {y(level):.1f}h{width}", colour, 'stroke-dasharray="6 4"') for level, colour in levels]
    for column, colour, _, dashed in lines:
        seen = rows[np.isfinite(rows[:, column])]
        points = np.column_stack([x(seen[:, 0]), y(seen[:, column]).clip(-height, 2 * height)])
        path = " ".join(map(str, np.round(10 * points).astype(int).ravel().tolist()))  # tenths of a pixel
        time.sleep(0)  # the loop at a simulated bench shares this process: it need not wait for the whole picture
        dashes = 'stroke-dasharray="60 40" ' * dashed
        parts.append(f'<polyline transform="scale(0.1)" stroke="{colour}" stroke-width="16" {dashes}points="{path}"/>')
    return "".join([*parts, "</svg></g>"])


def _ticks(low, high):
    """[(value, words)] from low to high."""
    ticks = _LOCATOR.tick_values(low, high).tolist()
    return [(tick, _said(tick, ".9g")) for tick in ticks if low <= tick <= high]


def _line(path, colour, style=""):
    return f'<path d="{path}" stroke="{colour}" {style}/>'


def _text(x, y, anchor, *words):
    """Words in their colours, (text, colour) each, one after the other, dark enough to read on white."""
    inks = [(html.escape(text), to_hex(0.65 * np.array(to_rgb(colour)))) for text, colour in words]
    spans = "\N{EM SPACE}".join(f'<tspan fill="{ink}">{text}</tspan>' for text, ink in inks)
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{spans}</text>'


def _said(value, style=".4g"):
    return f"{value + 0.0:{style}}".replace("-", "\N{MINUS SIGN}")
