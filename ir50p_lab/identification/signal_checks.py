"""What is wrong with the signals of one joint, before any model: each refusal says where, why and what to do next."""

import math

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.columns import quantum_of, runs

FEWEST = 40  # samples, ten for each parameter
_STAYS = 5  # samples at the largest value that look like more than chance
_BROKEN = 3.5  # samples: noise breaks a stay into pieces this near to each other
_JUMP = 5.0  # times the largest usual step, by which a frozen angle jumps when it is alive again
_FROZEN = 5  # samples, at least, for which it stood still
_SPIKE = 0.05  # of the range, and 20 times the usual bend: one sample this far from both neighbours is an outlier


def refuse_short_or_constant(t, q, u):
    """Refuse fewer than 40 samples, and a q or u that never changes."""
    if len(t) < FEWEST:
        raise IdentificationError(
            f"{len(t)} samples are too short a record for four parameters; record {FEWEST} or more, over several "
            "reversals of the motion"
        )
    for name, x, remedy in (
        ("q", q, "check the sensor and the power, or drive harder than the breakaway friction"),
        ("u", u, "nothing can be said about what u does; record a motion in which it changes, to both sides"),
    ):
        if np.ptp(x) <= 1e-12 * np.abs(x).max():
            raise IdentificationError(f"{name} is constant at {x[0]:.6g} in the whole record: {remedy}")


def refuse_whole_turns(t, q):
    """Refuse angles that jump by a whole turn between neighbours (2 pi rad, or 360 degrees)."""
    step = np.diff(q)
    usual = 1.4826 * np.median(np.abs(step)) + 1e-12
    for turn, unit, remedy in ((2 * math.pi, "2 pi rad", "np.unwrap(q)"), (360.0, "360", "np.unwrap(np.radians(q))")):
        jumps = np.flatnonzero((np.abs(np.abs(step) - turn) < 0.1 * turn) & (np.abs(step) > 10 * usual))
        if len(jumps):
            raise IdentificationError(
                f"q jumps by {unit} at t = {t[jumps[0] + 1]:.6g} s ({len(jumps)} time(s)): a whole turn was wrapped; "
                f"use {remedy}"
            )


def refuse_clipped_angle(t, q):
    """Refuse a q that runs into its largest or smallest value and stays there: clipped sensor, or an end stop.

    A joint that comes to rest there slows down first: over the last m samples it is no faster than it lost over the m
    before. One that is cut off loses its speed at once.
    """
    values = len(np.unique(q))
    if values < 3:
        raise IdentificationError(f"q takes only {values} values: no motion can be seen; use a finer sensor")
    quantum = quantum_of(q)
    noise = float(np.median(np.abs(np.diff(q, 2)))) / 0.6745 / math.sqrt(6)
    for sign, name in ((1, "largest"), (-1, "smallest")):
        x = sign * q
        places = np.flatnonzero(x >= x.max() - 1e-9 * np.ptp(x))
        lost, height = 0, 0.0
        for first, last in runs(places.astype(float), _BROKEN) if len(places) >= _STAYS else ():
            begin, end = places[first], places[last - 1] + 1
            m = max(3, (end - begin) // 8)
            if last - first < _STAYS or begin < 2 * m or end + 2 * m > len(q):
                continue
            before, after = slice(begin - m, begin), slice(end, end + m)
            near = _slope(t[before], x[before]) - _slope(t[after], x[after])
            before, after = slice(begin - 2 * m, begin - m), slice(end + m, end + 2 * m)
            far = _slope(t[before], x[before]) - _slope(t[after], x[after])
            hidden = near / 2 * (t[end - 1] - t[begin]) / 4
            unsure = (2 * quantum + 8 * noise / math.sqrt(m)) / min(
                t[begin] - t[begin - m], t[end - 1 + m] - t[end - 1]
            )
            if near > 3 * max(far - near, 0.0) + unsure and hidden > 2 * quantum:
                lost, height = lost + last - first, max(height, hidden)
        if lost:
            raise IdentificationError(
                f"q was clipped: it stays at its {name} value, {sign * x.max():.6g} rad, for {lost} samples and runs "
                f"into it without slowing down (about {height:.2g} rad are missing). The sensor ends there, the "
                "joint hits a stop, or play holds it: record again within the range, or cut these stretches out"
            )


def _slope(t, x):
    """Slope of a straight line through x (m,) at the times t."""
    t = t - t.mean()
    return float(t @ x / (t @ t))


def refuse_repeated_angles(t, q):
    """Refuse a q that is renewed more slowly than the rows are written, though its sensor is finer than its steps."""
    steps = np.abs(np.diff(q))
    new = np.flatnonzero(steps > 0)
    every = (len(q) - 1) / max(len(new), 1)
    if every < 1.9 or np.median(steps[new]) < 4 * quantum_of(q):
        return  # or the steps are those of a coarse sensor
    if np.mean(np.abs(np.diff(new) - every) < 0.6) < 0.7:
        return  # or it stood still now and then
    raise IdentificationError(
        f"q is new only in every {every:.3g}th row ({len(new)} of {len(q)}): its sensor is slower than the file. Keep "
        "the rows in which it changes: keep = np.r_[True, np.diff(q) != 0]; t[keep], q[keep], u[keep]"
    )


def refuse_frozen_angle(t, q):
    """Refuse a q that stands still for some samples and then jumps, as it does where a sensor or a link hangs."""
    steps = np.abs(np.diff(q))
    usual = float(np.quantile(steps, 0.99))
    moved = np.flatnonzero(steps > 0)
    stood = np.diff(moved, prepend=-1) - 1  # samples without change before each move
    frozen = np.flatnonzero((stood >= _FROZEN) & (steps[moved] > _JUMP * usual) & (usual > 0))
    if len(frozen):
        k = moved[frozen[0]]
        raise IdentificationError(
            f"q stands at {q[k]:.6g} rad for {stood[frozen[0]] + 1} samples and jumps by {q[k + 1] - q[k]:.3g} rad at "
            f"t = {t[k + 1]:.6g} s ({len(frozen)} time(s)): the sensor or link hung. Leave these samples out; a gap "
            "in time is understood"
        )


def outliers(name, t, x):
    """A sentence about samples that are far from both neighbours, which agree: lost counts, bad bytes; or nothing."""
    low, high = np.quantile(x, (0.02, 0.98))
    off = np.abs(x[1:-1] - (x[:-2] + x[2:]) / 2)
    alone = (off > max(_SPIKE * (high - low), 20 * np.median(off))) & (np.abs(x[2:] - x[:-2]) < 0.4 * off)
    places = np.flatnonzero(alone) + 1
    if len(places):
        yield (
            f"{name} has {len(places)} outlier(s), the first at t = {t[places[0]]:.6g} s ({x[places[0]]:.4g} between "
            f"{x[places[0] - 1]:.4g} and {x[places[0] + 1]:.4g}): leave these samples out, they pull at every parameter"
        )


def refuse_bad_signals(t, q, u):
    """All refusals above."""
    refuse_short_or_constant(t, q, u)
    refuse_whole_turns(t, q)
    refuse_repeated_angles(t, q)
    refuse_frozen_angle(t, q)
    refuse_clipped_angle(t, q)
