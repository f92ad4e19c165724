"""What is checked before the numbers of an answer: is it an array of the right shape, are there enough results?"""

import numpy as np


def kind_of(returned):
    """Return why something cannot be read as numbers, or ""."""
    if callable(returned):
        return f"it returns the function {getattr(returned, '__name__', '')}, not what that gives: add its arguments"
    try:
        np.asarray(returned, dtype=float)
    except (TypeError, ValueError):
        kind = type(returned).__name__
        if isinstance(returned, tuple | list):
            return f"it returns a {kind} of {len(returned)} things that do not make an array: one array is wanted"
        return f"it returns {kind} that cannot be read as an array of numbers: {str(returned)[:60]!r}"
    return ""


def no_numbers(returned, expected):
    """Return why an answer cannot be compared with the expected one at all, or ""."""
    if returned is None:
        return "it returns nothing for some inputs: is its `return` reached in every case?"
    if says := kind_of(returned):
        return says
    array, wanted = np.asarray(returned, dtype=float), np.shape(expected)
    if array.shape != wanted:
        if array.size == np.size(expected) and np.allclose(array.ravel(), np.ravel(expected)):
            return f"the numbers are right, but their shape is not: {array.shape}, expected is {wanted}"
        if array.shape[1:] == wanted and array.ndim > 1:
            return f"it returns {len(array)} arrays where one is wanted"
        return f"it returns an array of shape {array.shape}; expected is {wanted}"
    if not np.isfinite(array).all() and np.isfinite(np.asarray(expected, dtype=float)).all():
        return "it returns a number that is not finite (nan or inf): a division by zero, the root of a number below 0?"
    return ""


def number_of_results(names, returned, expected):
    """Return why an answer does not have as many results as are asked for, or ""."""
    asked = f"{len(names)} results are asked for, {', '.join(names)}, in this order"
    if returned is None:
        return f"it returns nothing for some inputs: {asked}"
    if isinstance(returned, np.ndarray) and returned.ndim and returned.shape[1:] != np.shape(expected[0]):
        return f"{asked}; yours returns one array of shape {returned.shape}"
    if isinstance(returned, tuple | list) or (isinstance(returned, np.ndarray) and returned.ndim):
        return "" if len(returned) == len(names) else f"{asked}; yours returns {len(returned)}"
    return f"{asked}; yours returns one {type(returned).__name__}"
