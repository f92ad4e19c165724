"""Notebook 18: reaching for what the camera sees."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "arms": [
            "camera_for",
            "follow_clicks",
            "law_for",
            "locator_for",
            "on_copies",
            "picture_with_ball",
            "seen_circle",
            "true_tip",
            "path",
        ],
        "functions.find_and_reach": ["edges_of", "strongest"],
        "views": ["looks_figure"],
    },
)
