"""Notebooks 08, 09 and A2: a controller built from its parts, broken, tuned, and taken further."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "breaking": ["broken", "name_it"],
        "contest_rules": ["LIMITS", "PID", "contest", "score"],
        "loop_views": ["Trembling", "ends", "weight_over_angle"],
        "speed_response": ["speed_jump"],
        "tuning_views": ["one_joint", "tuning_panel"],
    },
)
