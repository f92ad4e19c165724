"""The function of 09: the figures of a step, taken from what was measured."""

from functools import lru_cache

import numpy as np

from ir50p_lab.course.functions.task import Task, mistakes, text_of

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


def _second_order(t, start, target, *, speed, damping, noise=0.0, rng=None, stop=None, short=0.0):
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
        if k == 0 and _from_zero(cases, off):
            return "the rise time is right where a step begins at 0 rad and wrong elsewhere: the way begins at q[0]"
        if k == 0 and np.isnan(theirs):
            return f"the {name} of {step} that never reaches 90 % of the way is {mine:.3g}: it has none, so nan"
        if np.isnan(theirs):
            return f"the {name} of {step} that never gets there is {mine:.3g}: what never happens has no time, nan"
        if np.isnan(mine):
            return f"the {name} of {step} is nan with you; by the definition it is {theirs:.3g}"
        return f"the {name} is wrong, first at {step}: yours is {mine:.3g}, by the definition it is {theirs:.3g}"
    return ""


def _from_zero(cases, off):
    """Tell whether steps go wrong that do not begin at 0, upwards as well as downwards, and only they."""
    begins = np.array([q[0] for _, q, _ in cases])
    upwards = np.array([target > q[0] for _, q, target in cases])
    return not off[begins == 0].any() and off[(begins != 0) & upwards].any() and off[~upwards].any()


# parts of the solution that mistakes replace
_OVER = "max(0, np.max(np.sign(way) * (q - target)))"
_BAND = "max(0.02 * abs(way), 4 * noise)"
_LAST = "np.flatnonzero(outside)[-1]"
_REST = "target - np.mean(last_second)"

STEP_METRICS = Task(
    name="step_metrics",
    asks="rise time, overshoot, settling time and rest error of a step of one joint: four numbers (s, rad, s, rad)",
    right=step_metrics,
    cases=_cases,
    same=_same,
    parts=_NAMES,
    unit="(s, rad, s, rad)",
    loan=text_of(step_metrics),
    slips=mistakes(
        step_metrics,
        ("the overshoot is in percent of the step; here it is an angle, rad",
         "overshoot, settling -> 100 * overshoot / abs(way), settling"),
        ("the overshoot is a part of the step, without unit; here it is an angle, rad",
         "overshoot, settling -> overshoot / abs(way), settling"),
        ("steps downwards overshoot by the whole step: beyond the target is *below* it there",
         "np.sign(way) * (q - target) -> q - target"),
        ("a joint that stays short of its target overshoots by less than nothing with you; no overshoot is 0",
         f"{_OVER} -> np.max(np.sign(way) * (q - target))"),
        ("a joint that never passes its target has an overshoot, too: the largest distance on either side counts the "
         "start as well", f"{_OVER} -> np.max(np.abs(q - target))"),
        ("overshoot and settling are taken about where the joint ends; asked is about where it should end",
         "(q - target) -> (q - np.mean(last_second))"),
        ("overshoot and settling are taken about the last angle; asked is about where it should end",
         "(q - target) -> (q - q[-1])"),
        ("the band lies about where the joint ends; asked is about the target: a joint beside it has not settled",
         "abs(q - target) -> abs(q - np.mean(last_second))"),
        *(
            ("the band is that of the whole run, the step itself counts as noise: take the last second",
             f"4 * noise -> {k} * {size}")
            for k in (3, 4)
            for size in ("np.std(np.diff(q)) / np.sqrt(2)", "np.std(q)")
        ),
        ("the band is 2 % of the target: a step to 0 would have none. It is 2 % of the way from the start",
         "abs(way) -> abs(target)"),
        ("every step begins at 0 rad: look at the first sample for where this one begins",
         "way = target - q[0] -> way = target - (q := np.r_[0.0, q[1:]])[0]"),
        ("steps downwards never rise with you: the way there is negative, and so is what is done of it",
         "any(done >= 0.9) -> any(done >= 0.9) and way > 0"),
        ("the rise time is negative: which of the two marks does the joint pass first?", "return rise -> return -rise"),
        *(
            (f"the rise time goes {marks}, not from 10 to 90 % of the way",
             f">= 0.9 -> >= {high}", f">= 0.1 -> >= {low}")
            for marks, low, high in (
                ("from the start to 90 %", "-np.inf", 0.9),
                ("from 10 % to the target itself", 0.1, 1.0),
                ("from 10 to 95 %", 0.1, 0.95),
                ("from 5 to 95 %", 0.05, 0.95),
            )
        ),
        ("the overshoot is that of the last sample, not of the farthest one",
         "np.max(np.sign(way) * (q - -> (np.sign(way) * (q[-1] -"),
        ("the rest error is a median; asked is the mean", "np.mean -> np.median"),
        ("the last second begins one sample late: its first sample is included", "- 1e-9 -> + 1e-6"),
        ("where the angle trembles it settles late or never: four standard deviations of the noise widen the band",
         f"{_BAND} -> 0.02 * abs(way)"),
        ("the band is 4 standard deviations only: without noise it has no width, and 2 % of the way is allowed",
         f"{_BAND} -> 4 * noise"),
        ("the band is too wide: 4 standard deviations of the noise are asked for, and the difference of two samples "
         "has the noise of both", " / np.sqrt(2) -> "),
        *(
            ("a slow swing widens the band: noise is what *neighbours* differ by, here the whole scatter is taken",
             f"4 * noise -> {k} * np.std(last_second)")
            for k in (4, 3)
        ),
        *(
            (f"the band is {k} standard deviations of the noise wide, 4 are asked for: a single sample is soon "
             "beyond it", f"4 * noise -> {k} * noise")
            for k in (1, 2, 3)
        ),
        ("the narrower of both bands is taken; asked is the wider", "band = max -> band = min"),
        ("the band is 2 % and the noise together; asked is the wider of the two",
         f"{_BAND} -> 0.02 * abs(way) + 4 * noise"),
        *(
            (f"the band is {percent} % of the way; asked is 2 %", f"0.02 -> {percent / 100}")
            for percent in (1, 4, 5, 10)
        ),
        ("it counts to the last sample inside; asked is the first after which the joint stays inside",
         "(outside)[-1] + 1 -> (~outside)[-1]"),
        ("the overshoot compares sizes without their sign: a step that passes 0 shows it",
         "np.max(np.sign(way) * (q - target)) -> np.max(np.abs(q)) - abs(target)"),
        ("for steps downwards the band has a negative width, so the joint is never inside: how *long* is the way?",
         "abs(way) -> way"),
        ("it is settled when it is inside for the first time; a joint that swings leaves the band again",
         "if outside[-1] -> if np.all(outside)", f"{_LAST} + 1 -> np.argmin(outside)"),
        ("it is settled when it is inside for the first time; a joint that swings leaves the band again",
         f"{_LAST} + 1 -> np.argmin(outside)"),
        ("the rise goes by where the joint ends: the way is from its first angle to the *target*",
         "(q - q[0]) / way -> (q - q[0]) / (q[-1] - q[0])"),
        ("it counts from the first sample outside, not from the last", f"{_LAST} -> np.argmax(outside)"),
        ("a clock that begins at 3 s makes it settle 3 s later: the time counts from where the step begins",
         " - t[0] -> "),
        ("the settling time ends at the last sample outside; inside is the one after it (a slow clock shows it)",
         "[-1] + 1 -> [-1]"),
        ("the rest error has the other sign: what is missing is positive, the target less where it is",
         f"{_REST} -> np.mean(last_second) - target"),
        *(
            ("the rest error has lost its sign: short and too far are not the same", f"{_REST} -> {rest}")
            for rest in (f"abs({_REST})", "np.mean(np.abs(target - last_second))")
        ),
        ("the rest error rests on the very last sample, which trembles: take the mean of the last second",
         f"{_REST} -> target - q[-1]"),
        ("the rest error and the noise are those of the last half second: a whole second is asked for",
         "- 1 - 1e-9 -> - 0.5 - 1e-9"),
        *(
            ("the last second is taken as a number of samples: not every computer is that quick; ask the clock",
             f"t >= t[-1] - 1 - 1e-9 -> -{samples}:")
            for samples in (100, 101, 99)
        ),
    ),
    symptom=_symptom,
    hints=(
        "Begin with done = how much of the way is behind the joint, 0 at the start and 1 at the target: rise time and "
        "direction are easy in it, upwards and downwards alike.",
        "np.argmax(condition) is the first place where it is true; np.flatnonzero(condition)[-1] the last. A joint has "
        "settled one sample after it was outside for the last time.",
    ),
)  # fmt: skip

TASKS = (STEP_METRICS,)
