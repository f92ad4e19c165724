"""One joint of any machine: inertia, friction, offset and gravity from a recording of it."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import checks
from ir50p_lab.identification.columns import columns_of
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.inputs import choice, number
from ir50p_lab.signals.low_pass import low_pass

TERMS = ("inertia", "viscous", "coulomb", "offset", "gravity")
_COLUMNS = ("offset", "gravity_sin", "gravity_cos", "viscous", "coulomb", "inertia")
_PHYSICAL = ("inertia", "viscous", "coulomb")
_OWN_SHARE = 1e-3  # share of a column's length: if less of it sticks out of the columns before, it is left out
_MOTION = 0.99  # share of the power of the speed, which is below the frequency called that of the motion
_ABOVE = 5.0  # times the frequency of the motion: the cut-off, if noise allows it
_NOISE = 1e-3  # power of noise over power of the acceleration: if it exceeds this, the cut-off comes down
_HIGHEST = 0.2  # cut-off over sampling rate: above, differences of samples are no derivatives any more
_THIN = 4.0  # samples kept per period of the cut-off: more would say the same again
_SLOW = 0.1  # of the rms speed: default of slow=
_DROWNED = 3.0  # rms speed over its noise: below, the data are refused
_UNSURE = 0.5  # sampling periods by which u may act earlier or later than assumed: less is no warning
_EXACT = 2e-3  # of a parameter: least standard error, for differences and interpolation are no better
_DEGREE = 6  # of the polynomial that stands for any force of the position
_EXPLAINED = 0.02  # share of the variance of u: if the model explains less, u has nothing to do with the motion
_F = 8.0  # F value of the model: if it stays below, chance may have made the fit
_LATE = (0.9, 5.0), (0.99, 8.0)  # share of the residual left by a delay, and delay over its error, to be told
_SAID = {"viscous": "viscous friction", "coulomb": "Coulomb friction"}
_WIDENS = {  # a fit with this one thing more: the parameters whose errors it widens
    "spring": ("inertia",),
    "bent": ("viscous", "coulomb"),
    "dead zone": ("inertia", "viscous"),
    "position": _PHYSICAL,
    "gravity": (*_PHYSICAL, "offset"),
}


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """u = inertia qdd + viscous qd + coulomb sgn(qd) + offset [+ gravity_sin sin q + gravity_cos cos q].

    u in its own unit (N m, A, PWM counts...). Each parameter has a standard error ..._stderr, inf where the data do not
    hold it (the value is then 0), nan where it was not asked for. rms: of the residual, unit of u; fit:
    100 (1 - |u - u_model|/|u - mean u|) %; cutoff_hz: of the low pass on q and u, inf for none; held: whether u was
    taken as held from its sample to the next; samples: used in the regression; warnings: tuple of str.
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
    held: bool
    samples: int
    warnings: tuple


def fit_joint(t, q=None, u=None, *, qd=None, terms=TERMS[:4], cutoff_hz=None, delay=0.0, slow=None, anyway=False):
    """Inertia, viscous and Coulomb friction and offset of one joint from a recording of it    (2.48, one joint)"""
    terms = (terms,) if isinstance(terms, str) else tuple(terms)
    if not terms or not set(terms) <= set(TERMS):
        raise InputError(f"terms = {terms!r}: give some of {', '.join(TERMS)}")
    names = [name for name in _COLUMNS if name.split("_")[0] in terms]
    warned = checks.Warnings(choice("anyway", anyway, (True, False)))
    recordings = _recordings(t, q, u, qd)
    if len(recordings) > 1:
        options = {"terms": terms, "cutoff_hz": cutoff_hz, "delay": delay, "slow": slow, "anyway": anyway}
        checks.check_contradiction(warned, recordings, lambda one: fit_joint([one], **options), _PHYSICAL)
    runs = []
    for k, one in enumerate(recordings, 1):
        warned.who = f"recording {k}: " if len(recordings) > 1 else ""
        runs += _runs(warned, one, delay)
    warned.who, period = "", 1 / runs[0].rate
    band = _band(runs)
    if cutoff_hz is not None and 0.5 / period <= number("cutoff_hz", cutoff_hz, "> 0 or inf", unit="Hz") < math.inf:
        raise InputError(f"cutoff_hz = {cutoff_hz!r}: give a number between 0 and half the rate, {0.5 / period:.4g} Hz")
    if band.speed < _DROWNED * band.speed_noise or band.speed == 0:
        noise = f"noise alone {band.speed_noise:.2g} rad/s"
        warned.refuse(f"not exciting: the joint moves at {band.speed:.2g} rad/s, {noise}; move faster")
    cutoff_hz = cutoff_hz or max(band.motion_hz, min(_ABOVE * band.motion_hz, band.clean_hz))
    slow = _SLOW * band.speed if slow is None else number("slow", slow, ">= 0", unit="rad/s")
    table = _table(runs, cutoff_hz, band.clean_hz, slow)
    if (m := len(table.q)) < checks.FEWEST // 2:
        raise IdentificationError(f"only {m} of {checks.FEWEST // 2} independent samples are in motion: record more")
    found = min((_fit(table, names, held) for held in (True, False)), key=lambda one: one.left.rms)
    tables = {"lower": _table(runs, cutoff_hz / 2, band.clean_hz, slow)} if cutoff_hz < math.inf else {}
    tables["faster"] = _table(runs, cutoff_hz, band.clean_hz, 2 * slow)
    same = {
        name: _fit(other, names, found.held)
        for name, other in tables.items()
        if len(other.q) >= max(checks.FEWEST // 2, 0.5 * m * (other.cutoff_hz / cutoff_hz if name == "lower" else 1))
    }
    others = _others(found, same.get("lower", found))
    if max(run.levels for run in runs) > checks.LEVELS:
        checks.check_clipped_drive(warned, found)
    stderr = _widened(found, same, others, period)
    _check_model(warned, found, stderr, others, period)
    _check_lower(warned, found, same)
    return JointFit(
        **{name: float(x) for name, x in zip(names, found.left.x, strict=True)},
        **{f"{name}_stderr": float(sigma) for name, sigma in zip(names, stderr, strict=True)},
        rms=found.left.rms,
        fit=100 * (1 - found.misfit),
        cutoff_hz=float(cutoff_hz),
        held=found.held,
        samples=m,
        warnings=tuple(warned),
    )


def _recordings(t, q, u, qd):
    """What `fit_joint` was given as a list of tuples (t, q, u, qd) or shorter."""
    if isinstance(t, (list, tuple)) and len(t) and q is None and u is None:
        if qd is not None:
            raise InputError("qd= beside several recordings: give each as (t, q, u, qd)")
        return [one if isinstance(one, (list, tuple)) else (one,) for one in t]
    return [(t, q, u, qd)]


def _runs(warned, recording, delay):
    """Evenly sampled runs without a gap: rate Hz; angles (n, 1 or 2): q and qd if measured; u (n, 2): held, measured."""
    t, q, u, qd = (*recording, None, None, None)[:4]
    if qd is not None:
        q, u = np.ma.column_stack([q, qd]), np.ma.column_stack([u, u])
    t, q, u = columns_of(t, q, u)
    if q.shape[1] != 1 + (qd is not None):
        raise InputError(f"q has {q.shape[1]} columns: fit_joint takes one joint; give q[:, i] and u[:, i]")
    new = checks.check_signals(warned, t, q[:, 0], u[:, 0])
    if qd is not None:
        checks.check_measured_speed(warned, t, *q.T)
    options = {"cutoff_hz": None, "trim": 0.0, "delay": delay}
    held, measured = (process(t[new], q[new], u[new], held=held, **options) for held in (True, False))
    edges = np.flatnonzero(np.diff(held.segment)) + 1
    drives = np.column_stack([held.u[:, 0], measured.u[:, 0]])
    pairs = zip(np.split(held.q, edges), np.split(drives, edges), strict=True)
    levels = len(np.unique(u[:, 0]))
    return [SimpleNamespace(rate=held.rate_hz, angles=angles, u=drive, levels=levels) for angles, drive in pairs]


def _band(runs):
    """What the spectrum of the angle (of qd, if measured) holds: motion below some frequency, noise above another.

    White noise is what it holds between a quarter and half of the rate; what nowhere rises above the highest line there
    (steps of a coarse angle make such lines) is no motion. Returns a namespace: motion_hz; clean_hz, up to which noise
    of the acceleration does no harm; speed, speed_noise: rms rad/s.
    """
    from scipy.signal import welch

    longest = max(runs, key=lambda run: len(run.u))
    pieces = [run.angles for run in runs if abs(run.rate / longest.rate - 1) < 0.01]
    length = min(len(longest.u), max(256, sum(map(len, pieces)) // 6))
    pieces = [x for x in pieces if len(x) >= length]
    spectra = [welch(x[:, -1], longest.rate, nperseg=length, detrend="linear") for x in pieces]
    power = np.average([density for _, density in spectra], axis=0, weights=[len(x) for x in pieces])[1:]
    f = spectra[0][0][1:]
    rest = power[f >= longest.rate / 4]
    floor = np.median(rest) / math.log(2)  # a spectral line of noise is chi-squared with 2 degrees of freedom
    above = np.where(power > max(3 * floor, rest.max()), power - floor, 0.0)
    to_speed = (2 * np.pi * f) ** 2 if pieces[0].shape[1] == 1 else np.ones_like(f)
    speed, speed_noise = np.cumsum(to_speed * above), np.cumsum(to_speed * floor)
    noise = np.cumsum(f**2 * to_speed * floor) <= _NOISE * np.cumsum(f**2 * to_speed * above)
    highest = int(np.searchsorted(f, _HIGHEST * longest.rate)) - 1
    motion = min(int(np.searchsorted(speed, _MOTION * speed[-1])), highest)
    clean = max(motion, int(np.flatnonzero(noise[: highest + 1]).max(initial=0)))
    return SimpleNamespace(
        motion_hz=float(f[motion]),
        clean_hz=float(f[clean]),
        speed=math.sqrt(speed[motion] * f[0]),
        speed_noise=math.sqrt(speed_noise[motion] * f[0]),
    )


def _smooth(x, cutoff_hz, rate):
    return x if math.isinf(cutoff_hz) else low_pass(x, cutoff_hz, rate, order=3, kind="zero-phase")


def _derivatives(run, cutoff_hz):
    """qd, qdd (n,) behind the low pass, from five points: at 20 samples a period three are 1 % wrong."""
    x = _smooth(run.angles[:, -1], cutoff_hz, run.rate)
    x = np.pad(x, 2, mode="reflect", reflect_type="odd")
    first = np.convolve(x, (-1, 8, 0, -8, 1), "valid") * run.rate / 12
    if run.angles.shape[1] == 2:
        return x[2:-2], first
    return first, np.convolve(x, (-1, 16, -30, 16, -1), "valid") * run.rate**2 / 12


def _table(runs, cutoff_hz, sign_hz, slow):
    """What goes into the regression, all behind one low pass, of samples that move faster than slow (rad/s).

    columns (m, 6), in the order of _COLUMNS; u, slopes (m, 2): u held and measured, and its rate of change; limits
    (m, 2): share of a sample's surroundings in which u has its smallest, its largest value; q, v, snap (m,): angle,
    speed, d2(qdd)/dt2. The sign of the speed is that behind sign_hz: a smoother speed turns too early or late.
    """
    every = np.concatenate([run.u[:, 0] for run in runs])
    low, high = every.min() + 1e-3 * np.ptp(every), every.max() - 1e-3 * np.ptp(every)
    names = ("columns", "u", "slopes", "limits", "q", "v", "snap")
    parts = []
    for run in runs:
        n, edge = len(run.u), math.ceil(run.rate / cutoff_hz / 2)
        if n < 2 * edge + 20:  # too short for the filter
            continue
        v, a = _derivatives(run, cutoff_hz)
        turn = np.sign(_derivatives(run, max(sign_hz, cutoff_hz))[0])
        q, u = run.angles[:, 0], run.u[:, 0]
        plain = np.column_stack([turn, np.sin(q), np.cos(q), np.abs(v) > slow, u < low, u > high, run.u])
        plain = _smooth(plain, cutoff_hz, run.rate)
        slopes, snap = np.gradient(plain[:, 6:], axis=0) * run.rate, np.gradient(np.gradient(a)) * run.rate**2
        columns = np.column_stack([np.ones(n), plain[:, 1:3], v, plain[:, 0], a])
        kept = np.arange(edge, n - edge, max(1, int(run.rate / cutoff_hz / _THIN)))
        kept = kept[plain[kept, 3] > 0.9]
        parts.append([x[kept] for x in (columns, plain[:, 6:], slopes, plain[:, 4:6], q, v, snap)])
    joined = [np.concatenate(x) for x in zip(*parts, strict=True)] or [np.empty(0)] * len(names)
    return SimpleNamespace(cutoff_hz=cutoff_hz, **dict(zip(names, joined, strict=True)))


@dataclass(frozen=True, eq=False)
class _Fit:
    """`left` (LeastSquares) of y (m,) on A (m, p), the columns `names` of a table; held: whether u is."""

    table: SimpleNamespace
    names: list
    held: bool
    A: np.ndarray
    y: np.ndarray
    left: object

    @property
    def slope(self):
        """du/dt (m,): what one second of delay adds to u."""
        return self.table.slopes[:, 0 if self.held else 1]

    @property
    def misfit(self):
        """Share of the amplitude of u that is left."""
        return self.left.rms / float(np.std(self.y))

    def beside(self, columns):
        """LeastSquares with more columns behind those of A."""
        return least_squares(np.column_stack([self.A, columns]), self.y, tolerance=_OWN_SHARE)


def _fit(table, names, held):
    A, y = table.columns[:, [_COLUMNS.index(name) for name in names]], table.u[:, 0 if held else 1]
    return _Fit(table, names, held, A, y, least_squares(A, y, tolerance=_OWN_SHARE))


def _others(found, lower):
    """{name: LeastSquares} of fits with one thing more that may be there.

    lower: the fit at a lower cut-off, where noise of the acceleration hides less of a delay or a spring.
    """
    table, v = found.table, found.table.v
    more = {"as it is": (lower, np.empty((len(lower.y), 0))), "late": (lower, lower.slope)}
    if len(lower.y) >= 6 * (len(found.names) + _DEGREE):
        place = 2 * (table.q - table.q.min()) / max(np.ptp(table.q), 1e-300) - 1
        more |= {
            "spring": (lower, lower.table.snap),
            "bent": (found, v * np.abs(v)),
            "dead zone": (found, np.sign(found.A @ found.left.x)),
            "position": (found, np.polynomial.legendre.legvander(place, _DEGREE)[:, 1:]),
            "gravity": (found, table.columns[:, 1:3]),
        }
    return {name: one.beside(columns) for name, (one, columns) in more.items()}


def _widened(found, same, others, period):
    """Standard errors (p,), widened by how much further other fits of the same data lie than their own error."""
    x, stderr = found.left.x, found.left.stderr
    moved = np.zeros(len(x))  # squared
    pairs = [(one.left, found.names) for one in same.values()]
    pairs += [(others[name], widens) for name, widens in _WIDENS.items() if name in others]
    for other, widens in pairs:
        sigma = other.stderr[: len(x)]
        known = np.isfinite(stderr + sigma) & np.isin(found.names, widens)
        moved = np.maximum(moved, np.where(known, (x - other.x[: len(x)]) ** 2 - np.where(known, sigma, 0.0) ** 2, 0.0))
    late, unsure = others["late"], _UNSURE * period
    share = unsure**2 / (unsure**2 + late.stderr[-1] ** 2)  # of what is not known of the delay, the data tell this much
    delay = math.hypot(share * late.x[-1], unsure * math.sqrt(1 - share))
    moved += (delay * least_squares(found.A, found.slope, tolerance=_OWN_SHARE).x) ** 2
    return np.sqrt(stderr**2 + moved + (_EXACT * x) ** 2)


def _check_lower(warned, found, same):
    if "lower" not in same:
        return
    lower = same["lower"].left
    for name, x, sigma, y, s2 in zip(found.names, found.left.x, found.left.stderr, lower.x, lower.stderr):
        if (
            name in _PHYSICAL
            and math.isfinite(sigma + s2)
            and abs(x - y) > max(2 * math.hypot(sigma, s2), 0.1 * abs(x))
        ):
            warned.add(
                f"{name} depends on the cut-off: {x:.4g} +- {sigma:.2g} at {found.table.cutoff_hz:.3g} Hz, {y:.4g} +- {s2:.2g} at half of it (flexibility, backlash?)"
            )


def _check_model(warned, found, stderr, others, period):
    """What the fit itself shows. noise: its share in the power of the acceleration; period: s, of sampling."""
    left = found.left
    with_gravity = min(others["gravity"].rms, left.rms) / left.rms if "gravity" in others else 1.0
    explained = 1 - (found.misfit * with_gravity) ** 2
    F = explained / 5 / max((1 - explained) / max(left.independent - 6, 1), 1e-300)
    if explained < _EXPLAINED or (F < _F and explained < 0.5):
        share = f"{max(explained, 0):.1%} of it (F = {F:.1f}, needed {_F:.0f}; too few independent samples?)"
        warned.refuse(f"u does not belong to this motion, which explains {share}: another joint or clock? A spring?")
    elif F < _F:
        warned.add(f"only {left.independent:.0f} independent samples: record longer, with more reversals")
    known = dict(zip(found.names, zip(left.x.tolist(), stderr.tolist(), strict=True), strict=True))
    negative = [name for name in _PHYSICAL if name in known and known[name][0] < -3 * known[name][1]]
    if {"viscous", "coulomb"} <= set(negative):
        warned.refuse("viscous and Coulomb friction come out negative: is the sign of u or q turned round?")
    for name, (x, sigma) in known.items():
        said = _SAID.get(name, name)
        if math.isinf(sigma):
            warned.add(f"{said} cannot be told from these data: record several speeds to both sides, faster reversals")
        elif name in negative:
            warned.add(f"{said} is negative ({x:.3g} +- {sigma:.2g}): is u late or early (delay=), or its sign turned?")
        elif name in _PHYSICAL and sigma > 0.5 * abs(x):
            warned.add(f"{said} drowns in its error ({x:.3g} +- {sigma:.2g}): record faster reversals, several speeds")
    if {"inertia", "viscous"} <= set(known) and 0 < known["inertia"][0] < known["viscous"][0] * period:
        warned.add(f"the time constant is below the sampling period of {period:.3g} s: sample faster")
    if (delay := _delay(others)) and "spring" in others and others["spring"].rms < others["late"].rms:
        warned.add("inertia depends on the frequency, as in a flexible joint: try a lower cutoff_hz")
    elif delay > _UNSURE * period:
        warned.add(f"u seems to act about {delay:.2g} s later than delay= says: add it there (backlash looks alike)")
    elif delay < -_UNSURE * period:
        warned.add(f"q seems to be recorded {-delay:.2g} s before u, or u is filtered: inertia is too small; shift one")
    if found.misfit > 0.5:
        warned.add(f"the model explains little of u (fit {1 - found.misfit:.0%}): do not use it; look at q, u and load")
    bent = others.get("bent")
    if bent and abs(bent.x[-1]) > 4 * bent.stderr[-1] and bent.rms < 0.95 * left.rms:
        warned.add("friction is no straight line in the speed (Stribeck?): fit slow and fast motion apart")
    if with_gravity**2 < 0.5 and "gravity_sin" not in known and found.misfit > 0.01:
        warned.add(f"{1 - with_gravity**2:.0%} of the rest of u go with sin q, cos q: add terms=(..., 'gravity')")
    if left.correlation > 0.9 and found.misfit > 0.1:
        warned.add(f"residuals are far from white ({left.correlation:.2f}): something is missing (backlash, a spring)")


def _delay(others):
    """How much later than assumed u acts, s, if that explains enough of what is left of u; else 0."""
    late, sigma = others["late"].x[-1], others["late"].stderr[-1]
    sure = any(others["late"].rms < share * others["as it is"].rms and abs(late) > n * sigma for share, n in _LATE)
    return float(late) if sure else 0.0
