"""A recorded step response, checked: columns, the steps of u, units of time, outliers."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.columns import same_samples
from ir50p_lab.identification.doubts import check_outliers


def recorded(**columns):
    """Columns of a recording as float arrays: one dimension, one length, finite; `t` increasing. Raises InputError."""
    arrays = same_samples(columns)
    for name, array in arrays.items():
        if array.ndim != 1:
            raise InputError(f"{name} has shape {array.shape}; give one value per sample, shape (n,)")
    return arrays.values()


def jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    heights = np.diff(u, prepend=u[0] if u_before is None else float(u_before))
    return t[heights != 0], heights[heights != 0]


def check_time(t):
    """A doubt about times that look like milliseconds."""
    steps = np.diff(t)
    period = float(np.median(steps))
    counted = np.abs(t - np.rint(t)).max() < 1e-6
    jitter = np.ptp(steps) / period  # of a computer's clock
    if (period >= 1 and counted) or (period >= 5 and 1e-6 < jitter < 1):
        yield f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000"


def without_outliers(doubts, t, y):
    """t and y without single samples far from both neighbours, and a doubt about them."""
    places = check_outliers(doubts, "y", t, y, "left out; look for their cause")
    return np.delete(t, places), np.delete(y, places)
