"""What the student owns: the functions of `my_robot`, in which order and where they lie, and the arm they are about."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=["my_robot"])
