"""Drawings that never change: SVG files in `data/drawings`, made by data/make_drawings.py."""

import base64
import re

from ir50p_lab.home import PROJECT


class Drawing:
    """A drawing, shown if it is the last line of a cell. data: its SVG, whose title says what it shows."""

    def __init__(self, data):
        self.data = data

    def _repr_html_(self):
        words = re.search("<title>(.*?)</title>", self.data, re.DOTALL)[1]
        data = base64.b64encode(self.data.encode()).decode("ascii")
        return f'<img src="data:image/svg+xml;base64,{data}" alt="{words}">'


def drawing(name):
    """Return the Drawing of this name."""
    return Drawing((PROJECT / "data" / "drawings" / f"{name}.svg").read_text("utf-8"))
