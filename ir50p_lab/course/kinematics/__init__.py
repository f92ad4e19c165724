"""Notebooks 01 to 03: pose, inverse kinematics, velocities."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "frame_walk": ["arm_by_table", "chain", "walk"],
        "self_collision": ["through_column"],
    },
)
