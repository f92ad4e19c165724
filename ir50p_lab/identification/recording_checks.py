"""Can a recording of a joint be believed? Meaningless data are refused, and smaller flaws become warnings."""

import math
from itertools import pairwise

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.identification.time_series import quantum_of, runs, sampling_period

FEWEST = 40  # samples: a shorter record is refused; ten for each of four parameters
TURNS = 6 * math.pi  # rad: if q spans more, it may be in degrees: joints seldom turn three times, often by 19 degrees
_SLOW_CLOCK = 0.15  # s: if the sampling period is longer, t may be in milliseconds; nobody samples a joint so slowly
# A stay is an angle that keeps one value for so many samples: its sensor may have hung, or come to its limit.
_STAYS = 5
_BROKEN = 3.5  # samples: if two stays are nearer to each other, they are one that noise interrupts
_JUMP = 5.0  # if the step after a stay is more than so many times the largest usual step (98 %), the sensor hung
_ABRUPT = 0.2  # share of the rms speed: if q enters and leaves its stay at the largest value faster, it was clipped
# A sample is an outlier if it is off its neighbours' mean by more than this share of the signal's range (2 to 98 %), by
# 12 times what is usual around it, and by so many quanta: a coarse signal flickers by one or two.
_SPIKE = 0.05
_LEAST = 3
# u was clipped if the motion needs more than it had at its limits, by this share of its range. Measured on three
# machines, limits at 60 to 90 %: 0.036 or more if clipped, at most 0.019 for a drive that saturates, late or not.
_EXCESS = (0.025, 2.5), (0.012, 4.0)  # refused, told: this share, and so many standard errors
# Share of samples at a limit of u: up to the first nothing is tested, then _EXCESS, beyond the second _MISSED.
_SELDOM, _OFTEN = 0.02, 0.25
# residual over spread of u: if more is left where u is at its limits often, it was clipped: refused, told
_MISSED = 0.07, 0.03
# Failed readings: stays at one value of no more samples than this, and so many of them
_FAILED, _FAILED_TIMES = 20, 2
# Sampling periods from one neighbour to the other: if they are further apart, motion may look like an outlier
_NEAR = 5.0
_ONE_SIDED = 0.98  # share of the samples: if more have one sign, a size was recorded
_SIGNED = 0.6  # residual over spread of u: if less is left with the sign of the other signal, that sign was missing
_ONE_SIZE = 0.3  # jumps of x by more than half its range are of one size if they differ by less than this share of it
# Per cent of the values on one side of a jump: so few lie between where the jump ends and the end of the range
_END = 30
_CONTRADICT = 3.0  # standard errors: if two recordings differ by more, and by 5 %, they contradict each other


class Warnings(list):
    """A list of sentences. `refuse` raises IdentificationError with all of them; with `anyway` it only adds its own."""

    def __init__(self, anyway=False, who=""):
        self.anyway, self.who = anyway, who

    def add(self, sentence):
        """Add a warning, preceded by whom it is about."""
        self.append(self.who + sentence)

    def refuse(self, sentence):
        """Refuse data that would make the numbers meaningless; with `anyway` only add a warning."""
        if not self.anyway:
            raise IdentificationError(" Also: ".join([f"{self.who}{sentence} (anyway=True goes on)", *self]))
        self.add(f"went on anyway: {sentence}")


def at_bounds(names, x, low, high, room=0.0):
    """Tell which values stand at a bound of their search: they are not a measurement, and their error is infinite.

    Args: names (p); x (p,); low, high: numbers or (p,); room: a value nearer to a bound than this stands at it.
    Returns: a list with one sentence or none, and (p,) bool: which values they are.
    """
    bounds = np.where(x - low < high - x, low, high)
    at = np.abs(x - bounds) <= room
    found = [f"{names[k]} = {x[k]:.4g} (bound {bounds[k]:.4g})" for k in np.flatnonzero(at)]
    beyond = "the data may call for values beyond it, the error is infinite"
    return [f"at a bound: {', '.join(found)}; {beyond}"] if found else [], at


def check_signals(warned, t, q, u, turns=TURNS):
    """Check q (n,) and u (n,) at the times t (n,) before any model is fitted.

    turns: rad; a q that spans more may be in degrees.
    Returns: (n,) bool, where q is new (a slow sensor repeats its value).
    """
    if len(t) < FEWEST:
        warned.refuse(f"{len(t)} samples are too short a record; record {FEWEST} or more, over several reversals")
    for name, x in (("q", q), ("u", u)):
        if np.ptp(x) <= 1e-12 * np.abs(x).max():
            raise IdentificationError(f"{warned.who}{name} is constant at {x[0]:.6g}: check sensor, or drive harder")
    failed = _failed_readings(warned, t, q)
    places = np.union1d(check_outliers(warned, "q", t, q, told=failed), failed).astype(int)
    for name, x, out in (("q", q, places), ("u", u, check_outliers(warned, "u", t, u))):
        _check_jumps(warned, name, np.delete(t, out), np.delete(x, out))
    if (values := len(np.unique(q))) < 3:
        warned.refuse(f"q takes only {values} values: no motion can be seen; use a finer sensor")
    _hung(warned, np.delete(t, places), np.delete(q, places))
    _clipped(warned, np.delete(t, places), np.delete(q, places))
    if (span := np.ptp(np.delete(q, places))) > turns:
        warned.add(f"q spans {span:.4g} rad: is it in degrees? Use np.radians(q)")
    if np.diff(t).min() > _SLOW_CLOCK:
        warned.add(f"one sample every {sampling_period(t):.4g} s: is t in ms or microseconds? Give seconds")
    new = _new(warned, np.delete(t, failed), np.delete(q, failed))
    used = np.zeros(len(q), dtype=bool)
    used[np.setdiff1d(np.arange(len(q)), failed)] = new
    return used


def _on_grid(x):
    """Whether all values of x (n,) lie on the steps of a counter or converter."""
    steps, quantum = np.diff(np.unique(x)), quantum_of(x)
    return quantum > 0 and np.abs(steps / quantum - np.rint(steps / quantum)).max() < 0.05


def _failed_readings(warned, t, q):
    """Warn of samples at which q leaps to a value, stays or comes again, and is soon back. Returns their indices.

    So it looks when a sensor or its link answers 0 now and then; an angle that is wrapped moves on after its leap.
    """
    step = np.diff(q)
    usual = np.median(np.abs(step)) if len(step) else 0.0
    span = np.diff(np.quantile(q, (0.02, 0.98)))[0]
    far = np.flatnonzero(np.abs(step) > max(_SPIKE * span, 15 * usual))
    stays = [(a + 1, b + 1) for a, b in pairwise(far) if b - a <= _FAILED]
    stays = [(a, b) for a, b in stays if np.ptp(q[a:b]) == 0 and abs(q[b] - q[a - 1]) < 0.4 * abs(step[a - 1])]
    values, counts = np.unique([q[a] for a, _ in stays], return_counts=True)
    lasting = [q[a] for a, b in stays if b - a > 1]  # what leaps for one sample only, and once, is an outlier
    values = values[(counts >= _FAILED_TIMES) | np.isin(values, lasting)]
    at = np.flatnonzero(np.isin(q, values))  # near the true angle the leap is small: a known value is enough
    stays = [at[a:b] for a, b in runs(at.astype(float), 1.5) if b - a <= _FAILED]
    if not len(values):
        return at
    said = f"q leaps to {', '.join(f'{value:.4g}' for value in values[:3])} and back {len(stays)} time(s)"
    warned.add(f"{said}, first at t = {t[stays[0][0]]:.6g} s: failed readings of the sensor, left out")
    return np.concatenate(stays)


def _check_jumps(warned, name, t, x):
    """Refuse an x (n,) whose large jumps all have one size: an encoder or a counter that turns over, or a sign bit.

    What turns over jumps from one end of its range to the other; behind a sign bit the values begin at the least again.
    Switched levels do neither.
    """
    step = np.diff(x)
    far = np.flatnonzero(np.abs(step) > 0.5 * np.ptp(x))
    sizes = np.abs(step[far])
    if not len(far) or np.ptp(sizes) > _ONE_SIZE * sizes.max() or sizes.min() < 15 * np.median(np.abs(step)):
        return
    from scipy.stats import percentileofscore

    upper = x > (x.min() + x.max()) / 2
    low, high = np.sort([x[far], x[far + 1]], axis=0)
    low, high = (percentileofscore(*pair, kind="mean").mean() for pair in ((x[~upper], low), (x[upper], high)))
    powers = quantum_of(x) * 2.0 ** np.arange(4, 33)
    known = np.r_[[whole / k for k in range(1, 13) for whole in (2 * np.pi, 360.0)], powers]
    turn = np.median(np.abs(step - np.convolve(step, (0.5, 0.0, 0.5), "same"))[far])  # without the motion
    near = known[np.argmin(np.abs(known - turn))]
    turn = near if abs(near - turn) < 0.01 * turn else turn
    if name == "u" and not _on_grid(x):
        return
    said = f"{name} jumps by {turn:.6g} {len(far)} time(s), first at t = {t[far[0] + 1]:.6g} s"
    if low < _END and high > 100 - _END and (name == "q" or np.ptp(np.unwrap(x, period=turn)) < 0.9 * np.ptp(x)):
        why = "a whole turn was wrapped (an encoder before its gear? A register without sign?)"
        warned.refuse(f"{why}: {said}; use np.unwrap({name}, period={turn:.6g})")
    elif low < _END and high < _END and turn in powers:
        mend = f"np.where({name} < {turn:.6g}, {name}, {turn:.6g} - {name})"
        warned.refuse(f"{name} has a sign bit: {said}; use {mend}")


def _new(warned, t, q):
    """Which samples of q (n,) are new, where a slow sensor repeats its value over several rows; else all True.

    Its rows may come at any rhythm. A joint that stands still repeats its angle, too; but it does so where it is slow.
    """
    steps = np.abs(np.diff(q))
    new = np.r_[True, steps > 0]
    places = np.flatnonzero(new)
    every = len(q) / len(places)
    if every < 1.3 or np.median(steps[steps > 0]) < 4 * quantum_of(q):  # small steps: a coarse sensor
        return np.ones(len(q), dtype=bool)
    speed = np.abs(np.diff(q[places]) / np.diff(t[places]))  # from one new value to the next
    repeated = speed[np.searchsorted(places[1:], np.flatnonzero(~new)).clip(max=len(speed) - 1)]
    if np.median(repeated) < 0.3 * np.sqrt(np.mean(speed**2)):
        return np.ones(len(q), dtype=bool)
    warned.add(f"q is new only in every {every:.3g}th row (a slow sensor): the others were left out")
    return new


def _hung(warned, t, q):
    """Refuse a q that stands still for some samples and then jumps within one: its sensor or the link hung."""
    steps = np.where(np.diff(t) < 1.5 * sampling_period(t), np.abs(np.diff(q)), 0.0)  # a gap is no jump
    usual = float(np.quantile(steps[steps > 0], 0.98)) if steps.any() else np.inf
    moved = np.flatnonzero(np.diff(q))
    stood = np.diff(moved, prepend=-1) - 1  # samples without change before each move
    hung = moved[(stood >= _STAYS) & (steps[moved] > _JUMP * usual)]
    if len(hung):
        where = f"t = {t[hung[0] + 1]:.6g} s ({len(hung)} time(s))"
        warned.refuse(f"q stands still and jumps at {where}: the sensor or link hung; leave these samples out")


def _clipped(warned, t, q):
    """Refuse a q that runs into its largest or smallest value, stays there, and leaves it as suddenly (clipped)."""
    still = np.flatnonzero((np.diff(q) == 0) & (q[1:] > q.min()) & (q[1:] < q.max()))
    rests = [(still[a], still[b - 1] + 2) for a, b in runs(still.astype(float), 1.5) if b - a >= _STAYS - 1]
    for name, x in (("largest", q), ("smallest", -q)):
        places = np.flatnonzero(x >= x.max() - 1e-9 * np.ptp(x))
        stays = [(places[a], places[b - 1] + 1) for a, b in runs(places.astype(float), _BROKEN) if b - a >= _STAYS]
        if any(_is_cut_off(t, x, *stay) for stay in stays):
            said = f"q was clipped (or stops suddenly) at its {name} value, {q[places[0]]:.6g} rad"
            elsewhere = any(_is_cut_off(t, sign * q, *rest) for rest in rests for sign in (1, -1))
            tell = warned.add if elsewhere else warned.refuse  # if q stops so elsewhere too, it is the joint
            tell(f"{said}: record within the range, or cut these parts out")


def _is_cut_off(t, x, begin, end):
    """Whether x (n,) runs into the stay x[begin:end] at its largest value, and out of it, without slowing down.

    A joint that comes to rest brakes: for some m, its speed over the m samples beside the stay (`near`) is less than
    three times what it lost since the m samples before (`lost`). `hidden` is the angle that a parabola with the speed
    `near` would have risen above the stay: it must be more than the sensor's resolution, and less than three ranges, or
    the joint rested there.
    """
    step, period, quantum = np.diff(x), sampling_period(t), quantum_of(x)
    noise = float(np.median(np.abs(np.diff(step)))) / 0.6745 / math.sqrt(6)
    widest = max(3, (end - begin) // 8)
    if begin < 2 * widest or end + 2 * widest > len(x):
        return False
    for m in (widest // k for k in (32, 16, 8, 4, 2, 1) if widest >= 3 * k):
        places = [slice(first, first + m) for first in (begin - m, end, begin - 2 * m, end + m)]
        before, after, *earlier = (np.polyfit(t[part] - t[begin], x[part], 1)[0] for part in places)
        near, lost = before - after, earlier[0] - earlier[1] - (before - after)
        unsure = (2 * quantum + 8 * noise / math.sqrt(m)) / ((m - 1) * period)
        if near + unsure < 3 * lost:
            return False
    fast = min(before, -after) > _ABRUPT * math.sqrt(np.mean(step**2)) / period
    hidden = near / 2 * (t[end - 1] - t[begin]) / 4  # rad
    return near > 3 * max(lost, 0.0) + unsure and fast and 2 * quantum + 1e-4 * np.ptp(x) < hidden < 3 * np.ptp(x)


def check_outliers(warned, name, t, x, remedy="leave these samples out", told=()):
    """Warn of samples of x (n,) far from both neighbours, which agree; return their indices, without those in `told`.

    Lost counts and bad bytes look like this. Torque ripple does not: there all neighbours are far from each other.
    """
    from scipy.ndimage import median_filter

    low, high = np.quantile(x, (0.02, 0.98))
    off = np.abs(x[1:-1] - (x[:-2] + x[2:]) / 2)
    around = np.maximum(median_filter(off, 41, mode="nearest"), np.median(off)) if len(off) else off
    far = off > np.maximum(max(_SPIKE * (high - low), _LEAST * quantum_of(x)), 12 * around)
    far &= t[2:] - t[:-2] < _NEAR * np.median(np.diff(t))
    places = np.setdiff1d(np.flatnonzero(far & (np.abs(x[2:] - x[:-2]) < 0.4 * off)) + 1, told)
    if len(places):
        k = places[0]
        warned.add(f"{name} has {len(places)} outlier(s), the first at t = {t[k]:.6g} s, {x[k]:.4g}: {remedy}")
    return places


def check_measured_speed(warned, t, q, qd):
    """Warn if qd (n,) is not the rate of change of q (n,): it may have another unit, or belong to another joint."""
    near = np.diff(t) < 1.5 * sampling_period(t)  # not across gaps
    rate, speed = (np.diff(q) / np.diff(t))[near], ((qd[1:] + qd[:-1]) / 2)[near]
    factor = float(rate @ speed / max(speed @ speed, 1e-300))
    if not 0.9 < factor < 1.1:
        warned.add(f"the angle changes at {factor:.3g} times qd: is qd in rad/s and q in rad, of the same joint?")


def check_clipped_drive(warned, found):
    """Refuse a u that was cut off only in the recording, or of which only the direction was recorded.

    A drive that really saturates, or is switched, is fine: its motion needs no more than what was recorded. The model
    is fitted again with a delay of u, and then with a column for the samples at each limit as well, whose parameter is
    what the motion needs beyond that limit (`excess`). If u is at its limits very often, these columns are nearly u
    itself; then the residual of the first fit decides (`missed`).
    """
    late = np.column_stack([found.A, found.slope, np.gradient(found.slope)])
    missed = least_squares(late, found.y, tolerance=1e-3).rms / np.std(found.y)
    beside = least_squares(np.column_stack([late, found.limits]), found.y, tolerance=1e-3)
    excess, sigma = beside.x[-2:] * (1, -1) / np.ptp(found.y), beside.stderr[-2:] / np.ptp(found.y)
    share = np.mean(found.limits.max(axis=1) > 0.5)
    needs_more, may_need_more = (
        bool((excess > np.maximum(least, errors * sigma)).any()) and share > _SELDOM for least, errors in _EXCESS
    )
    often = share > _OFTEN
    said = f"it is at its limits in {share:.0%} of the record, but the motion needs more or other values there"
    remedy = "record a wider range, or drive less (if it is late, give delay=)"
    if missed > _MISSED[0] if often else needs_more:
        warned.refuse(f"u was clipped: {said}; {remedy}")
    elif may_need_more or (often and missed > _MISSED[1]):
        warned.add(f"u may have been clipped: {said}; {remedy}")


def without_sign(found, with_speed):
    """Return a sentence if u, or the speed, was recorded without its sign and the other's sign explains it; else "".

    with_speed: whether qd was measured, and is what lacks its sign.

    A current sensor gives such a u, and so do PWM counts with a separate direction pin; one channel of an encoder gives
    such a q.
    """
    one_sided = [np.mean(x > 0) > _ONE_SIDED or np.mean(x < 0) > _ONE_SIDED for x in (found.y, found.v)]
    if one_sided[0] == one_sided[1]:
        return ""
    if one_sided[0]:
        A, y = found.A, found.y * np.sign(found.v)
        said = "u has one sign only, that of a size, and u * np.sign(qd) fits: give u with the sign of its direction"
    else:
        A, y = found.A * np.sign(found.y)[:, None], found.y
        mend = (
            "np.abs(qd) * np.sign(u) as qd"
            if with_speed
            else "np.cumsum(np.abs(np.diff(q, prepend=q[0])) * np.sign(u)) as q"
        )
        said = f"the joint moves one way only though u changes its sign, and with the sign of u it fits: give {mend}"
    return said if least_squares(A, y, tolerance=1e-3).rms < _SIGNED * np.std(y) else ""


def check_contradiction(warned, recordings, fit, least):
    """Warn of recordings that disagree.

    fit: returns the fit of one recording; least: {parameter: difference to ignore}. Of three or more, the odd one is
    the one that differs most from all others, in standard errors.
    """
    found = {}
    for k, one in enumerate(recordings, 1):
        try:
            found[k] = fit(one)
        except IdentificationError as refusal:
            warned.add(f"recording {k} alone would be refused: {refusal}")
    for name, small in least.items():
        x, sigma = (np.array([getattr(one, name + ending) for one in found.values()]) for ending in ("", "_stderr"))
        apart = np.abs(x[:, None] - x)
        apart = np.where(apart > np.maximum(0.05 * np.abs(x), small), apart, 0.0) / np.hypot(sigma[:, None], sigma)
        if apart.max(initial=0.0) > _CONTRADICT:
            odd = int(np.argmax(apart.sum(axis=0)))
            value = f"{x[odd]:.4g} +- {sigma[odd]:.2g} where the others give {np.median(np.delete(x, odd)):.4g}"
            warned.add(f"recording {list(found)[odd]} contradicts the others: {name} {value}")
