"""Notebooks 04 and 05: the mass matrix and the equation of motion."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "driven_arm": ["driven"],
        "governor_view": ["GovernorView"],
    },
)
