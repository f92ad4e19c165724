"""Notebook 19: an arm that nobody has seen."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "far_bench": ["FarBench"],
        "notebook_functions": ["both_ways", "camera_at", "most_counts"],
        "race_day": ["Raced"],
        "robot": [
            "COLUMNS",
            "OnLegs",
            "PracticePath",
            "Rate",
            "find_balls",
            "motion",
            "plan",
            "with_a_pull",
        ],
        "world": ["World"],
    },
)
