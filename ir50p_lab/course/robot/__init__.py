"""What the student owns: the functions of `my_robot`, in which order and where they lie, and the arm they are about."""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(__name__, submodules=["my_robot"])
