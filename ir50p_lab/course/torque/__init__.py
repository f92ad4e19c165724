"""Notebooks 14 and 15: computed torque."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "law_views": ["PushAndPD", "bars", "beside", "clearance", "driven", "kept_path", "robustness"],
        "bench_views": ["Learning", "OnBench", "copy_theta", "driven_on_bench", "go", "model_for", "table_of_gains"],
        "views": ["lateness", "naive_model", "training_run"],
    },
)
