"""Whether the model of one joint fits its recording: each doubt with a number and what to do."""

import numpy as np

from ir50p_lab.identification.doubts import check_speed

_MOTION = 3.0  # least speed over that of the noise
_EXPLAINED = 0.02  # least share of the variance of u that the motion explains
_F = 8.0  # least F value of a motion that has to do with u
_POOR = 0.5  # fit: below, the standard errors hold for a model that does not
_MISSING = 0.1  # of the spread of u, that may be left and be alike over time


def check_motion(doubts, band):
    """A motion that is not faster than the noise of its own angle."""
    if band.speed < _MOTION * band.speed_noise or band.speed == 0:
        doubts.refuse(
            f"not exciting: the joint moves at {band.speed:.2g} rad/s rms where the noise of its angle "
            f"({band.noise:.2g} rad rms) alone looks like {band.speed_noise:.2g} rad/s; move further or faster"
        )


def check_model(doubts, found, band, period):
    """All that the fit itself shows."""
    table, left = found.table, found.left
    spread = np.std(found.y)
    check_speed(doubts, float(np.abs(table.v).max()))
    _friction_told_apart(doubts, found)
    with_gravity = _left(found, table.columns[:, 1:3])
    _unexplained(doubts, found, with_gravity)
    _signs(doubts, found)
    _inertia(doubts, found, band, period)
    for name in ("viscous", "coulomb", "stribeck"):
        x, s = found.value(name), found.value(name, "stderr")
        if found.lost(name) or name not in found.names:
            continue
        if -3 * s <= x and s > 0.5 * abs(x):
            doubts.add(
                f"{name} friction {x:.3g} +- {s:.2g} drowns in its error; record {_MORE[name]}, or leave this term out"
            )
    if left.rms > (1 - _POOR) * spread:
        doubts.add(
            f"the model explains little of u (fit {100 * (1 - left.rms / spread):.0f} %): a load, a spring, outliers "
            "or another machine's friction are in it; look at q and u, and do not use these numbers yet"
        )
    if "gravity_sin" not in found.names and np.ptp(table.q) > 0.2:
        missed = left.rms**2 * len(found.y)
        if with_gravity < 0.5 * missed and missed > 1e-4 * len(found.y) * spread**2:
            doubts.add(
                f"what is left of u goes with sin q and cos q ({100 * (1 - with_gravity / missed):.0f} % of it): "
                "gravity (or a spring) acts on this joint; add it, terms=(..., 'gravity'), or fit the arm with `fit`"
            )
    _late(doubts, found, period)
    if left.correlation > 0.9 and left.rms > _MISSING * spread:
        doubts.add(
            f"residuals are far from white (neighbours correlate by {left.correlation:.2f}): something is missing "
            "in the model (backlash, Stribeck friction, delay, a spring); standard errors were widened for it"
        )


_MORE = {
    "viscous": "several speeds that differ more",
    "coulomb": "slow motion to both sides beside fast one",
    "stribeck": "crawling motion to both sides",
}


def _left(found, extra):
    """Sum of squares that is left with more columns."""
    A = np.column_stack([found.A, extra])
    e = found.y - A @ np.linalg.lstsq(A, found.y, rcond=None)[0]
    return float(e @ e)


def _friction_told_apart(doubts, found):
    if found.lost("coulomb") and np.ptp(np.sign(found.table.direction)) == 0:
        doubts.add(
            "Coulomb friction: the joint turns to one side only, so that it is in the offset; record both directions"
        )
    elif found.lost("coulomb"):
        doubts.add("Coulomb friction: one speed only, it cannot be told from viscous friction; record several speeds")


def _unexplained(doubts, found, with_gravity):
    """A motion that has nothing to do with u, not even by way of gravity."""
    total = float(np.sum((found.y - found.y.mean()) ** 2))
    explained = 1 - min(with_gravity, found.left.rms**2 * len(found.y)) / total if total > 0 else 0.0
    independent = found.left.independent
    F = explained / 5 / max((1 - explained) / max(independent - 6, 1), 1e-300)
    if explained < _EXPLAINED or (F < _F and explained < 0.5):
        doubts.refuse(
            f"u does not belong to this motion: it explains {100 * max(explained, 0):.1f} % of the variance of u "
            f"(F = {F:.1f}, needed {_F:.0f}). Are q and u of the same joint and the same clock? Does a spring "
            "dominate? Else excite more"
        )
    elif F < _F:
        doubts.add(
            f"only {independent:.0f} independent samples are in this record (F = {F:.1f}, {_F:.0f} would do): "
            "record longer, with more reversals"
        )


def _signs(doubts, found):
    b, c = found.value("viscous"), found.value("coulomb")
    sb, sc = found.value("viscous", "stderr"), found.value("coulomb", "stderr")
    if b < -3 * sb and c < -3 * sc:
        doubts.refuse(
            f"viscous and Coulomb friction come out negative ({b:.3g} +- {sb:.2g}, {c:.3g} +- {sc:.2g}): is the sign "
            "of u or q turned round?"
        )
    if b < -3 * sb:
        doubts.add(
            f"viscous friction is negative, {b:.3g} +- {sb:.2g}: no brake gives energy. At crawling speed friction "
            "falls with speed (Stribeck): record faster motion too. Or u acts later than recorded (give delay=)"
        )
    if c < -3 * sc:
        doubts.add(
            f"Coulomb friction is negative, {c:.3g} +- {sc:.2g}: no brake gives energy. Is u late, or something else "
            "missing in the model?"
        )


def _inertia(doubts, found, band, period):
    if "inertia" not in found.names:
        return
    J, b = found.value("inertia"), found.value("viscous")
    sJ = found.value("inertia", "stderr")
    if found.lost("inertia"):
        doubts.add(
            "inertia: the acceleration is noise or nothing here, so no inertia is given; record faster reversals, or "
            "a finer angle"
        )
    elif J < 0:
        doubts.add(
            f"inertia {J:.3g} +- {sJ:.2g} is negative, as a wrong timing or a wrong sign of u makes it, and was left "
            "out: record faster reversals, and check when u and q are read (delay=)"
        )
    elif sJ > 0.5 * J:
        doubts.add(f"inertia {J:.3g} +- {sJ:.2g}: this motion hardly shows it; record faster reversals")
    elif band.acceleration_share > 0.03:
        doubts.add(
            f"inertia: about {100 * band.acceleration_share:.0f} % of the acceleration's power is noise of the angle, "
            "which pulls it towards zero by about as much; record faster motion, or give a lower cutoff_hz"
        )
    if 0 < J < b * period:
        doubts.add(
            f"the time constant {J / b:.3g} s is below the sampling period of {period:.3g} s: the record cannot show "
            "how the joint speeds up; sample five times in one time constant before trusting the inertia"
        )


def _late(doubts, found, period):
    """Whether u acts later than it was recorded, or was filtered."""
    if found.lost("inertia") or "inertia" not in found.names:
        return
    lag = found.beside(found.slope)  # a first-order low pass of u, as a negative delay: what went in is u + lag du/dt
    delay, sigma, rms = min(found.beside_delay[2:], lag[2:], key=lambda one: one[2])
    if rms < 0.9 * found.left.rms and abs(delay) > 5 * sigma and abs(delay) > 0.3 * period:
        doubts.add(
            f"u seems to act about {delay:.2g} s after it was recorded, which makes the inertia too large by "
            "viscous times that: give delay="
            if delay > 0
            else f"q seems to be recorded about {-delay:.2g} s before u (or u is filtered), which makes the inertia "
            "too small by viscous times that: shift one of them"
        )
