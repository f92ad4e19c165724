"""Checks of arguments at the public edge: a wrong shape, a wrong type or a NaN gets a sentence instead of a result."""

import math

import numpy as np

from ir50p_lab.errors import InputError


def vectors3(name, value, *, unit="rad"):
    """Return `value` as a float array of shape (..., 3).

    Raises InputError, naming `name` and `unit`, if the shape is not (3,) or (n, 3) or a number is not finite.
    """
    array = numbers(name, value, unit=unit)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError(f"{name} has shape {array.shape}; give shape (3,), or (n, 3) with one row per sample ({unit})")
    if not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}; every number must be finite ({unit}): repair it")
    return array


def vector3(name, value, *, unit="rad"):
    """Return `value` as a float array (3,). Raises InputError as `vectors3` does, and for more than one row."""
    array = vectors3(name, value, unit=unit)
    if array.shape != (3,):
        raise InputError(f"{name} has shape {array.shape}; give three numbers, shape (3,) ({unit})")
    return array


def numbers(name, value, *, unit="its unit"):
    """Return `value` as a float array of any shape. Raises InputError for ragged rows and what is no real number."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must hold numbers in {unit}; got {value!r:.60}") from None


def number(name, value, rule="finite", *, unit="", hint=""):
    """Return `value` as a float. rule: "finite", ">= 0", "> 0", or "> 0 or inf".

    Raises InputError, ending with `hint`.
    """
    try:
        x = math.nan if isinstance(value, (str, bytes, bool)) or np.ndim(value) > 0 else float(value)
    except (TypeError, ValueError, OverflowError):
        x = math.nan
    fits = {"finite": math.isfinite(x), ">= 0": 0 <= x < math.inf, "> 0": 0 < x < math.inf, "> 0 or inf": x > 0}
    if not fits[rule]:
        asked = "one finite number" if rule == "finite" else f"one {'' if 'inf' in rule else 'finite '}number {rule}"
        raise InputError(f"{name} = {value!r:.60}{' ' * bool(unit)}{unit}: give {asked}{': ' * bool(hint)}{hint}")
    return x


def whole(name, value, least, most):
    """Return `value` as an int from `least` to `most`. Raises InputError."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise InputError(f"{name} = {value!r:.60}: give a whole number from {least} to {most}")
    return int(value)


def choice(name, value, choices):
    """Return `value`, which is one of some texts (or of True and False). Raises InputError, which names them all."""
    if not isinstance(value, (str, bool, np.bool_)) or value not in choices:
        raise InputError(f"{name} = {value!r:.60}: choose {' or '.join(map(repr, choices))}")
    return value


def first_not_finite(array):
    """Describe the first NaN or infinity in `array`, with its place."""
    place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
    return f"{array[place]} at index {place[0] if len(place) == 1 else place}"
