"""Notebooks 10 and 11: the bench, calibrated and driven."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "panel": ["live_panel"],
    },
)
