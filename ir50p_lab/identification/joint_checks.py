"""Whether the model of one joint fits its recording: refusals and doubts, each with its reason and what to do next."""

import math

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.regression import solve
from ir50p_lab.identification.signal_checks import FEWEST

_MOTION = 3.0  # least speed over that of the noise
_TURNS = 2.5 * math.pi  # rad: a joint that goes further is rare, one in degrees is not
_FAST = 20.0  # rad/s: faster than a servo without load
_SLOW_CLOCK = 0.15  # s: nobody samples a joint so slowly, many write milliseconds
_LEVELS = 16  # an input of so few levels is switched, not clipped
# Measured on three machines, 3 seeds, limits at 30 to 90 %: clipped 0.02 of the range or more and 1.0 or more; a drive
# that saturates, 0.67 at most. `reach`: how far these samples lie outside the ones the model was fitted to.
_EXCESS, _BEYOND = 0.01, 0.85
_TIMING = 1.5  # sampling periods by which u and q may be apart
_MATTERS = 0.1  # of the spread of u: an inertia that moves it less is hardly seen
_POOR = 0.5  # fit: below, the standard errors hold for a model that does not
_EXPLAINED = 0.02  # least share of the variance of u that the motion explains


def refuse_noise_only(band, q):
    """Refuse a motion that is not faster than the noise of its own angle."""
    if band.speed < _MOTION * band.speed_noise or band.speed == 0:
        raise IdentificationError(
            f"not exciting: the joint moves at {band.speed:.2g} rad/s rms where the noise of its angle "
            f"({band.noise:.2g} rad rms) alone looks like {band.speed_noise:.2g} rad/s; move further or faster"
        )


def refuse_too_little_motion(samples, n):
    """Refuse when next to nothing is left after filtering and leaving out standstill."""
    if samples < FEWEST // 2:
        raise IdentificationError(
            f"only {samples} of {n} samples are in motion and far enough from standstill, gaps and the ends of the "
            f"record; at least {FEWEST // 2} independent ones are needed: record longer, with more motion in it"
        )


def refuse_unexplained(solution, table):
    """Refuse a motion that holds fewer than two parameters, or that does not explain u."""
    if {1, 2} <= set(solution.dropped):
        raise IdentificationError(
            "not exciting: the joint turns at one speed in one direction, so that viscous and Coulomb friction and the "
            "offset cannot be told apart; record several speeds, to both sides"
        )
    y = table.y
    total = float(np.sum((y - y.mean()) ** 2))
    left = float(solution.residuals @ solution.residuals)
    explained = 1 - left / total if total > 0 else 0.0
    independent = len(y) * (1 - abs(solution.correlation)) / (1 + abs(solution.correlation))
    F = explained / 3 / max((1 - explained) / max(independent - 4, 1), 1e-300)
    if explained < _EXPLAINED or F < 8:
        raise IdentificationError(
            f"u does not belong to this motion: it explains {100 * max(explained, 0):.1f} % of the variance of u "
            f"(F = {F:.1f}, needed 8). Are q and u of the same joint and the same clock, and has u its sign? Does a "
            "spring or gravity dominate? Else excite more"
        )


def refuse_negative(solution, table, band, period):
    """Refuse friction that is all negative, and an inertia that is beyond three standard errors and wrong timing.

    Where u and q are apart by a sample, friction at a reversal looks like an inertia of (viscous + Coulomb/speed) times
    that; in a sweep of steady speeds that is all the inertia there is to see. Such a one, or one that hardly moves u,
    is left out and flagged, not refused.
    """
    J, b, c, _ = solution.x
    sJ, sb, sc, _ = solution.stderr
    if b < -3 * sb and c < -3 * sc:
        raise IdentificationError(
            f"viscous and Coulomb friction come out negative ({b:.3g} +- {sb:.2g}, {c:.3g} +- {sc:.2g}): is the sign "
            "of u or q turned round?"
        )
    matters = np.std(J * table.A[:, 0]) > _MATTERS * np.std(table.y)
    if matters and J < -3 * sJ - _TIMING * period * (abs(b) + abs(c) / band.speed):
        raise IdentificationError(
            f"the inertia comes out as {J:.4g} +- {sJ:.2g}, which no body has: is the sign of u or q turned round, "
            "does u come late (give delay=), or was it recorded before its limit?"
        )


def refuse_clipped_drive(u, table):
    """Refuse a u that was cut off in the recording only: the motion shows that more was there.

    The model of the other samples is compared with those where u has its largest or smallest value. A drive that
    really saturates, or a switched input, is fine: there the motion needs no more than what was recorded.
    """
    if len(np.unique(u)) <= _LEVELS:
        return
    plain = table.extreme.max(axis=1) < 0.02
    if plain.sum() < FEWEST // 2:
        return
    Q, R = np.linalg.qr(table.A[plain])
    if (
        np.linalg.cond(R / np.maximum(np.linalg.norm(R, axis=0), 1e-300)) > 1e6
    ):  # too little of the motion is left to tell
        return
    left = table.y - table.A @ np.linalg.solve(R, Q.T @ table.y[plain])
    rms = math.sqrt(np.mean(left[plain] ** 2))
    for side, (name, limit, sign) in enumerate((("smallest", u.min(), -1), ("largest", u.max(), 1))):
        cut = np.flatnonzero(table.extreme[:, side] > 0.5)
        if len(cut) < 3:
            continue
        excess = -sign * left[cut]
        reach = math.sqrt(plain.sum() * np.mean(np.sum(np.linalg.solve(R.T, table.A[cut].T) ** 2, axis=0)))
        if excess.mean() > max(_EXCESS * np.ptp(u), _BEYOND * rms * reach):
            raise IdentificationError(
                f"u was clipped: it stays at its {name} value, {limit:.6g}, where the motion needs "
                f"{limit + sign * excess.max():.4g}. What really drove the joint is not in the record: widen the range "
                "that is recorded, or drive less"
            )


def doubts(q, u, solution, table, band, period, negative=None):
    """Sentences on what is possible but hardly meant. negative: (inertia, its error) that was left out, or None."""
    switched = len(np.unique(u)) <= _LEVELS
    J, b, c, _ = solution.x
    sJ, sb, sc, _ = solution.stderr
    if np.ptp(q) > _TURNS:
        yield f"q spans {np.ptp(q):.4g} rad, {np.ptp(q) / (2 * math.pi):.2g} turns: is it in degrees? Use np.radians(q)"
    if table.fastest > _FAST:
        turns = table.fastest / (2 * math.pi)
        yield f"the joint reaches {table.fastest:.3g} rad/s, {turns:.2g} turns a second: is q in degrees?"
    if period > _SLOW_CLOCK:
        yield (
            f"one sample every {period:.4g} s: is t in ms or microseconds? Give seconds, or inertia and viscous "
            "friction come out in other units"
        )
    if negative is not None:
        yield (
            "inertia {:.3g} +- {:.2g} is negative, as a sample of wrong timing makes it, and was left out: record "
            "faster reversals, and check when u and q are read".format(*negative)
        )
    elif 0 in solution.dropped:
        yield (
            "inertia: the acceleration is noise or nothing here, so no inertia is given; record faster reversals, or "
            "a finer angle"
        )
    elif sJ > 0.5 * abs(J):
        yield f"inertia {J:.3g} +- {sJ:.2g}: this motion hardly shows it; record faster reversals"
    elif band.acceleration_share > 0.03:
        yield (
            f"inertia: about {100 * band.acceleration_share:.0f} % of the acceleration's power is noise of the angle, "
            "which pulls it towards zero by about as much; record faster motion, or give a lower cutoff_hz"
        )
    if 1 in solution.dropped:
        yield "viscous friction: one speed only, it cannot be told from Coulomb friction; record several speeds"
    if 2 in solution.dropped:
        yield (
            "Coulomb friction: the joint turns to one side only, so that it is in the offset; record both directions"
        )
    if b < -3 * sb:
        yield (
            f"viscous friction is negative, {b:.3g} +- {sb:.2g}: no brake gives energy. At crawling speed friction "
            "falls with speed (Stribeck): record faster motion too. Or u acts later than recorded (give delay=)"
        )
    elif 1 not in solution.dropped and (b < 0 or sb > abs(b)):
        yield f"viscous friction {b:.3g} +- {sb:.2g} cannot be told from zero: record faster motion"
    if c < -3 * sc:
        yield f"Coulomb friction is negative, {c:.3g} +- {sc:.2g}: is the sign of u or q turned round?"
    if J > 0 and b > 0 and 0 not in solution.dropped and 1 not in solution.dropped and J / b < period:
        yield (
            f"time constant inertia/viscous = {J / b:.3g} s is below the sampling period of {period:.3g} s: the record "
            "cannot show how the joint speeds up; sample five times in one time constant before trusting the inertia"
        )
    share = float((table.extreme.max(axis=1) > 0.5).mean())
    if share > 0.1 and solution.rms > 0.08 * np.std(table.y) and not switched:
        yield (
            f"u is at its largest or smallest value in {100 * share:.0f} % of the record and the model does not "
            "explain it well: was it clipped in the recording? Widen the range that is recorded"
        )
    fit = 1 - solution.rms / np.std(table.y)
    if fit < _POOR:
        yield (
            f"the model explains little of u (fit {100 * fit:.0f} %): a load, a spring, outliers or another machine's "
            "friction are in it; look at q and u, and do not use these numbers yet"
        )
    yield from _gravity(solution, table)
    if 0 not in solution.dropped:
        yield from _late(solution, table, period)
    if solution.correlation > 0.9 and solution.rms > 0.1 * np.std(table.y):
        yield (
            f"residuals are far from white (neighbours correlate by {solution.correlation:.2f}): something is missing "
            "in the model (backlash, Stribeck friction, delay, a spring); standard errors were widened for it"
        )


def _gravity(solution, table):
    """Whether what is left of u goes with sin q and cos q."""
    if np.ptp(table.q) < 0.2:
        return
    extra = np.column_stack([table.A, np.cos(table.q), np.sin(table.q)])
    r = table.y - extra @ np.linalg.lstsq(extra, table.y, rcond=None)[0]
    left = float(solution.residuals @ solution.residuals)
    if float(r @ r) < 0.5 * left and left > 1e-4 * float(np.sum((table.y - table.y.mean()) ** 2)):
        yield (
            "what is left of u goes with sin q and cos q: gravity (or a spring) acts on this joint, which these four "
            "parameters do not hold; turn the axis upright, or fit the arm with `fit`"
        )


def _late(solution, table, period):
    """Whether u acts later than it was recorded: u(t - delay) is about u - delay du/dt."""
    extra = np.column_stack([table.A, table.slope])
    found = solve(extra, table.y)
    delay, sigma = found.x[4], found.stderr[4]
    if found.rms < 0.9 * solution.rms and abs(delay) > 5 * sigma and abs(delay) > 0.3 * period:
        if delay > 0:
            yield (
                f"u seems to act about {delay:.2g} s after it was recorded, which makes the inertia too large by "
                "viscous times that: give delay="
            )
        else:
            yield (
                f"q seems to be recorded about {-delay:.2g} s before u (or u is filtered), which makes the inertia too "
                "small by viscous times that: shift one of them"
            )
