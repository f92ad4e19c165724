"""Drawings that never change: SVG files in `data/drawings`, made by tests/support/make_drawings.py."""

from ir50p_lab.home import PROJECT


def drawing(name):
    """A drawing, shown when it is the last line of a cell: IPython.display.SVG."""
    from IPython.display import SVG

    return SVG(filename=PROJECT / "data" / "drawings" / f"{name}.svg")
