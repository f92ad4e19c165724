"""Columns t, q, u of a recording, checked: what identification takes from a file, whoever wrote it."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import first_not_finite

_BETWEEN = 100  # periods put between two recordings that are fitted together


def columns_of(recording, q=None, u=None, qd=None, *, drop=False):
    """Return t (n,), q (n, k) and u (n, k) as float arrays; t `without_rounding`. With qd (n, k) four arrays.

    recording: anything with t, q and u (a Recording, a pandas table), then q and u must be left out; or the times
    themselves, with q and u as arrays, lists or pandas Series. Masked samples are left out, and with `drop` those that
    are no numbers. Raises InputError on shapes that do not fit, NaN, or times that do not increase, naming the first.
    """
    if hasattr(recording, "q") and hasattr(recording, "t"):
        if q is not None or u is not None:
            raise InputError("give a recording, or t, q and u as arrays: not both")
        t, q, u = recording.t, recording.q, recording.u
    else:
        t = recording
        if q is None or u is None:
            raise InputError("q and u are missing: give a recording, or t, q and u as arrays")
    given = {"t": t, "q": q, "u": u} | ({} if qd is None else {"qd": qd})
    arrays = same_samples(given, drop)
    t = arrays.pop("t")
    for name, array in arrays.items():
        if array.shape != arrays["q"].shape:
            raise InputError(f"q {arrays['q'].shape} and {name} {array.shape}: give one {name} per joint")
    return without_rounding(t), *(np.ascontiguousarray(x.reshape(len(t), -1)) for x in arrays.values())


def same_samples(given, drop=False):
    """Float arrays of the columns `given` (name: values), "t" (n,) and increasing, the others (n,) or (n, k).

    Masked samples are left out, and with `drop` those that are no numbers. Raises InputError.
    """
    arrays = {name: _numbers(name, value) for name, value in given.items()}
    n = len(arrays["t"])
    if arrays["t"].ndim != 1 or n < 2:
        raise InputError(f"t has shape {arrays['t'].shape}; give at least two times in s, shape (n,)")
    left_out = np.zeros(n, dtype=bool)
    for name, array in arrays.items():
        if array.ndim not in (1, 2) or len(array) != n:
            raise InputError(f"{name} has shape {array.shape} beside {n} times: give (n,) or (n, k), time first")
        left_out |= np.ma.getmaskarray(np.ma.asarray(given[name])).reshape(n, -1).any(axis=1)
        if drop:
            left_out |= ~np.isfinite(array.reshape(n, -1)).all(axis=1)
    arrays = {name: array[~left_out] for name, array in arrays.items()}
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(
                f"{name} holds {first_not_finite(array)} ({int((~np.isfinite(array)).sum())} such value(s)): remove "
                "these samples from every column; a gap in time is understood"
            )
    t = arrays["t"]
    back = np.flatnonzero(np.diff(t) <= 0)
    if len(back):
        i = int(back[0]) + 1
        raise InputError(
            f"time runs backwards or stands still: t[{i}] = {t[i]:.9g} s after t[{i - 1}] = {t[i - 1]:.9g} s "
            f"({len(back)} such step(s)): sort the samples by time and remove doubled ones; several recordings: give "
            "a list of them"
        )
    return arrays


def joined(recordings):
    """Several recordings one after the other, with gaps between them: t (n,), q, u (n, k).

    Each a recording or a tuple (t, q, u). Raises InputError as `columns_of` does.
    """
    parts, end = [], 0.0
    for recording in recordings:
        t, q, u = columns_of(*recording) if isinstance(recording, (tuple, list)) else columns_of(recording)
        parts.append((t - t[0] + end, q, u))
        end = parts[-1][0][-1] + _BETWEEN * sampling_period(t)
    if len({part[1].shape[1] for part in parts}) != 1:
        raise InputError(
            "the recordings have different numbers of joints, or there is none: give the same joints of each"
        )
    return tuple(np.concatenate(x) for x in zip(*parts, strict=True))


def sampling_period(t):
    """Sampling period of times (n,) with gaps and jitter, s: near the median step, the one that counts whole steps."""
    dt = np.diff(t)
    median = float(np.median(dt))
    steps = np.rint(dt / median)
    near = steps <= 3
    return float(dt[near].sum() / max(steps[near].sum(), 1.0))


def without_rounding(t):
    """Times (n,) s of an even clock that were rounded to a coarse tick (1 ms, say), put back onto even steps.

    Only where every time lies within 3/4 of its tick of the grid (gaps are whole steps): the grid then says nothing
    that the times deny. Else they are returned as they are.
    """
    dt = np.diff(t)
    period = sampling_period(t)
    near = dt[dt < 3 * period]
    steps = np.diff(np.unique(near))
    steps = steps[steps > 1e-6 * period + 4 * np.spacing(np.abs(t).max())]
    if not len(steps):
        return t
    tick = float(steps.min())
    if np.abs(near / tick - np.rint(near / tick)).max() > 0.01:
        return t
    k = np.concatenate([[0.0], np.cumsum(np.rint(dt / period))])
    slope, first = np.polyfit(k, t - t[0], 1)
    grid = t[0] + first + slope * k
    return grid if np.abs(grid - t).max() <= 0.75 * tick else t


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
    repeats = len(values) < len(x) / 2
    return step if repeats or np.abs(steps / step - np.rint(steps / step)).max() < 0.05 else 0.0


def runs(t, max_gap):
    """[(first, last + 1), ...]: the stretches of t (n,) whose steps are at most max_gap s."""
    edges = np.flatnonzero(np.diff(t) > max_gap) + 1
    return list(zip(np.r_[0, edges].tolist(), np.r_[edges, len(t)].tolist(), strict=True))


def _numbers(name, value):
    value = np.ma.getdata(value) if np.ma.isMaskedArray(value) else value
    try:
        array = np.asarray(value)
        array = (array - array[0]) / np.timedelta64(1, "s") if array.dtype.kind in "mM" else array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must hold numbers; got {value!r:.60}") from None
    if array.ndim == 0:
        raise InputError(f"{name} = {value!r:.60} is a single number: give an array, time first")
    return array
