"""Notebooks 06 and 07: simulation, trajectories, friction and motors."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "friction_views": ["dragged", "friction_figure", "seconds_to_lift"],
    },
)
