"""Notebook 00: one angle, one matrix, and the arm turns."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "views": ["from_above", "speed_over_time", "turned_by"],
    },
)
