"""The student's lab book: predictions, notes and figures; with it results, claims and progress."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "predictions": ["change", "keep", "measured", "note", "now", "path", "predict", "read", "why"],
        "student_file": ["LabBookError"],
        "ball_misses": ["so_far"],
    },
)
