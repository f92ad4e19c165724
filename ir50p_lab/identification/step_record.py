"""A recorded step response, checked: columns, the steps of u, units of time, outliers."""

import math

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.doubts import outliers
from ir50p_lab.inputs import first_not_finite


def recorded(**columns):
    """Columns of a recording as float arrays: one dimension, one length, finite; `t` increasing. Raises InputError."""
    arrays = {}
    for name, value in columns.items():
        try:
            arrays[name] = np.array(value, dtype=float)
        except (TypeError, ValueError, OverflowError):
            raise InputError(f"{name} must be a list of numbers; got {type(value).__name__} {value!r:.60}") from None
        if arrays[name].ndim != 1 or not len(arrays[name]):
            raise InputError(f"{name} has shape {arrays[name].shape}; give one value per sample, shape (n,)")
    if len({len(array) for array in arrays.values()}) > 1:
        lengths = ", ".join(f"{name} {len(array)}" for name, array in arrays.items())
        raise InputError(f"lengths differ ({lengths}): cut the columns to the same samples")
    masked = np.any([np.ma.getmaskarray(np.ma.asarray(value)) for value in columns.values()], axis=0)
    arrays = {name: array[~masked] for name, array in arrays.items()}
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(f"{name} holds {first_not_finite(array)}: remove that sample from t, u and y")
    back = np.diff(arrays["t"]) <= 0
    if back.any():
        i = int(np.argmax(back)) + 1
        raise InputError(
            f"t[{i}] = {arrays['t'][i]} s does not lie after t[{i - 1}] = {arrays['t'][i - 1]} s: sort the recording "
            "by time and remove doubled samples"
        )
    return arrays.values()


def jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    heights = np.diff(u, prepend=u[0] if u_before is None else float(u_before))
    return t[heights != 0], heights[heights != 0]


def check_time(t):
    """A doubt about times that look like milliseconds."""
    period = float(np.median(np.diff(t)))
    if period >= 1 and np.abs(t - np.rint(t)).max() < 1e-6:
        yield (
            f"t is in whole numbers, one sample every {period:.4g}: is it in milliseconds? Then T and L are too: give "
            "t/1000"
        )


def without_outliers(t, y):
    """t and y without single samples far from both neighbours, and a sentence about them, in a list."""
    places = outliers(y)
    if not len(places):
        return t, y, []
    first = places[0]
    said = (
        f"y has {len(places)} outlier(s), the first at t = {t[first]:.6g} s ({y[first]:.4g} between {y[first - 1]:.4g} "
        f"and {y[first + 1]:.4g}): left out; look for their cause"
    )
    keep = np.ones(len(t), dtype=bool)
    keep[places] = False
    return t[keep], y[keep], [said]


def is_number(value):
    """Whether `value` is one finite number."""
    try:
        return np.ndim(value) == 0 and not isinstance(value, (str, bytes)) and math.isfinite(value)
    except (TypeError, ValueError, OverflowError):
        return False
