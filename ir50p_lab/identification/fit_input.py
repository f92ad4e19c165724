"""Checks of arrays that come from outside: each refusal names the value, the limit and the remedy."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, numbers, vectors3


def checked_data(Phi, y):
    """Return Phi (n, 3, 20) and y (n, 3) as float arrays. Raises InputError for other shapes or numbers not finite."""
    Phi, y = blocks("Phi", Phi), vectors3("y", y, unit="PWM or N m")
    if y.shape != Phi.shape[:2]:
        raise InputError(f"y has shape {y.shape}, Phi {Phi.shape}; give y (n, 3) with a row for each of Phi")
    return Phi, y


def blocks(name, value):
    """Return `value` as a float array (n, 3, 20), all finite. Raises InputError, which names `name`."""
    array = numbers(name, value)
    if array.ndim != 3 or array.shape[1:] != (3, 20) or not len(array):
        raise InputError(f"{name} has shape {array.shape}; give (n, 3, 20), n >= 1, as regressor(q, qd, qdd) returns")
    return finite(name, array)


def finite(name, value):
    """Return `value` as a float array of any shape, all finite.

    Raises InputError naming `name` and the first that is not.
    """
    array = numbers(name, value)
    # the sum first, which is much faster: it is finite unless some number is not, or is huge
    if not np.isfinite(array.sum()) and not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}: remove or repair that sample")
    return array
