"""Reads a Chart as an eye does: curves, marks and words of its panels, by the numbers at its ticks."""

import re
import xml.etree.ElementTree as ET
from types import SimpleNamespace

import numpy as np


def panels(svg):
    """Panels of a chart's picture, each with curves (t, values, colour, dashed), marks (s) and words."""
    return [_panel(group) for group in ET.fromstring(svg).findall("g")]


def _panel(group):
    texts = [(float(one.get("x")), float(one.get("y")), one.get("text-anchor"), "".join(one.itertext())) for one in
             group.findall("text")]  # fmt: skip
    clip = group.find("svg")
    height = float(clip.get("height"))
    at_left = [(y - 4, _number(words)) for x, y, anchor, words in texts if x == -5 and anchor == "end"]
    below = [(x, _number(words)) for x, y, anchor, words in texts if y == height + 14 and anchor == "middle"]
    to_t, to_value = (np.polynomial.Polynomial.fit(*zip(*ticks, strict=True), 1) for ticks in (below, at_left))
    curves = []
    for line in clip.findall("polyline"):
        x, y = np.array(line.get("points").split(), dtype=float).reshape(-1, 2).T / 10
        look = {"colour": line.get("stroke"), "dashed": line.get("stroke-dasharray") is not None}
        curves.append(SimpleNamespace(t=to_t(x), values=to_value(y), **look))
    paths = [one.get("d") for one in clip.findall("path")]
    marks = [to_t(float(found[1])) for path in paths if (found := re.fullmatch(r"M([\d.]+) 0v.*", path))]
    return SimpleNamespace(curves=curves, marks=marks, words=" ".join(words for *_, words in texts))


def _number(words):
    return float(words.replace("\N{MINUS SIGN}", "-"))
