"""The columns t, q, u of a recording, checked, whatever program wrote it."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, numbers


def columns_of(recording, q=None, u=None):
    """Return t (n,), q (n, k) and u (n, k) as float arrays; t has passed through `without_rounding`.

    recording: anything with t, q and u (a Recording, a pandas table), in which case q and u must be left out; or the
    times themselves, with q and u as arrays, lists or pandas Series. Masked samples are left out. Raises InputError on
    shapes that do not fit, NaN, or times that do not increase, naming the first.
    """
    if (q is None) != (u is None) or (q is not None and hasattr(recording, "q")):
        raise InputError("give a recording, or t, q and u as arrays: neither both nor a part")
    if q is None and hasattr(recording, "q"):
        recording, q, u = recording.t, recording.q, recording.u
    t, q, u = same_samples({"t": recording, "q": q, "u": u})
    q, u = (np.ascontiguousarray(x.reshape(len(t), -1)) for x in (q, u))
    if q.shape != u.shape:
        raise InputError(f"q {q.shape} and u {u.shape}: give one u per joint")
    return without_rounding(t), q, u


def same_samples(given, most=2):
    """Return the columns `given` (name: values) as float arrays, the first (n,) and increasing, others (n,) or (n, k).

    Masked samples are left out. Dates and time differences become seconds. most: how many dimensions an array may have.
    Raises InputError.
    """
    if (times := np.asarray(given["t"])).dtype.kind in "mM":
        given = {**given, "t": (times - times[:1]) / np.timedelta64(1, "s")}
    arrays = {name: np.atleast_1d(numbers(name, np.ma.getdata(value))) for name, value in given.items()}
    n = len(arrays["t"])
    keep = np.ones(n, dtype=bool)
    for name, array in arrays.items():
        if array.ndim > (1 if name == "t" else most) or len(array) != n or n < 2:
            raise InputError(f"{name} has shape {array.shape} beside {n} times: give (n,){' or (n, k)' * (most > 1)}")
        keep &= ~np.ma.getmaskarray(np.ma.asarray(given[name])).reshape(n, -1).any(axis=1)
    if keep.sum() < 2:
        raise InputError(f"{keep.sum()} of {n} samples are not masked: give at least two")
    arrays = {name: array[keep] for name, array in arrays.items()}
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(f"{name} holds {first_not_finite(array)}: remove such samples from every column")
    back = np.flatnonzero(np.diff(arrays["t"]) <= 0) + 1
    if len(back):
        where = f"t[{back[0]}] = {arrays['t'][back[0]]:.9g} s, {len(back)} such step(s)"
        raise InputError(f"time runs backwards or stands still ({where}): sort the samples, and remove doubled ones")
    return arrays.values()


def sampling_period(t):
    """Return the sampling period of times (n,) with gaps and jitter, s.

    It is the mean of the steps, each counted as 1, 2 or 3 periods; gaps do not count.
    """
    dt = np.diff(t)
    steps = np.rint(dt / np.median(dt))
    near = steps <= 3
    return float(dt[near].sum() / max(steps[near].sum(), 1.0))


def without_rounding(t):
    """Return times (n,) s of an even clock that were rounded to a coarse tick (1 ms, say), put back onto even steps.

    This is done only if every time lies within 3/4 of a tick of the even steps (a gap is a whole number of them): then
    they do not contradict what was recorded. Otherwise the times are returned as they are.
    """
    dt = np.diff(t)
    period = sampling_period(t)
    steps = np.diff(np.unique(dt[dt < 3 * period]))
    steps = steps[steps > 1e-6 * period + 4 * np.spacing(np.abs(t).max())]
    if not len(steps):
        return t
    k = np.concatenate([[0.0], np.cumsum(np.rint(dt / period))])
    slope, first = np.polyfit(k, t - t[0], 1)
    grid = t[0] + first + slope * k
    return grid if np.abs(grid - t).max() <= 0.75 * steps.min() else t


def quantum_of(x):
    """Return the step of a coarse sensor or converter: the least difference between values of x (n,), else 0.

    There is a step if values repeat, or if all differences are whole steps.
    """
    values = np.unique(x)
    steps = np.diff(values)
    steps = steps[steps > 1e-9 * np.ptp(x)]  # smaller ones are rounding of equal values
    if not len(steps):
        return 0.0
    step = float(steps.min())
    return step if len(values) < len(x) / 2 or np.abs(steps / step - np.rint(steps / step)).max() < 0.05 else 0.0


def runs(t, max_gap):
    """Return [(first, last + 1), ...]: the stretches of t (n,) in which no step is longer than max_gap s."""
    edges = np.flatnonzero(np.diff(t) > max_gap) + 1
    return list(zip(np.r_[0, edges].tolist(), np.r_[edges, len(t)].tolist(), strict=True))
