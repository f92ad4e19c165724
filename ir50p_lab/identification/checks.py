"""Whether a recording of a joint can be believed: what is meaningless is refused, all else is a warning."""

import math

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.columns import quantum_of, runs, sampling_period

FEWEST = 40  # samples, ten for each of four parameters
_TURNS = 6 * math.pi  # rad: further than joints go, and a third of a radian in degrees
_SLOW_CLOCK = 0.15  # s: nobody samples a joint so slowly, many write milliseconds
_STAYS = 5  # samples at one value that look like more than chance
_BROKEN = 3.5  # samples: noise breaks a stay into pieces this near to each other
_ABRUPT = 0.2  # of the rms speed, with which a joint runs into the end of its sensor, and comes back out of it
_JUMP = 5.0  # times the largest usual step, by which a frozen angle jumps when it is alive again
_SPIKE = 0.05  # of the range, and 12 times the bends around it: one sample this far from both neighbours is an outlier
_LEAST = 3  # quanta, of an outlier: fewer are the flicker of a coarse signal
_MOTION = 3.0  # least speed over that of the noise
_LEVELS = 16  # an input of so few levels is switched, not clipped
# Measured on three machines, 3 seeds, limits at 30 to 90 %: clipped 0.02 of the range or more and 1.0 or more; a drive
# that saturates, 0.67 at most. `reach`: how far these samples lie outside the ones the model was fitted to.
_EXCESS, _BEYOND = 0.01, 0.85
_EXPLAINED = 0.02  # least share of the variance of u that the motion explains
_F = 8.0  # least F value of a motion that has to do with u
_BENT, _CLEARLY = 0.3, 4.0  # change of the slope of friction with the speed, over the slope; over its standard error
_POOR = 0.5  # fit: below, the standard errors hold for a model that does not
_LATE = (0.9, 5.0, 0.3), (0.99, 8.0, 0.6)  # of the residual, that a delay leaves; its standard errors; in periods
_MISSING = 0.1  # of the spread of u, that may be left and be alike over time
_MORE = {
    "viscous": "several speeds that differ more",
    "coulomb": "slow motion to both sides beside fast one",
    "stribeck": "crawling motion to both sides",
}


class Warnings(list):
    """Sentences; `refuse` raises IdentificationError, with them, unless `anyway`: then it adds its sentence too."""

    def __init__(self, anyway=False, who=""):
        self.anyway, self.who = anyway, who

    def add(self, sentence):
        """Another warning."""
        self.append(self.who + sentence)

    def refuse(self, sentence):
        """What makes the numbers meaningless."""
        if not self.anyway:
            raise IdentificationError(" Also: ".join([f"{self.who}{sentence} (anyway=True goes on)", *self]))
        self.add(f"gone on anyway: {sentence}")


def check_signals(warned, t, q, u):
    """What is wrong with q (n,) and u (n,) at the times t (n,) before any model; True for samples that are new."""
    new = np.ones(len(t), dtype=bool)
    if len(t) < FEWEST:
        warned.refuse(f"{len(t)} samples are too short a record; record {FEWEST} or more, over several reversals")
    for name, x in (("q", q), ("u", u)):
        if np.ptp(x) <= 1e-12 * np.abs(x).max():
            raise IdentificationError(f"{warned.who}{name} is constant at {x[0]:.6g}: check sensor, or drive harder")
    places, _ = (check_outliers(warned, name, t, x) for name, x in (("q", q), ("u", u)))
    if len(np.unique(q)) < 3:
        warned.refuse(f"q takes only {len(np.unique(q))} values: no motion can be seen; use a finer sensor")
    else:
        _whole_turns(warned, t, q)
        new = _repeated_angles(warned, q)
        for look in (_frozen_angle, _clipped_angle):
            look(warned, np.delete(t, places), np.delete(q, places))
    if np.ptp(q) > _TURNS:
        warned.add(f"q spans {np.ptp(q):.4g} rad: is it in degrees? Use np.radians(q)")
    if (period := sampling_period(t)) > _SLOW_CLOCK:
        warned.add(f"one sample every {period:.4g} s: is t in ms or microseconds? Give seconds")
    return new


def _whole_turns(warned, t, q):
    """Angles that jump by a whole turn between neighbours (2 pi rad, or 360 degrees)."""
    step = np.abs(np.diff(q))
    for turn in (2 * math.pi, 360.0):
        jumps = t[1:][(np.abs(step - turn) < 0.1 * turn) & (step > 15 * np.median(step))]
        if len(jumps):
            warned.refuse(f"a whole turn was wrapped at t = {jumps[0]:.6g} s: use np.unwrap(q, period={turn:.6g})")


def _repeated_angles(warned, q):
    """Samples in which q is new, where it is renewed more slowly than rows are written; else all."""
    steps = np.abs(np.diff(q))
    new = np.flatnonzero(steps > 0)
    every = (len(q) - 1) / len(new)
    regular = np.mean(np.abs(np.diff(new) - every) < 0.6) >= 0.7  # or it stood still now and then
    if every < 1.9 or np.median(steps[new]) < 4 * quantum_of(q) or not regular:  # small: the steps of a coarse sensor
        return np.ones(len(q), dtype=bool)
    warned.add(f"q is new only in every {every:.3g}th row (a slow sensor): the others were left out")
    return np.r_[True, steps > 0]


def _frozen_angle(warned, t, q):
    """A q that stands still for some samples and then jumps within one, as it does where a sensor or a link hangs."""
    steps = np.where(np.diff(t) < 1.5 * sampling_period(t), np.abs(np.diff(q)), 0.0)  # a gap is no jump
    usual = float(np.quantile(steps[steps > 0], 0.98)) if steps.any() else np.inf
    moved = np.flatnonzero(np.diff(q) != 0)
    stood = np.diff(moved, prepend=-1) - 1  # samples without change before each move
    frozen = np.flatnonzero((stood >= _STAYS) & (steps[moved] > _JUMP * usual))
    if len(frozen):
        where = f"t = {t[moved[frozen[0]] + 1]:.6g} s ({len(frozen)} time(s))"
        warned.refuse(f"q stands still and jumps at {where}: the sensor or link hung; leave these samples out")


def _clipped_angle(warned, t, q):
    """A q that runs into its largest or smallest value, stays there, and comes out of it as suddenly."""
    for name, x in (("largest", q), ("smallest", -q)):
        places = np.flatnonzero(x >= x.max() - 1e-9 * np.ptp(x))
        stays = [(places[a], places[b - 1] + 1) for a, b in runs(places.astype(float), _BROKEN) if b - a >= _STAYS]
        if (missing := max([_cut_off(t, x, *stay) for stay in stays], default=0.0)) > 0:
            where = f"{name} value, {q[places[0]]:.6g} rad (about {missing:.2g} rad are missing)"
            said = f"q was clipped (or stops suddenly) at its {where}: record within the range, or cut these parts out"
            (warned.add if _stops_suddenly(t, q) else warned.refuse)(said)


def _stops_suddenly(t, q):
    """Whether the joint turns round after a rest elsewhere, too, as if it was clipped there: then that is its way."""
    still = np.flatnonzero((np.diff(q) == 0) & (q[1:] > q.min()) & (q[1:] < q.max()))
    rests = [(still[a], still[b - 1] + 2) for a, b in runs(still.astype(float), 1.5) if b - a >= _STAYS - 1]
    return any(_cut_off(t, sign * q, *rest) > 0 for rest in rests for sign in (1, -1))


def _cut_off(t, x, begin, end):
    """Height, rad, of the swing above x[begin:end], a stay at the largest value; 0 if the joint comes to rest there.

    One that comes to rest slows down: over the last m samples it is no faster than it lost over the m before, at one m
    at least, as brakes are short. One that is cut off loses its speed at once, and regains it at once.
    """
    step, period, quantum = np.diff(x), sampling_period(t), quantum_of(x)
    noise = float(np.median(np.abs(np.diff(step)))) / 0.6745 / math.sqrt(6)
    widest = max(3, (end - begin) // 8)
    if begin < 2 * widest or end + 2 * widest > len(x):
        return 0.0
    for m in (widest // k for k in (32, 16, 8, 4, 2, 1) if widest >= 3 * k):
        places = [slice(first, first + m) for first in (begin - m, end, begin - 2 * m, end + m)]
        before, after, *earlier = (np.polyfit(t[part] - t[begin], x[part], 1)[0] for part in places)
        near, lost = before - after, earlier[0] - earlier[1] - (before - after)
        unsure = (2 * quantum + 8 * noise / math.sqrt(m)) / ((m - 1) * period)
        if near + unsure < 3 * lost:
            return 0.0
    sudden = near > 3 * max(lost, 0.0) + unsure
    fast = min(before, -after) > _ABRUPT * math.sqrt(np.mean(step**2)) / period
    height = near / 2 * (t[end - 1] - t[begin]) / 4
    seen = 2 * quantum + 1e-4 * np.ptp(x) < height < 3 * np.ptp(x)  # more is a rest, not a hidden swing
    return height if sudden and fast and seen else 0.0


def check_outliers(warned, name, t, x, remedy="leave these samples out"):
    """A warning of samples of x (n,) that are far from both neighbours, which agree. Returns their indices.

    Lost counts, bad bytes; not torque ripple, where all neighbours are far from each other.
    """
    from scipy.ndimage import median_filter

    low, high = np.quantile(x, (0.02, 0.98))
    off = np.abs(x[1:-1] - (x[:-2] + x[2:]) / 2)
    around = np.maximum(median_filter(off, 41, mode="nearest"), np.median(off)) if len(off) else off
    far = off > np.maximum(max(_SPIKE * (high - low), _LEAST * quantum_of(x)), 12 * around)
    places = np.flatnonzero(far & (np.abs(x[2:] - x[:-2]) < 0.4 * off)) + 1
    if len(places):
        k = places[0]
        warned.add(f"{name} has {len(places)} outlier(s), the first at t = {t[k]:.6g} s, {x[k]:.4g}: {remedy}")
    return places


def check_measured_speed(warned, t, q, v):
    """A qd that is not the rate of q: another unit, another joint."""
    near = np.diff(t) < 1.5 * sampling_period(t)  # not across gaps
    rate, v = (np.diff(q) / np.diff(t))[near], ((v[1:] + v[:-1]) / 2)[near]
    factor = float(rate @ v / max(v @ v, 1e-300))
    if not 0.9 < factor < 1.1:
        warned.add(f"the angle changes at {factor:.3g} times qd: is qd in rad/s and q in rad, of the same joint?")


def check_motion(warned, band):
    """A motion that is not faster than the noise of its own angle."""
    if band.speed < _MOTION * band.speed_noise or band.speed == 0:
        warned.refuse(f"not exciting: {band.speed:.2g} rad/s, noise alone {band.speed_noise:.2g} rad/s; move faster")


def check_clipped_drive(warned, u, found):
    """A u that was cut off in the recording only: the motion shows that more was there.

    The model of the other samples is compared with those where u has its largest or smallest value. A drive that
    really saturates, or a switched input, is fine: there the motion needs no more than what was recorded.
    """
    extreme, A = found.table.extreme, found.A / np.linalg.norm(found.A, axis=0)
    plain = extreme.max(axis=1) < 0.02
    if len(np.unique(u)) <= _LEVELS or plain.sum() < FEWEST // 2:
        return
    Q, R = np.linalg.qr(A[plain])
    if np.linalg.cond(R) > 1e6:  # too little motion is left to tell
        return
    left = found.y - A @ np.linalg.solve(R, Q.T @ found.y[plain])
    rms = math.sqrt(np.mean(left[plain] ** 2))
    # beside a delay, in any unit of u: where u is late the motion seems to need more of it, too
    late = np.column_stack([A, found.late_column / np.linalg.norm(found.y)])
    left = found.y - late @ np.linalg.lstsq(late[plain], found.y[plain])[0]
    for name, limit, sign, share in zip(("smallest", "largest"), (u.min(), u.max()), (-1, 1), extreme.T, strict=True):
        cut = share > 0.5
        if cut.sum() < 3:
            continue
        excess = -sign * left[cut]
        reach = math.sqrt(plain.sum() * np.mean(np.sum(np.linalg.solve(R.T, A[cut].T) ** 2, axis=0)))
        if excess.mean() > max(_EXCESS * np.ptp(u), _BEYOND * rms * reach):
            needed = f"{limit:.6g}, where the motion needs {limit + sign * excess.max():.4g}"
            warned.refuse(f"u was clipped at its {name} value, {needed}: record a wider range, or drive less")
    share = float((extreme.max(axis=1) > 0.5).mean())
    if share > 0.1 and rms > 0.08 * np.std(found.y):
        warned.add(f"u is at its limits in {100 * share:.0f} % of the record, not explained: clipped? Drive less")


def check_model(warned, found, fits, band, period, any_instant):
    """All that the fit itself shows; fits: the same at its cut-off and lower ones; any_instant: u held or measured."""
    table, left, n = found.table, found.left, len(found.y)
    total, missed = max(n * np.var(found.y), 1e-300), n * left.rms**2
    with_gravity = n * found.beside(table.columns[:, 1:3])[-1] ** 2
    explained = 1 - min(with_gravity, missed) / total
    F = explained / 5 / max((1 - explained) / max(left.independent - 6, 1), 1e-300)
    if explained < _EXPLAINED or (F < _F and explained < 0.5):
        share = f"{max(explained, 0):.1%} (F = {F:.1f}, needed {_F:.0f}; {left.independent:.0f} samples, too few?)"
        warned.refuse(f"u does not belong to this motion, which explains {share}: another joint or clock? A spring?")
    elif F < _F:
        warned.add(f"only {left.independent:.0f} independent samples (F = {F:.1f}): record longer, with more reversals")
    _check_friction(warned, found)
    if "inertia" in found.names:
        _check_inertia(warned, found, fits, band, period, any_instant)
    if found.misfit > 1 - _POOR:
        warned.add(f"the model explains little of u (fit {1 - found.misfit:.0%}): do not use it; look at q, u and load")
    gravity = "gravity_sin" not in found.names and np.ptp(table.q) > 0.2
    if gravity and with_gravity < 0.5 * missed and missed > 1e-4 * total:
        warned.add(f"{1 - with_gravity / missed:.0%} of the rest of u go with sin q, cos q: add terms=(..., 'gravity')")
    if left.correlation > 0.9 and missed > _MISSING**2 * total:
        warned.add(f"residuals are far from white ({left.correlation:.2f}): something is missing (backlash, a spring)")


def _check_friction(warned, found):
    """Friction that gives energy, drowns in its error, or cannot be told apart."""
    known = {name: found.value(name) for name in _MORE if math.isfinite(found.value(name)[1])}
    if math.isinf(found.value("coulomb")[1]):
        one_side = np.ptp(np.sign(found.table.direction)) == 0
        why = "the offset: the joint turns to one side only" if one_side else "viscous friction: one speed only"
        warned.add(f"Coulomb friction cannot be told from {why}; record {_MORE['coulomb']}")
    beside, _, bend, sigma, _ = found.beside(found.table.v * np.abs(found.table.v))
    slope, slow = found.value("viscous")[0], dict(zip(found.names, beside, strict=True)).get("viscous", 0.0)
    if abs(bend) > _CLEARLY * sigma and abs(slow - slope) > _BENT * abs(slope):
        warned.add(f"friction depends on speed: slope {slow:.3g} at rest, {slope:.3g} in all; fit slow and fast apart")
    negative = [name for name, (x, stderr) in known.items() if x < -3 * stderr and name != "stribeck"]
    if {"viscous", "coulomb"} <= set(negative):
        warned.refuse("viscous and Coulomb friction come out negative: is the sign of u or q turned round?")
    for name, (x, stderr) in known.items():
        said = f"{name.replace('coulomb', 'Coulomb')} friction {{}} ({x:.3g} +- {stderr:.2g}); record {_MORE[name]}"
        if name in negative:
            warned.add(said.format("is negative, but no brake gives energy; is u late (delay=)?"))
        elif stderr > 0.5 * abs(x):
            warned.add(said.format("drowns in its error"))


def _check_inertia(warned, found, fits, band, period, any_instant):
    """An inertia that is not there, is biased, or is mixed up with a delay of u."""
    J, stderr = found.value("inertia")
    if math.isinf(stderr):
        warned.add("inertia: the acceleration is noise or nothing here; record faster reversals, or a finer angle")
        return
    if J < 0:
        warned.add(f"inertia {J:.3g} +- {stderr:.2g} was left out: negative by wrong timing (delay=) or sign of u")
    elif stderr > 0.5 * J:
        warned.add(f"inertia {J:.3g} +- {stderr:.2g}: this motion hardly shows it; record faster reversals")
    elif band.acceleration_share > 0.03:
        warned.add(f"inertia: {100 * band.acceleration_share:.0f} % too small by noise; move faster, or filter more")
    if 0 < J < (b := found.value("viscous")[0]) * period:
        warned.add(f"the time constant {J / b:.3g} s is below the sampling period of {period:.3g} s: sample faster")
    _, delay, springs = min(_lateness(one, period, any_instant) for one in fits)
    if springs:
        warned.add("inertia depends on the frequency, as in a flexible joint: try a lower cutoff_hz")
    elif delay > 0:
        warned.add(f"u seems to act about {delay:.2g} s later than delay= says; add it there (backlash looks alike)")
    elif delay < 0:
        warned.add(f"q seems to be recorded {-delay:.2g} s before u, or u is filtered: inertia too small; shift one")


def _lateness(found, period, any_instant):
    """What a delay of u leaves of the residual, the delay, s, 0 if it is not sure, and whether snap leaves still less.

    At lower cut-offs a delay is seen better: noise of the acceleration hides a part of it, and looks like snap. With
    any_instant half a period is in the errors: less is no delay.
    """
    lag = found.beside(found.table.slopes[:, 1 - found.held])  # u behind a low pass: what went in is u + lag du/dt
    delay, sigma, rms = min(found.beside_delay[2:], lag[2:], key=lambda one: one[2])
    share = rms / max(found.left.rms, 1e-300)
    sure = any(share < most and abs(delay) > max(n * sigma, max(k, any_instant / 2) * period) for most, n, k in _LATE)
    return (share, delay, found.beside(found.table.snap)[-1] < rms) if sure else (1.0, 0.0, False)
