"""One joint of any machine: inertia, friction, offset and gravity from a recording of it."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.checks import FEWEST, Warnings, check_signals
from ir50p_lab.identification.columns import columns_of
from ir50p_lab.identification.processing import central_derivatives, process
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.inputs import number
from ir50p_lab.signals.low_pass import low_pass

TERMS = ("inertia", "viscous", "coulomb", "offset", "gravity")
_NAMES = (*TERMS[:4], "gravity_sin", "gravity_cos")
_DEAD = 0.1  # of the rms speed, below which a joint may stick
_NOISE = 1e-3  # of the power of the acceleration, that noise may have below the cut-off
_MOTION = 0.99  # of the power of the speed, that the cut-off keeps whatever the noise
_EXPLAINED = 0.05  # least share of the variance of u that the motion explains


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """u = inertia qdd + viscous qd + coulomb sgn(qd) + offset [+ gravity_sin sin q + gravity_cos cos q].

    Each in the unit of u and SI, with a standard error ..._stderr (inf: the data do not hold it; nan: not asked for);
    rms of the residual; fit: 100 (1 - |u - u_model|/|u - mean u|) %; cutoff_hz of the low pass; samples; warnings.
    """

    inertia: float = 0.0
    viscous: float = 0.0
    coulomb: float = 0.0
    offset: float = 0.0
    gravity_sin: float = 0.0
    gravity_cos: float = 0.0
    inertia_stderr: float = math.nan
    viscous_stderr: float = math.nan
    coulomb_stderr: float = math.nan
    offset_stderr: float = math.nan
    gravity_sin_stderr: float = math.nan
    gravity_cos_stderr: float = math.nan
    rms: float
    fit: float
    cutoff_hz: float
    samples: int
    warnings: tuple


def fit_joint(t, q=None, u=None, *, terms=TERMS[:4], cutoff_hz=None, delay=0.0):
    """Inertia, viscous and Coulomb friction and offset of one joint from a recording of it    (2.48, one joint)

    q, u and sgn(qd) pass the same zero-phase low pass: the equation stays true. Samples of a joint that stands are left
    out. The cut-off keeps the motion and leaves the noise; a fit at half of it is compared and widens the errors.

    Args: t (n,) s; q (n,) rad; u (n,) any unit; or a recording of one joint. terms: of TERMS. delay: s until u acts.
    Returns: JointFit. Raises: InputError for NaN, times that do not increase, shapes; IdentificationError for a record
    that is too short, constant, or a u that has nothing to do with the motion.
    """
    if not set(terms) <= set(TERMS):
        raise InputError(f"terms = {terms!r}: give some of {', '.join(TERMS)}")
    t, q, u = columns_of(t, q, u)
    if q.shape[1] != 1:
        raise InputError(f"q has {q.shape[1]} columns: fit_joint takes one joint; give q[:, i] and u[:, i]")
    check_signals(notes := Warnings(), t, q[:, 0], u[:, 0])
    motions = [process(t, q, u, cutoff_hz=None, trim=0.0, delay=delay, held=held) for held in (True, False)]
    rate = motions[0].rate_hz
    if cutoff_hz is not None and number("cutoff_hz", cutoff_hz, "> 0", unit="Hz") >= rate / 2:
        raise InputError(f"cutoff_hz = {cutoff_hz!r}: give a number between 0 and half the rate, {rate / 2:.4g} Hz")
    cutoff = cutoff_hz or _cutoff(motions[0])
    fits = list(_at_halves(motions, cutoff, terms))
    names, found, y, table, cutoff = fits[0]
    error, notes_here = _compared(names, found, fits[1][1]) if len(fits) > 1 else (found.stderr, [])
    if (
        notes_here
        and cutoff_hz is None
        and len(fits) > 2
        and not (later := _compared(names, fits[1][1], fits[2][1]))[1]
    ):
        names, found, y, table, cutoff = fits[1]
        error, notes_here = later
    notes += notes_here
    others = _others(table, [_NAMES.index(name) for name in names])
    for other in others.values():
        error = _widened(error, found, other)
    spread = float(np.std(y))
    if found.rms**2 > (1 - _EXPLAINED) * spread**2:
        raise IdentificationError("u does not belong to this motion, which explains nothing of it: another joint?")
    values = dict(zip(names, zip(found.x.tolist(), error.tolist(), strict=True), strict=True))
    if max(values.get(name, (0, 0))[0] + 3 * values.get(name, (0, 0))[1] for name in TERMS[1:3]) < 0:
        raise IdentificationError("viscous and Coulomb friction come out negative: is the sign of u or q turned round?")
    notes += _doubts(values, found, y, others, 1 / rate)
    return JointFit(
        **{name: x for name, (x, _) in values.items()},
        **{f"{name}_stderr": sigma for name, (_, sigma) in values.items()},
        rms=found.rms,
        fit=100 * (1 - found.rms / spread),
        cutoff_hz=float(cutoff),
        samples=len(y),
        warnings=tuple(notes),
    )


def _cutoff(motion):
    """The highest cut-off, Hz, whose acceleration noise leaves, but at least the one that keeps the motion."""
    from scipy.signal import welch

    pieces = [motion.q[motion.segment == k, 0] for k in np.unique(motion.segment)]
    longest = max(pieces, key=len)
    f, power = (
        x[1:]
        for x in welch(
            longest, motion.rate_hz, nperseg=min(len(longest), max(256, len(longest) // 6)), detrend="linear"
        )
    )
    rest = power[f > motion.rate_hz / 4]  # noise; its highest are the lines of a coarse encoder
    floor = np.median(rest) / math.log(2)
    above = np.where(power > max(3 * floor, rest.max()), power - floor, 0.0)
    if np.sum(f**2 * above) < 0.1 * np.sum(f[: len(f) // 8] ** 2) * floor:
        raise IdentificationError("not exciting: the motion drowns in the noise of the angle; move faster")
    speed, acceleration, noise = (np.cumsum(x) for x in (f**2 * above, f**4 * above, f**4 * floor))
    highest = int(np.searchsorted(f, 0.2 * motion.rate_hz))
    clean = np.flatnonzero(noise[:highest] <= _NOISE * acceleration[:highest])
    at = max(int(clean[-1]) if len(clean) else 0, int(np.searchsorted(speed, _MOTION * speed[-1])))
    return float(f[min(at, highest - 1)])


def _at_halves(motions, cutoff_hz, terms):
    """The better of the fits of u held and u measured, at this cut-off, at half of it and a quarter, while data last."""
    for part in (1, 2, 4):
        try:
            fits = [_fitted(one, cutoff_hz / part, terms) for one in motions]
        except IdentificationError:
            if part == 1:
                raise
            return
        yield *min(fits, key=lambda one: one[1].rms), cutoff_hz / part


def _compared(names, found, lower):
    """Errors widened by what the fit at a lower cut-off says, and a sentence for each parameter that differs."""
    known = np.isfinite(found.stderr + lower.stderr)
    moved = np.where(known, np.abs(found.x - lower.x), 0.0)
    far = moved > np.maximum(2 * np.hypot(found.stderr, np.where(known, lower.stderr, 0.0)), 0.1 * np.abs(found.x))
    notes = [
        f"{name} depends on the cut-off (flexibility, backlash?)" for name, bad in zip(names, far, strict=True) if bad
    ]
    return _widened(found.stderr, found, lower), notes


def _widened(error, found, other):
    """Errors widened by how much further another fit of the same data lies than its own error."""
    n = len(found.x)
    known = np.isfinite(error + other.stderr[:n])
    beyond = (found.x - other.x[:n]) ** 2 - np.where(known, other.stderr[:n], 0.0) ** 2
    return np.sqrt(error**2 + np.where(known, np.clip(beyond, 0.0, None), 0.0))


def _others(table, use):
    """Fits with one thing more: u late, a spring between motor and load, friction bent, a force of the position."""
    more = {"late": table[:, 7], "spring": table[:, 8], "bent": table[:, 1] * np.abs(table[:, 1])}
    more |= {} if 4 in use else {"gravity": table[:, 4:6]}
    return {k: least_squares(np.column_stack([table[:, use], x]), table[:, 6], tolerance=1e-3) for k, x in more.items()}


def _fitted(motion, cutoff_hz, terms):
    """Names, LeastSquares, y (m,) and columns q, sin q, cos q (m, 3) of a fit behind this low pass."""
    rate, parts = motion.rate_hz, []
    edge, slow = math.ceil(rate / cutoff_hz / 2), None
    for k in np.unique(motion.segment):
        here = motion.segment == k
        if here.sum() < 2 * edge + 20:
            continue
        q, qd, qdd = (x[:, 0] for x in central_derivatives(motion.q[here], rate, cutoff_hz=cutoff_hz, order=3))
        slow = _DEAD * np.sqrt(np.mean(qd**2)) if slow is None else slow
        plain = np.column_stack([np.sign(qd), np.sin(q), np.cos(q), motion.u[here, 0], np.abs(qd) > slow])
        sign, sin, cos, u, moving = low_pass(plain, cutoff_hz, rate, order=3, kind="zero-phase").T
        late = np.gradient(u) * rate
        spring = np.gradient(late) * rate
        table = np.column_stack([qdd, qd, sign, np.ones_like(q), sin, cos, u, late, spring, moving])[edge:-edge]
        parts.append(table[table[:, -1] > 0.9])
    if sum(map(len, parts)) < FEWEST:
        raise IdentificationError("too few samples in motion: move faster, or record longer")
    table = np.concatenate(parts)
    use = [k for k, name in enumerate(_NAMES) if name.split("_")[0] in terms]
    y = table[:, 6]
    return [_NAMES[k] for k in use], least_squares(table[:, use], y, tolerance=1e-3), y, table


def _doubts(values, found, y, others, period):
    """Sentences about a fit that is not refused."""
    for name, (x, sigma) in values.items():
        if not math.isfinite(sigma):
            yield f"{name} cannot be told from these data: record faster reversals, several speeds, both directions"
        elif name in TERMS[:3] and x < 2 * sigma:
            said = "is negative: is u late (delay=), or its sign turned round?" if x < -2 * sigma else "may be nothing"
            yield f"{name.replace('coulomb', 'Coulomb')} ({x:.3g} +- {sigma:.2g}) {said}"
    if found.rms > 0.5 * np.std(y):
        yield f"the model explains little of u (fit {1 - found.rms / np.std(y):.0%}): do not use it"
    if found.correlation > 0.9 and found.rms > 0.1 * np.std(y):
        yield f"residuals are far from white ({found.correlation:.2f}): something is missing (backlash, a spring)"
    late, bent, beside = others["late"], others["bent"], others.get("gravity", found)
    if abs(late.x[-1]) > max(4 * late.stderr[-1], 0.25 * period) and late.rms < 0.95 * found.rms:
        yield f"u seems to act {late.x[-1]:.2g} s later than delay= says: add it there (backlash looks alike)"
    if abs(bent.x[-1]) > 4 * bent.stderr[-1] and bent.rms < 0.95 * found.rms:
        yield "friction is no straight line in the speed (Stribeck?): fit slow and fast motion apart"
    if beside.rms**2 < 0.5 * found.rms**2 and found.rms > 0.01 * np.std(y):
        yield "much of the rest of u goes with sin q, cos q: add terms=(..., 'gravity')"
