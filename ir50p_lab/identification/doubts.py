"""Whether a recording of a joint can be believed: what is meaningless is refused, every other doubt is a sentence."""

import math

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.columns import quantum_of, runs, sampling_period

FEWEST = 40  # samples, ten for each of four parameters
_TURNS = 6 * math.pi  # rad: further than joints go, and a third of a radian in degrees
_FAST = 60.0  # rad/s: faster than joints are, and a slow joint in degrees
_SLOW_CLOCK = 0.15  # s: nobody samples a joint so slowly, many write milliseconds
_STAYS = 5  # samples at one value that look like more than chance
_BROKEN = 3.5  # samples: noise breaks a stay into pieces this near to each other
_ABRUPT = 0.2  # of the rms speed, with which a joint runs into the end of its sensor, and comes back out of it
_JUMP = 5.0  # times the largest usual step, by which a frozen angle jumps when it is alive again
_SPIKE = 0.05  # of the range, and 12 times the bends around it: one sample this far from both neighbours is an outlier
_LEAST = 3  # quanta, of an outlier: fewer are the flicker of a coarse signal
_LEVELS = 16  # an input of so few levels is switched, not clipped


class Doubts(list):
    """Sentences; `refuse` raises IdentificationError, with them, unless `anyway`: then it adds its sentence too."""

    def __init__(self, anyway=False, who=""):
        self.anyway, self.who = anyway, who

    def add(self, sentence):
        """Another doubt."""
        self.append(self.who + sentence)

    def refuse(self, sentence):
        """What makes the numbers meaningless."""
        if not self.anyway:
            raise IdentificationError(" Also: ".join([f"{self.who}{sentence} (anyway=True goes on)", *self]))
        self.add(f"gone on anyway: {sentence}")


def check_signals(doubts, t, q, u):
    """What is wrong with q (n,) and u (n,) at the times t (n,) before any model; True for samples that are new."""
    new = np.ones(len(t), dtype=bool)
    if len(t) < FEWEST:
        doubts.refuse(
            f"{len(t)} samples are too short a record; record {FEWEST} or more, over several reversals of the motion"
        )
    for name, x in (("q", q), ("u", u)):
        if np.ptp(x) <= 1e-12 * np.abs(x).max():
            raise IdentificationError(
                f"{doubts.who}{name} is constant at {x[0]:.6g} in the whole record: check sensor and power, and "
                "drive harder than the breakaway friction, to both sides"
            )
        check_outliers(doubts, name, t, x)
    if len(np.unique(q)) < 3:
        doubts.refuse(f"q takes only {len(np.unique(q))} values: no motion can be seen; use a finer sensor")
    else:
        _whole_turns(doubts, t, q)
        new = _repeated_angles(doubts, q)
        _frozen_angle(doubts, t, q)
        _clipped_angle(doubts, t, q)
    if np.ptp(q) > _TURNS:
        doubts.add(f"q spans {np.ptp(q):.4g} rad: is it in degrees? Use np.radians(q)")
    period = sampling_period(t)
    if period > _SLOW_CLOCK:
        doubts.add(f"one sample every {period:.4g} s: is t in ms or microseconds? Give seconds")
    return new


def _whole_turns(doubts, t, q):
    """Angles that jump by a whole turn between neighbours (2 pi rad, or 360 degrees)."""
    step = np.diff(q)
    usual = 1.4826 * np.median(np.abs(step)) + 1e-12
    for turn, remedy in ((2 * math.pi, "np.unwrap(q)"), (360.0, "np.unwrap(np.radians(q))")):
        jumps = t[1:][(np.abs(np.abs(step) - turn) < 0.1 * turn) & (np.abs(step) > 10 * usual)]
        if len(jumps):
            doubts.refuse(
                f"q jumps by {turn:.4g} at t = {jumps[0]:.6g} s ({len(jumps)} time(s)): a whole turn was wrapped; use "
                f"{remedy}"
            )


def _repeated_angles(doubts, q):
    """Samples in which q is new, where it is renewed more slowly than rows are written; else all."""
    steps = np.abs(np.diff(q))
    new = np.flatnonzero(steps > 0)
    every = (len(q) - 1) / max(len(new), 1)
    regular = np.mean(np.abs(np.diff(new) - every) < 0.6) >= 0.7  # or it stood still now and then
    if every < 1.9 or np.median(steps[new]) < 4 * quantum_of(q) or not regular:  # small: the steps of a coarse sensor
        return np.ones(len(q), dtype=bool)
    doubts.add(
        f"q is new only in every {every:.3g}th row: its sensor is slower than the file; only the rows in which it "
        "changes were used"
    )
    return np.r_[True, steps > 0]


def _frozen_angle(doubts, t, q):
    """A q that stands still for some samples and then jumps within one, as it does where a sensor or a link hangs."""
    steps = np.where(np.diff(t) < 1.5 * sampling_period(t), np.abs(np.diff(q)), 0.0)  # a gap is no jump
    usual = float(np.quantile(steps[steps > 0], 0.98)) if steps.any() else np.inf
    moved = np.flatnonzero(np.diff(q) != 0)
    stood = np.diff(moved, prepend=-1) - 1  # samples without change before each move
    frozen = np.flatnonzero((stood >= _STAYS) & (steps[moved] > _JUMP * usual))
    if len(frozen):
        k = moved[frozen[0]]
        doubts.refuse(
            f"q stands for {stood[frozen[0]] + 1} samples and jumps by {q[k + 1] - q[k]:.3g} rad at t = {t[k + 1]:.6g} "
            f"s ({len(frozen)} time(s)): the sensor or link hung. Leave these samples out; a gap in time is understood"
        )


def _clipped_angle(doubts, t, q):
    """A q that runs into its largest or smallest value, stays there, and comes out of it as suddenly.

    A joint that comes to rest slows down first: over the last m samples it is no faster than it lost over the m
    before. One that is cut off loses its speed at once, and regains it at once.
    """
    quantum = quantum_of(q)
    noise = float(np.median(np.abs(np.diff(q, 2)))) / 0.6745 / math.sqrt(6)
    period = sampling_period(t)
    rms = math.sqrt(np.mean(np.diff(q) ** 2)) / period
    for sign, name in ((1, "largest"), (-1, "smallest")):
        x = sign * q
        places = np.flatnonzero(x >= x.max() - 1e-9 * np.ptp(x))
        lost, height = 0, 0.0
        for first, last in runs(places.astype(float), _BROKEN) if len(places) >= _STAYS else ():
            begin, end = places[first], places[last - 1] + 1
            m = max(3, (end - begin) // 8)
            if last - first < _STAYS or begin < 2 * m or end + 2 * m > len(q):
                continue
            near, far = (
                [_slope(t, x, begin - (k + 1) * m, begin - k * m), -_slope(t, x, end + k * m, end + (k + 1) * m)]
                for k in (0, 1)
            )
            hidden = sum(near) / 2 * (t[end - 1] - t[begin]) / 4
            unsure = (2 * quantum + 8 * noise / math.sqrt(m)) / ((m - 1) * period)
            if (
                sum(near) > 3 * max(sum(far) - sum(near), 0.0) + unsure
                and min(near) > _ABRUPT * rms
                and 2 * quantum + 1e-4 * np.ptp(q) < hidden < 3 * np.ptp(q)  # more is a rest, not a hidden swing
            ):
                lost, height = lost + last - first, max(height, hidden)
        if lost:
            doubts.refuse(
                f"q was clipped: it runs into its {name} value, {sign * x.max():.6g} rad, without slowing down, stays "
                f"for {lost} samples and leaves it as fast (about {height:.2g} rad are missing). The sensor ends, "
                "or the joint hits a stop: record again within the range, or cut these stretches out"
            )


def _slope(t, x, first, last):
    """Slope of a straight line through x[first:last]."""
    t, x = t[first:last] - t[first:last].mean(), x[first:last]
    return float(t @ x / (t @ t))


def outliers(x):
    """Indices of samples of x (n,) that are far from both neighbours, which agree, where nothing around is so rough.

    Lost counts, bad bytes; not torque ripple, where all neighbours are far from each other.
    """
    if len(x) < 5:
        return np.empty(0, dtype=int)
    from scipy.ndimage import median_filter

    low, high = np.quantile(x, (0.02, 0.98))
    off = np.abs(x[1:-1] - (x[:-2] + x[2:]) / 2)
    around = np.maximum(median_filter(off, 41, mode="nearest"), np.median(off))
    alone = (off > np.maximum(max(_SPIKE * (high - low), _LEAST * quantum_of(x)), 12 * around)) & (
        np.abs(x[2:] - x[:-2]) < 0.4 * off
    )
    return np.flatnonzero(alone) + 1


def check_outliers(doubts, name, t, x, remedy="leave these samples out, they pull at every parameter"):
    """A doubt about outliers of the signal `name`. Returns their indices."""
    places = outliers(x)
    if len(places):
        k = places[0]
        doubts.add(
            f"{name} has {len(places)} outlier(s), the first at t = {t[k]:.6g} s ({x[k]:.4g} between {x[k - 1]:.4g} "
            f"and {x[k + 1]:.4g}): {remedy}"
        )
    return places


# Measured on three machines, 3 seeds, limits at 30 to 90 %: clipped 0.02 of the range or more and 1.0 or more; a drive
# that saturates, 0.67 at most. `reach`: how far these samples lie outside the ones the model was fitted to.
_EXCESS, _BEYOND = 0.01, 0.85


def check_clipped_drive(doubts, u, found):
    """A u that was cut off in the recording only: the motion shows that more was there.

    The model of the other samples is compared with those where u has its largest or smallest value. A drive that
    really saturates, or a switched input, is fine: there the motion needs no more than what was recorded.
    """
    extreme, A = found.table.extreme, found.A
    plain = extreme.max(axis=1) < 0.02
    if len(np.unique(u)) <= _LEVELS or plain.sum() < FEWEST // 2:
        return
    Q, R = np.linalg.qr(A[plain])
    if np.linalg.cond(R / np.maximum(np.linalg.norm(R, axis=0), 1e-300)) > 1e6:  # too little motion is left to tell
        return
    left = found.y - A @ np.linalg.solve(R, Q.T @ found.y[plain])
    rms = math.sqrt(np.mean(left[plain] ** 2))
    for side, (name, limit, sign) in enumerate((("smallest", u.min(), -1), ("largest", u.max(), 1))):
        cut = np.flatnonzero(extreme[:, side] > 0.5)
        if len(cut) < 3:
            continue
        excess = -sign * left[cut]
        reach = math.sqrt(plain.sum() * np.mean(np.sum(np.linalg.solve(R.T, A[cut].T) ** 2, axis=0)))
        if excess.mean() > max(_EXCESS * np.ptp(u), _BEYOND * rms * reach):
            doubts.refuse(
                f"u was clipped: it stays at its {name} value, {limit:.6g}, where the motion needs "
                f"{limit + sign * excess.max():.4g}: widen the range that is recorded, or drive less"
            )
    share = float((extreme.max(axis=1) > 0.5).mean())
    if share > 0.1 and rms > 0.08 * np.std(found.y):
        doubts.add(
            f"u is at its largest or smallest value in {100 * share:.0f} % of the record and the model does not "
            "explain it well: was it clipped in the recording? Widen the range that is recorded"
        )


def check_speed(doubts, fastest):
    """A joint faster than joints are."""
    if fastest > _FAST:
        doubts.add(f"the joint reaches {fastest:.3g} rad/s: is q in degrees?")
