"""Notebook 17: from a pixel to a place, and where the camera's numbers come from."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "sight_view": ["SightView"],
        "trials": ["calibrated_with_noise", "find_circles"],
        "views": ["circled", "contact_sheet", "grid_figure", "pinhole_figure", "triangles_figure"],
    },
)
