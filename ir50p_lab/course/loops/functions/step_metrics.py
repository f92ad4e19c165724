"""step_metrics: the figures of a step, taken from what was measured."""

import numpy as np

from ir50p_lab.course.checking.task import task_of

_NAMES = ("rise time", "overshoot", "settling time", "rest error")


def step_metrics(t, q, target):
    """Return rise time (s), overshoot (rad), settling time (s) and rest error (rad) of one joint's step: four numbers.

    Rise time: from 10 to 90 % of the step from q[0] to the target, nan if it never gets there. Overshoot: beyond the
    target, 0 if there is none. Settling time: when the joint comes to stay within max(2 % of the step, 4 sigma) of the
    target, nan if it is outside at the end. Rest error: target minus the mean of the last second. sigma is the noise,
    from the differences of neighbouring samples in the last second, std(diff)/sqrt(2): so a slow swing does not widen
    its own band. With 3 sigma one sample in 370 would be outside and be taken for the end of the step.
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


def _second_order(t, start, target, speed, damping, noise, short):
    """A step of a mass, spring and damper that trembles by `noise`; `short`: the part of the way left undone."""
    s = t - t[0]
    end = start + (1 - short) * (target - start)
    root = speed * np.sqrt(1 - damping**2)
    wave = np.exp(-damping * speed * s) * (np.cos(root * s) + damping * speed / root * np.sin(root * s))
    trembling = np.random.default_rng(91).normal(0, 1, len(t)) * noise
    trembling[0] = 0
    return end + (start - end) * wave + trembling


def _cases():
    t = np.arange(0, 6.005, 0.01)
    late = np.cumsum(np.random.default_rng(92).uniform(0.02, 0.06, 150))  # a slow computer that comes late now and then
    steps = (
        (t, 0.0, 1.0, 4.0, 0.4, 0.0, 0.0),  # swings
        (t, 0.2, 0.8, 5.0, 0.9, 0.0, 0.0),  # hardly beyond
        (t, 0.9, -0.3, 4.0, 0.3, 0.0, 0.0),  # downwards
        (t, 0.4, 0.0, 5.0, 0.5, 0.0, 0.0),  # to zero
        (t, -0.5, -1.3, 3.0, 0.6, 0.004, 0.0),  # noise
        (t, 0.0, 0.3, 6.0, 0.35, 0.011, 0.0),  # noise wider than 2 %
        (t, 0.1, 1.1, 4.0, 0.8, 0.0, 0.3),  # rests short of 90 %
        (t, 0.0, 0.8, 5.0, 0.7, 0.002, 0.06),  # rises, and rests outside its band
        (t, 0.0, 0.8, 6.0, 0.005, 0.0, 0.0),  # swings for ever
        (t, 0.0, 0.02, 6.0, 0.7, 0.012, 0.0),  # never outside its band: all of it is noise
        (t + 3.0, 0.0, 1.0, 4.0, 0.4, 0.0, 0.0),  # a clock that does not begin at 0
        (late, 0.0, 0.7, 2.0, 0.4, 0.0, 0.0),
    )
    return [(t.copy(), _second_order(t, start, target, *how), target) for t, start, target, *how in steps]


def _between_samples(t, q, target):
    """The same with the rise from crossing to crossing, interpolated between two samples."""
    done = (q - q[0]) / (target - q[0])
    rise, *others = step_metrics(t, q, target)
    first, last = (int(np.argmax(done >= mark)) for mark in (0.1, 0.9))
    if np.isfinite(rise):
        rise = np.interp(0.9, done[last - 1 : last + 1], t[last - 1 : last + 1])
        rise -= np.interp(0.1, done[first - 1 : first + 1], t[first - 1 : first + 1])
    return rise, *others


def _symptom(case, returned, expected):
    for name, mine, right in zip(_NAMES, returned, expected, strict=True):
        samples = np.subtract(mine, right) / np.median(np.diff(case[0]))
        if name.endswith("time") and np.isnan(right) and not np.isnan(mine):
            return f"the {name} of a step that never gets there is {mine:.3g}: what never happens has no time, nan"
        if name.endswith("time") and 0.5 < abs(samples) < 1.5:
            off = "long" if samples > 0 else "short"
            return f"the {name} is 1 sample too {off}: with which sample does it begin, with which does it end?"
    return ""


TASK = task_of(
    step_metrics,
    cases=_cases,
    results=_NAMES,
    tolerance=(1e-3, 1e-5, 0.0105, 3e-4),  # s, rad; with or without the sample on the edge of the last second
    also_right=(_between_samples,),
    unit="(s, rad, s, rad)",
    symptom=_symptom,
)
