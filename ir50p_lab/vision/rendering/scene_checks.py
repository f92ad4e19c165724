"""Checks of what a scene is made of: each says the thing, the field, the value and what to give."""

import numpy as np

from ir50p_lab.errors import InputError


def check_numbers(thing, *, above=None, at_least=None, **sizes):
    """Check that each field named in `sizes` holds that many finite numbers, above or at least a limit."""
    for name, size in sizes.items():
        value = getattr(thing, name)
        what = f"{name} = {value!r} of a {type(thing).__name__}"
        numbers = "a number" if size == 1 else f"{size} numbers"
        try:
            array = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{what}: give {numbers}") from None
        if array.shape != (() if size == 1 else (size,)) or not np.isfinite(array).all():
            raise InputError(f"{what}: give {numbers}, finite")
        if above is not None and (array <= above).any():
            raise InputError(f"{what}: must be more than {above:g}")
        if at_least is not None and (array < at_least).any():
            raise InputError(f"{what}: must be at least {at_least:g}")


def check_pose(thing, name):
    """Check that field `name` is a rigid transform (4, 4)."""
    T, what = getattr(thing, name), f"{name} of a {type(thing).__name__}"
    try:
        T = np.asarray(T, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what} must be a 4x4 matrix, got {T!r:.60}") from None
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise InputError(f"{what} has shape {T.shape} or numbers that are not finite: give a 4x4 transform")
    R = T[:3, :3]
    rigid = np.abs(R.T @ R - np.eye(3)).max() < 1e-6 and np.linalg.det(R) > 0 and (T[3] == (0, 0, 0, 1)).all()
    if not rigid:
        raise InputError(f"{what} is no rigid transform: a rotation at the upper left, last row 0 0 0 1")
