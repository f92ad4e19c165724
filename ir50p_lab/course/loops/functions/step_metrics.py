"""The function of 09: the figures of a step, taken from what was measured."""

from functools import lru_cache

import numpy as np

from ir50p_lab.course.checking.task import Task, mistakes, text_of

_NAMES = ("rise time", "overshoot", "settling time", "rest error")
_TOLERANCE = (1e-3, 1e-5, 0.0105, 3e-4)  # s, rad; with or without the sample on the edge of the last second


def step_metrics(t, q, target):
    """Rise time (s), overshoot (rad), settling time (s) and rest error (rad) of one joint's step: four numbers.

    Rise from 10 to 90 % of the way from q[0] to the target, nan if it never gets there; overshoot beyond the target,
    0 if there is none; settling: from when on the joint stays within max(2 % of the way, 4 sigma) of the target, nan if
    it is outside at the end; rest error: target less the mean of the last second. sigma is the noise, taken from what
    neighbouring samples of the last second differ by, std(diff)/sqrt(2): a slow swing does not widen its own band. With
    3 sigma one sample in 370 is outside and is taken for the end of the step.
    """
    way = target - q[0]
    last_second = q[t >= t[-1] - 1 - 1e-9]
    done = (q - q[0]) / way
    rise = np.nan
    if np.any(done >= 0.9):
        rise = t[np.argmax(done >= 0.9)] - t[np.argmax(done >= 0.1)]
    overshoot = max(0, np.max(np.sign(way) * (q - target)))
    noise = np.std(np.diff(last_second)) / np.sqrt(2)
    band = max(0.02 * abs(way), 4 * noise)
    outside = np.abs(q - target) > band
    if outside[-1]:
        settling = np.nan
    elif np.any(outside):
        settling = t[np.flatnonzero(outside)[-1] + 1] - t[0]
    else:
        settling = 0
    return rise, overshoot, settling, target - np.mean(last_second)


def _second_order(t, start, target, *, speed, damping, noise=0.0, rng=None, short=0.0):
    """A step of a mass, spring and damper, with noise; `short`: the part of the way that stays undone."""
    s = t - t[0]
    end = start + (1 - short) * (target - start)
    root = speed * np.sqrt(1 - damping**2)
    wave = np.exp(-damping * speed * s) * (np.cos(root * s) + damping * speed / root * np.sin(root * s))
    q = end + (start - end) * wave
    q[0] = start
    if noise:
        q[1:] += rng.normal(0, noise, len(t) - 1)
    return q


def _cases():
    rng = np.random.default_rng(91)
    t = np.arange(0, 6.005, 0.01)
    cases = []
    for start, target, speed, damping, noise, short in (
        (0.0, 1.0, 4.0, 0.4, 0.0, 0.0),  # swings
        (0.2, 0.8, 5.0, 0.9, 0.0, 0.0),  # hardly beyond
        (0.9, -0.3, 4.0, 0.3, 0.0, 0.0),  # downwards
        (0.4, 0.0, 5.0, 0.5, 0.0, 0.0),  # to zero
        (-0.5, -1.3, 3.0, 0.6, 0.004, 0.0),  # noise
        (0.0, 0.3, 6.0, 0.35, 0.011, 0.0),  # noise wider than 2 %
        (0.1, 1.1, 4.0, 0.8, 0.0, 0.3),  # rests short of 90 %
        (0.0, 0.8, 5.0, 0.7, 0.002, 0.06),  # rises, and rests outside its band
        (0.0, 0.8, 6.0, 0.005, 0.0, 0.0),  # swings for ever
        (0.0, 0.02, 6.0, 0.7, 0.012, 0.0),  # never outside its band: all of it is noise
    ):
        q = _second_order(t, start, target, speed=speed, damping=damping, noise=noise, rng=rng, short=short)
        cases.append((t.copy(), q, target))
    cases.append((t + 3.0, cases[0][1].copy(), 1.0))  # a clock that does not begin at 0
    uneven = np.cumsum(rng.uniform(0.02, 0.06, 150))  # a slow computer that comes late now and then
    cases.append((uneven, _second_order(uneven, 0.0, 0.7, speed=2.0, damping=0.4), 0.7))
    return cases


def _four(returned):
    values = np.asarray(returned, dtype=float)
    return values if values.shape == (4,) else None


@lru_cache(maxsize=1)
def _otherwise():
    """{figures of a case: its rise time with crossings between two samples}: that is right as well."""
    return {repr(step_metrics(*case)): [_between_samples(*case)] for case in _cases()}


def _between_samples(t, q, target):
    """Rise time with both crossings interpolated."""
    done = (q - q[0]) / (target - q[0])
    times = []
    for mark in (0.1, 0.9):
        k = int(np.argmax(done >= mark))
        if done[k] < mark:
            return np.nan
        times.append(t[k - 1] + (mark - done[k - 1]) / (done[k] - done[k - 1]) * (t[k] - t[k - 1]))
    return times[1] - times[0]


def _same(returned, expected):
    """The same four numbers, as a tuple or an array; times to a thousandth of a second."""
    values, right = _four(returned), _four(expected)
    if values is None or right is None:
        return False
    readings = _readings(expected)
    return all(
        np.isclose(value, reading, atol=tolerance, rtol=0, equal_nan=True).any()
        for value, reading, tolerance in zip(values, readings, _TOLERANCE, strict=True)
    )


def _readings(expected):
    """What is right for each of the four numbers, the definition's own first."""
    return [expected[0], *_otherwise().get(repr(expected), ())], *([one] for one in expected[1:])


def _symptom(cases, returned, expected):
    found = [_four(one) for one in returned]
    if any(one is None for one in found):
        shape = np.shape(next(back for back, one in zip(returned, found, strict=True) if one is None))
        return f"four numbers are asked for, {', '.join(_NAMES)}, in this order; yours has the shape {shape}"
    found = np.array(found)
    right = np.array(expected)
    for case, four in enumerate(expected):
        for k, readings in enumerate(_readings(four)):
            taken = np.isclose(readings, found[case, k], atol=_TOLERANCE[k], rtol=0, equal_nan=True)
            right[case, k] = readings[int(np.argmax(taken))]  # the student's if it is one of them
    for k, name in enumerate(_NAMES):
        off = ~np.isclose(found[:, k], right[:, k], atol=_TOLERANCE[k], rtol=0, equal_nan=True)
        if not off.any():
            continue
        case = int(np.argmax(off))
        _, q, target = cases[case]
        mine, theirs = found[case, k], right[case, k]
        samples = (mine - theirs) / np.median(np.diff(cases[case][0]))
        if k in (0, 2) and 0.5 < abs(samples) < 2.5:
            off = f"{'1 sample' if abs(samples) < 1.5 else '2 samples'} too {'long' if samples > 0 else 'short'}"
            return f"the {name} is {off}: with which sample does it begin, and with which does it end?"
        step = f"a step from {q[0]:.2f} to {target:.2f} rad"
        usual = mine / theirs if theirs else 1.0
        if (
            usual
            and abs(np.log10(abs(usual))) > 1.3
            and np.mean(np.isclose(found[:, k], usual * right[:, k], rtol=1e-3)) > 0.5
        ):
            return f"the {name} is {usual:.3g} times what it should be: in which unit is it?"
        if k == 0 and np.isnan(theirs):
            return f"the {name} of {step} that never reaches 90 % of the way is {mine:.3g}: it has none, so nan"
        if np.isnan(theirs):
            return f"the {name} of {step} that never gets there is {mine:.3g}: what never happens has no time, nan"
        return f"the {name} is wrong, first at {step}: yours is {mine:.3g}, by the definition it is {theirs:.3g}"
    return ""


TASK = Task(
    name="step_metrics",
    asks="rise time, overshoot, settling time and rest error of a step of one joint: four numbers (s, rad, s, rad)",
    right=step_metrics,
    cases=_cases,
    same=_same,
    parts=_NAMES,
    unit="(s, rad, s, rad)",
    loan=text_of(step_metrics),
    slips=mistakes(step_metrics),
    symptom=_symptom,
    hints=(
        "Begin with done = how much of the way is behind the joint, 0 at the start and 1 at the target: rise time and "
        "direction are easy in it, upwards and downwards alike.",
        "np.argmax(condition) is the first place where it is true; np.flatnonzero(condition)[-1] the last. A joint has "
        "settled one sample after it was outside for the last time.",
    ),
)  # fmt: skip
