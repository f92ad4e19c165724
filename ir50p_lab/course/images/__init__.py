"""Notebook 16: images and the ball."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submod_attrs={
        "notebook_functions": ["best_circle", "edges_of", "strongest", "with_neighbours"],
        "views": ["bench_pictures", "bench_with_ball", "pictures_figure", "votes_figure"],
    },
)
