"""Checks of array arguments at the public edge: a wrong shape or a NaN gets a sentence, not a result."""

import numpy as np

from ir50p_lab.errors import InputError


def vectors3(name, value, *, unit="rad"):
    """Return `value` as a float array of shape (..., 3).

    Raises InputError, naming `name` and `unit`, if the shape is not (3,) or (n, 3) or a number is not finite.
    """
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must hold numbers in {unit}; got {value!r}") from None
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError(f"{name} has shape {array.shape}; give shape (3,), or (n, 3) with one row per sample ({unit})")
    if not np.isfinite(array).all():
        raise InputError(
            f"{name} holds {first_not_finite(array)}; every number must be finite ({unit}): "
            "remove or repair that sample"
        )
    return array


def first_not_finite(array):
    """Describe the first NaN or infinity of `array`, with its place."""
    place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
    return f"{array[place]} at index {place if len(place) > 1 else place[0]}"


def check_arm(arm):
    """Return `arm`. Raises InputError if it is no Arm."""
    from ir50p_lab.modelling.arm import Arm

    if not isinstance(arm, Arm):
        raise InputError(f"arm = {arm!r:.60}: give an Arm, such as IR50P or load_arm()")
    return arm
