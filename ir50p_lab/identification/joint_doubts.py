"""Whether the model of one joint fits its recording: each doubt with a number and what to do."""

import numpy as np

from ir50p_lab.identification.doubts import check_speed

_MOTION = 3.0  # least speed over that of the noise
_EXPLAINED = 0.02  # least share of the variance of u that the motion explains
_F = 8.0  # least F value of a motion that has to do with u
_POOR = 0.5  # fit: below, the standard errors hold for a model that does not
_MISSING = 0.1  # of the spread of u, that may be left and be alike over time
_MORE = {
    "viscous": "several speeds that differ more",
    "coulomb": "slow motion to both sides beside fast one",
    "stribeck": "crawling motion to both sides",
}


def check_motion(doubts, band):
    """A motion that is not faster than the noise of its own angle."""
    if band.speed < _MOTION * band.speed_noise or band.speed == 0:
        doubts.refuse(
            f"not exciting: the joint moves at {band.speed:.2g} rad/s rms where the noise of its angle alone looks "
            f"like {band.speed_noise:.2g} rad/s; move further or faster"
        )


def check_model(doubts, found, band, period):
    """All that the fit itself shows."""
    table, left, n = found.table, found.left, len(found.y)
    spread, missed = np.std(found.y), left.rms**2 * n
    check_speed(doubts, float(np.abs(table.v).max()))
    with_gravity = found.beside(table.columns[:, 1:3])[-1] ** 2 * n
    _check_explained(doubts, found, min(with_gravity, missed) / max(n * spread**2, 1e-300))
    _check_friction(doubts, found)
    _check_inertia(doubts, found, band, period)
    if left.rms > (1 - _POOR) * spread:
        doubts.add(
            f"the model explains little of u (fit {100 * (1 - left.rms / spread):.0f} %): a load, a spring, outliers "
            "or another machine's friction are in it; look at q and u, and do not use these numbers yet"
        )
    if "gravity_sin" not in found.names and np.ptp(table.q) > 0.2:
        if with_gravity < 0.5 * missed and missed > 1e-4 * n * spread**2:
            doubts.add(
                f"what is left of u goes with sin q and cos q ({100 * (1 - with_gravity / missed):.0f} % of it): "
                "gravity (or a spring) acts on this joint; add it, terms=(..., 'gravity'), or fit the arm with `fit`"
            )
    if left.correlation > 0.9 and left.rms > _MISSING * spread:
        doubts.add(
            f"residuals are far from white (neighbours correlate by {left.correlation:.2f}): something is missing "
            "in the model (backlash, Stribeck friction, delay, a spring); standard errors were widened for it"
        )


def _check_explained(doubts, found, unexplained):
    """A motion that has nothing to do with u, not even by way of gravity."""
    explained = 1 - unexplained
    F = explained / 5 / max(unexplained / max(found.left.independent - 6, 1), 1e-300)
    if explained < _EXPLAINED or (F < _F and explained < 0.5):
        doubts.refuse(
            f"u does not belong to this motion, which explains {100 * max(explained, 0):.1f} % of its variance (F = "
            f"{F:.1f}, needed {_F:.0f}). Are q and u of the same joint and clock? Is there a spring? Else excite more"
        )
    elif F < _F:
        doubts.add(
            f"only {found.left.independent:.0f} independent samples are in this record (F = {F:.1f}, {_F:.0f} would "
            "do): record longer, with more reversals"
        )


def _check_friction(doubts, found):
    """Friction that gives energy, drowns in its error, or cannot be told apart."""
    known = {name: found.value(name) for name in _MORE if name in found.names and not found.lost(name)}
    if found.lost("coulomb"):
        one_side = np.ptp(np.sign(found.table.direction)) == 0
        doubts.add(
            "Coulomb friction cannot be told from "
            + ("the offset: the joint turns to one side only" if one_side else "viscous friction: one speed only")
            + f"; record {_MORE['coulomb']}"
        )
    negative = [name for name, (x, stderr) in known.items() if x < -3 * stderr and name != "stribeck"]
    if {"viscous", "coulomb"} <= set(negative):
        doubts.refuse("viscous and Coulomb friction come out negative: is the sign of u or q turned round?")
    for name, (x, stderr) in known.items():
        said = f"{name.replace('coulomb', 'Coulomb')} friction {{}}{x:.3g} +- {stderr:.2g}{{}}; record {_MORE[name]}"
        if name in negative:
            doubts.add(said.format("is negative, ", ": no brake gives energy. Is u late (give delay=)?"))
        elif stderr > 0.5 * abs(x):
            doubts.add(said.format("", " drowns in its error") + ", or leave this term out")


def _check_inertia(doubts, found, band, period):
    """An inertia that is not there, is biased, or is mixed up with a delay of u."""
    if "inertia" not in found.names:
        return
    if found.lost("inertia"):
        doubts.add("inertia: the acceleration is noise or nothing here; record faster reversals, or a finer angle")
        return
    J, stderr = found.value("inertia")
    if J < 0:
        doubts.add(
            f"inertia {J:.3g} +- {stderr:.2g} is negative, as a wrong timing or a wrong sign of u makes it, and was "
            "left out: record faster reversals, and check when u and q are read (delay=)"
        )
    elif stderr > 0.5 * J:
        doubts.add(f"inertia {J:.3g} +- {stderr:.2g}: this motion hardly shows it; record faster reversals")
    elif band.acceleration_share > 0.03:
        doubts.add(
            f"inertia: about {100 * band.acceleration_share:.0f} % of the acceleration's power is noise, which pulls "
            "it towards zero by as much; record faster motion, or give a lower cutoff_hz"
        )
    b = found.value("viscous")[0]
    if 0 < J < b * period:
        doubts.add(
            f"the time constant {J / b:.3g} s is below the sampling period of {period:.3g} s: the record cannot show "
            "how the joint speeds up; sample five times in one time constant"
        )
    lag = found.beside(found.slope)  # a first-order low pass of u, as a negative delay: what went in is u + lag du/dt
    delay, sigma, rms = min(found.beside_delay[2:], lag[2:], key=lambda one: one[2])
    if rms < 0.9 * found.left.rms and abs(delay) > max(5 * sigma, 0.3 * period):
        doubts.add(
            f"u seems to act about {delay:.2g} s after it was recorded, which makes the inertia too large: give delay="
            if delay > 0
            else f"q seems to be recorded about {-delay:.2g} s before u (or u is filtered), which makes the inertia "
            "too small: shift one of them"
        )
