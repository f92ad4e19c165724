"""Columns t, q, u of a recording, checked: what identification takes from a file, whoever wrote it."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite, numbers


def columns_of(recording, q=None, u=None, qd=None, *, drop=False):
    """Return t (n,), q (n, k) and u (n, k) as float arrays; t `without_rounding`. With qd (n, k) four arrays.

    recording: anything with t, q and u (a Recording, a pandas table), then q and u must be left out; or the times
    themselves, with q and u as arrays, lists or pandas Series. Masked samples are left out, and with `drop` those that
    are no numbers. Raises InputError on shapes that do not fit, NaN, or times that do not increase, naming the first.
    """
    if (q is None) != (u is None) or (q is not None and hasattr(recording, "q")):
        raise InputError("give a recording, or t, q and u as arrays: neither both nor a part")
    if q is None and hasattr(recording, "q"):
        recording, q, u = recording.t, recording.q, recording.u
    given = {"t": recording, "q": q, "u": u} | ({} if qd is None else {"qd": qd})
    t, *rest = same_samples(given, drop)
    rest = [np.ascontiguousarray(x.reshape(len(t), -1)) for x in rest]
    for name, array in zip(list(given)[2:], rest[1:], strict=True):
        if array.shape != rest[0].shape:
            raise InputError(f"q {rest[0].shape} and {name} {array.shape}: give one {name} per joint")
    return without_rounding(t), *rest


def same_samples(given, drop=False, most=2):
    """Float arrays of the columns `given` (name: values), the first (n,) and increasing, the others (n,) or (n, k).

    Masked samples are left out, and with `drop` those that are no numbers. most: dimensions. Raises InputError.
    """
    arrays = {name: _numbers(name, value) for name, value in given.items()}
    n = len(arrays["t"])
    if arrays["t"].ndim != 1 or n < 2:
        raise InputError(f"t has shape {arrays['t'].shape}; give at least two times in s, shape (n,)")
    keep = np.ones(n, dtype=bool)
    for name, array in arrays.items():
        if array.ndim > most or len(array) != n:
            raise InputError(f"{name} has shape {array.shape} beside {n} times: give (n,){' or (n, k)' * (most > 1)}")
        keep &= ~np.ma.getmaskarray(np.ma.asarray(given[name])).reshape(n, -1).any(axis=1)
        if drop:
            keep &= np.isfinite(array.reshape(n, -1)).all(axis=1)
    arrays = {name: array[keep] for name, array in arrays.items()}
    if keep.sum() < 2:
        raise InputError(f"{keep.sum()} of {n} samples are neither masked nor without a number: give at least two")
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(f"{name} holds {first_not_finite(array)}: remove such samples from every column")
    t = arrays["t"]
    back = np.flatnonzero(np.diff(t) <= 0) + 1
    if len(back):
        where = f"t[{back[0]}] = {t[back[0]]:.9g} s, {len(back)} such step(s)"
        remedy = "sort the samples, and remove doubled ones; several recordings: give a list of them"
        raise InputError(f"time runs backwards or stands still ({where}): {remedy}")
    return arrays.values()


def sampling_period(t):
    """Sampling period of times (n,) with gaps and jitter, s: near the median step, the one that counts whole steps."""
    dt = np.diff(t)
    steps = np.rint(dt / np.median(dt))
    near = steps <= 3
    return float(dt[near].sum() / max(steps[near].sum(), 1.0))


def without_rounding(t):
    """Times (n,) s of an even clock that were rounded to a coarse tick (1 ms, say), put back onto even steps.

    Only where every time lies within 3/4 of its tick of the grid (gaps are whole steps): the grid then says nothing
    that the times deny. Else they are returned as they are.
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
    """Step of a coarse sensor or converter: the least difference between values of x (n,), rad; 0 if there is none.

    There is one if values repeat, or if all differences are whole steps.
    """
    values = np.unique(x)
    steps = np.diff(values)
    steps = steps[steps > 1e-9 * np.ptp(x)]  # rounding of what was meant to be the same
    if not len(steps):
        return 0.0
    step = float(steps.min())
    return step if len(values) < len(x) / 2 or np.abs(steps / step - np.rint(steps / step)).max() < 0.05 else 0.0


def runs(t, max_gap):
    """[(first, last + 1), ...]: the stretches of t (n,) whose steps are at most max_gap s."""
    edges = np.flatnonzero(np.diff(t) > max_gap) + 1
    return list(zip(np.r_[0, edges].tolist(), np.r_[edges, len(t)].tolist(), strict=True))


def _numbers(name, value):
    array = np.ma.getdata(value) if np.ma.isMaskedArray(value) else value
    kind = getattr(value, "dtype", np.dtype(float)).kind
    if kind in "mM":  # dates, of pandas with a time zone too
        array = np.asarray(array, dtype=f"{kind}8[ns]")
        array = (array - array[0]) / np.timedelta64(1, "s")
    array = numbers(name, array)
    if array.ndim == 0:
        raise InputError(f"{name} = {value!r:.60} is no array: give t, q and u as arrays, time first, or a recording")
    return array
