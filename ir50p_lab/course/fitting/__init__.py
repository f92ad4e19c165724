"""Notebooks 12 and 13: parameters from recordings, and whether the model is good."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "functions.regressor": ["body_columns"],
        "gripper_views": ["bare_run", "go", "gripper_run", "loop_figure", "motions", "true_theta", "with_gripper"],
        "model_views": ["contest_score", "follow", "simulated", "suspects", "validation_figure", "waves"],
        "own_model": [
            "ACTS",
            "badge",
            "columns",
            "fit_rows",
            "mass_figure",
            "mass_of",
            "parts_of_push",
            "table_figure",
        ],
        "results": ["ablation_figure", "whiteness_figure"],
        "views": ["FeedbackLoop", "kept_motion", "two_copies"],
    },
)
