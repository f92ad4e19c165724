"""One joint of any machine: inertia, friction, offset and gravity from a recording of it."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import recording_checks
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.identification.time_series import columns_of, quantum_of
from ir50p_lab.inputs import choice, number
from ir50p_lab.signals.low_pass import low_pass

TERMS = ("inertia", "viscous", "coulomb", "offset", "gravity")
_COLUMNS = ("offset", "gravity_sin", "gravity_cos", "viscous", "coulomb", "inertia")
_PHYSICAL = ("inertia", "viscous", "coulomb")
_SAID = {"viscous": "viscous friction", "coulomb": "Coulomb friction"}
_OWN_SHARE = 1e-3  # share of a column's length: if all but this is a combination of other columns, it is left out

# How the low pass is chosen, and which samples are used
_MOTION = 0.99  # share of the power of the speed: the frequency of the motion is that below which so much of it lies
_ABOVE = 5.0  # cut-off over the frequency of the motion, if noise allows it; a higher one shows a joint's flexibility
_NOISE = 1e-3  # power of noise over power of the acceleration: the cut-off is lowered until it is no more than this
_HIGHEST = 0.2  # largest cut-off over the sampling rate: beyond it, differences of samples are poor derivatives
# Power of a spectral line over quantum^2: if it is less, the steps of a coarse angle may have made the line. The
# strongest line of a saw-tooth as high as one quantum has 1/(2 pi^2) = 0.051.
_SAW = 0.06
_THIN = 4.0  # samples kept per period of the cut-off: more would only repeat them
_EDGE = 1.5  # periods of the cut-off left out at both ends of a run, where the filter has data on one side only
_SLOW = 0.1  # share of the rms speed: slower samples are left out unless slow= says otherwise
_DROWNED = 3.0  # rms speed over that of its noise: if it is less, the data are refused

# Which samples of u stand at a limit: so many deviations of its noise from the extreme, and no more of its range
_SCATTER, _NEAR_LIMIT = 7.0, 0.15

# How far the errors are widened
_UNSURE = 0.5  # sampling periods: standard deviation of the delay of u beyond delay=, before the data say more
_EXACT = 2e-3  # share of a parameter: its standard error is no less, for derivatives and interpolation are no better

# When the fit is refused (_EXPLAINED, _F), or a warning is given
_EXPLAINED = 0.02  # share of the variance of u: if the model explains less, u does not belong to this motion
_F = 8.0  # F value of the model: if it is less, the fit may be chance
_POOR = 0.5  # residual over spread of u: if it is more, the model does not hold, nor do its standard errors
_MISSING = 0.1, 0.9  # residual over spread of u, its correlation: if both are more, the model lacks something
_DEPENDS = 0.1, 2.0  # share of a parameter, standard errors: if half the cut-off moves it by more than both
_BENT = 0.3, 2.5  # share by which a term v |v| moves viscous friction, standard errors of that term: if both are more
_GRAVITY = 0.5, 0.01  # share of the residual that sin q, cos q explain, residual over spread of u: if both are more
# A delay of u is believed if it is more than so many standard errors from 0, and the fit with it leaves less than this
# share of the residual: (share, standard errors), either pair. A warning is given if it is longer than so many periods.
_LATE = (0.9, 5.0), (0.99, 8.0)
_TOLD = 0.75

_WIDENS = {  # fit with one effect more that may be there: the parameters whose errors it widens
    "late": _PHYSICAL,
    "spring": ("inertia",),
    "bent": ("viscous", "coulomb"),
    "dead zone": ("inertia", "viscous"),
    "gravity": (*_PHYSICAL, "offset"),
}


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """u = inertia qdd + viscous qd + coulomb sgn(qd) + offset [+ gravity_sin sin q + gravity_cos cos q].

    u is in its own unit (N m, A, PWM counts...). Each parameter has a standard error ..._stderr: inf if the data do not
    determine it (the value is then 0), nan if it was not asked for. rms: of the residual, in the unit of u; fit:
    100 (1 - |u - u_model|/|u - mean u|) %; cutoff_hz: of the low pass on q and u, inf for none; held: whether u was
    taken as held from its sample to the next; samples: how many the regression used; warnings: tuple of str.
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


def fit_joint(
    t, q=None, u=None, *, qd=None, terms=TERMS[:4], cutoff_hz=None, delay=0.0, held=None, slow=None, anyway=False
):
    """Fit inertia, viscous and Coulomb friction and offset of one joint to a recording of it    (2.48, one joint)

        u = inertia qdd + viscous qd + coulomb sgn(qd) + offset

    q, u and sgn(qd) pass through the same zero-phase low pass: the equation stays true, and only noise is lost. Its
    cut-off is five times the frequency of the motion, or lower if q is noisy; above it flexibility and backlash make a
    rigid model wrong. Samples of a joint at rest are left out (there u may be anything up to the breakaway friction).
    Standard errors hold for residuals that are correlated in time. They are widened by how far other fits of the same
    data move a parameter: with half the cut-off, twice the least speed, a u that acts half a period earlier or later, a
    flexible joint, friction that is not linear in the speed, a force that depends on q, a dead zone of the amplifier.

    Args:
        t: (n,) s, at any rate, with gaps if need be; or a recording of one joint (t, q, u); or a list of recordings or
            of tuples (t, q, u) or (t, q, u, qd): each is fitted and compared with the others, then all are fitted
            together. One that contradicts the others is named, and the errors are widened to cover what each says.
        q: (n,) rad; None for a wheel of which only qd was measured: its integral is taken. u: (n,), torque, current or
            command, any unit. Arrays, masked arrays, pandas Series.
        qd: (n,) rad/s, if it was measured, too: then q is not differentiated.
        terms: of "inertia", "viscous", "coulomb", "offset", "gravity".
        cutoff_hz: of the low pass; inf: none, the plain least squares of a friction sweep (with qd, without inertia).
        delay: s from a sample to the moment when its u acts.
        held: True: u is held from its sample to the next; False: it is a measurement at the instant; None: whichever
            explains the data better.
        slow: rad/s; slower samples are left out, by default those below a tenth of the rms speed.
        anyway: go on where the data are refused; the reason is then in `warnings`.

    Returns: JointFit.
    Raises: InputError for NaN, times that do not increase, shapes that do not fit. IdentificationError, saying what to
    do next, if the record is too short or constant, the motion is lost in noise or has nothing to do with u, q or u
    were clipped or surely hung, all large jumps of q or u have one size, or all friction is negative. Other flaws are
    in `warnings`, each with a number: a result without a warning is right within three standard errors.
    """
    terms = (terms,) if isinstance(terms, str) else tuple(terms)
    if not terms or not set(terms) <= set(TERMS):
        raise InputError(f"terms = {terms!r}: give some of {', '.join(TERMS)}")
    names = [name for name in _COLUMNS if name.split("_")[0] in terms]
    warned = recording_checks.Warnings(choice("anyway", anyway, (True, False)))
    recordings, runs = _recordings(t, q, u, qd), []
    for k, one in enumerate(recordings, 1):
        warned.who = f"recording {k}: " if len(recordings) > 1 else ""
        runs += _runs(warned, one, delay, k)
    warned.who = ""
    if len({run.angles.shape[1] for run in runs}) > 1:
        raise InputError("qd is in some of the recordings only: give it in all, or in none")
    unit = float(np.std(np.concatenate([run.u for run in runs])))  # for columns of a size, whatever u counts in
    if len(recordings) > 1:
        options = {"terms": terms, "cutoff_hz": cutoff_hz, "delay": delay, "held": held, "slow": slow, "anyway": anyway}
        least = {name: 0.0 if name in _PHYSICAL else 0.05 * unit for name in names}
        recording_checks.check_contradiction(warned, recordings, lambda one: fit_joint([one], **options), least)
    for run in runs:
        run.u = run.u / unit
    band = _band(runs)
    if cutoff_hz != math.inf and (band.speed < _DROWNED * band.speed_noise or band.speed == 0):
        said = f"not exciting: the joint moves at {band.speed:.2g} rad/s, noise alone {band.speed_noise:.2g} rad/s"
        warned.refuse(f"{said}; move faster")
    if cutoff_hz is None:
        cutoff_hz = min(_ABOVE * band.motion_hz, band.clean_hz)
    number("cutoff_hz", cutoff_hz, "> 0 or inf", unit="Hz")
    slow = _SLOW * band.speed if slow is None else number("slow", slow, ">= 0", unit="rad/s")
    pair = _fits(runs, names, cutoff_hz, band.clean_hz, slow)
    if not pair:
        fewest = recording_checks.FEWEST // 2
        raise IdentificationError(f"fewer than {fewest} independent samples are in motion: record more")
    measured = pair[1].left.rms < pair[0].left.rms if held is None else not choice("held", held, (True, False))
    found = pair[measured]
    lower = (_fits(runs, names, cutoff_hz / 2, band.clean_hz, slow) or pair)[measured]
    faster = (_fits(runs, names, cutoff_hz, band.clean_hz, 2 * slow) or pair)[measured]
    others = _others(found, lower)
    period = 1 / runs[0].rate
    stderr = _widened(names, found, {"lower": lower.left, "faster": faster.left, **others}, period)
    parameters = dict(zip(names, (unit * np.column_stack([found.left.x, stderr])).tolist(), strict=True))
    _check_fit(warned, found, others, "gravity" in terms, runs[0].angles.shape[1] == 2)
    recording_checks.check_clipped_drive(warned, found)
    _check_parameters(warned, parameters, found, lower, others)
    _check_timing(warned, lower, others, period)
    return JointFit(
        **{name: x for name, (x, _) in parameters.items()},
        **{f"{name}_stderr": sigma for name, (_, sigma) in parameters.items()},
        rms=unit * found.left.rms,
        fit=100 * (1 - found.misfit),
        cutoff_hz=float(cutoff_hz),
        held=not measured,
        samples=len(found.y),
        warnings=tuple(warned),
    )


def _recordings(t, q, u, qd):
    """The arguments of `fit_joint` as a list of tuples (t, q, u, qd) or shorter."""
    if isinstance(t, (list, tuple)) and len(t) and q is None and u is None:
        if qd is not None:
            raise InputError("qd= beside several recordings: give each as (t, q, u, qd)")
        return [one if isinstance(one, (list, tuple)) else (one,) for one in t]
    return [(t, q, u, qd)]


def _runs(warned, recording, delay, number):
    """Evenly sampled runs without a gap: rate, Hz; angles (n, 1 or 2): q, qd if given; u (n, 2): held, measured; of:
    the number of the recording.
    """
    t, q, u, qd = (*recording, None, None, None)[:4]
    wheel = q is None and qd is not None  # of which only the speed was measured: its integral will do
    if wheel:
        t, qd, u = columns_of(t, qd, u)
        q = np.cumsum(qd * np.gradient(t)[:, None], axis=0)
    if qd is not None:
        q, u = np.ma.column_stack([q, qd]), np.ma.column_stack([u, u])
    t, q, u = columns_of(t, q, u)
    if q.shape[1] != 1 + (qd is not None):
        raise InputError(f"q has {q.shape[1]} columns: fit_joint takes one joint; give q[:, i] and u[:, i]")
    new = recording_checks.check_signals(warned, t, q[:, 0], u[:, 0], math.inf if wheel else recording_checks.TURNS)
    if qd is not None:
        recording_checks.check_outliers(warned, "qd", t, q[:, 1])
        recording_checks.check_measured_speed(warned, t, *q.T)
    options = {"cutoff_hz": None, "trim": 0.0, "delay": delay}
    held, measured = (process(t[new], q[new], u[new], held=held, **options) for held in (True, False))
    edges = np.flatnonzero(np.diff(held.segment)) + 1
    drives = np.column_stack([held.u[:, 0], measured.u[:, 0]])
    pairs = zip(np.split(held.q, edges), np.split(drives, edges), strict=True)
    return [SimpleNamespace(rate=held.rate_hz, angles=angles, u=drive, of=number) for angles, drive in pairs]


def _band(runs):
    """Tell motion from noise in the spectrum of the angle (of qd, if measured) of the run that moves most.

    Noise is taken as white, as strong as it is between a quarter and half of the sampling rate. A line no higher than
    the highest one there is not motion: the steps of a coarse angle make such lines. Returns a namespace: motion_hz;
    clean_hz, the highest cut-off at which noise of the acceleration does no harm; speed, speed_noise: rms rad/s.
    """
    from scipy.signal import welch

    longest = max(runs, key=lambda run: len(run.u) * np.var(run.angles[:, -1]))
    x = longest.angles[:, -1]
    f, power = (column[1:] for column in welch(x, longest.rate, nperseg=min(len(x), max(256, len(x) // 6))))
    rest = power[f >= longest.rate / 4]
    floor = np.median(rest) / math.log(2)  # a spectral line of noise is chi-squared with 2 degrees of freedom
    above = np.where(power > max(3 * floor, rest.max(), _SAW * quantum_of(x) ** 2 / f[0]), power - floor, 0.0)
    to_speed = (2 * np.pi * f) ** 2 if longest.angles.shape[1] == 1 else np.ones_like(f)
    speed, speed_noise = np.cumsum(to_speed * above), np.cumsum(to_speed * floor)
    noise = np.cumsum(f**2 * to_speed * floor) <= _NOISE * np.cumsum(f**2 * to_speed * above)
    highest = int(np.searchsorted(f, _HIGHEST * longest.rate)) - 1
    motion = min(int(np.searchsorted(speed, _MOTION * speed[-1])), highest)
    clean = max(motion, int(np.flatnonzero(noise[: highest + 1]).max(initial=0)))
    speed, speed_noise = np.sqrt(np.array([speed[motion], speed_noise[motion]]) * f[0])
    return SimpleNamespace(motion_hz=f[motion], clean_hz=f[clean], speed=speed, speed_noise=speed_noise)


def _noise(x):
    """Standard deviation of white noise on a smooth x (n,), from its fourth differences."""
    return float(np.median(np.abs(np.diff(x, 4)))) / 0.6745 / math.sqrt(70)


def _smooth(x, cutoff_hz, rate):
    return x if math.isinf(cutoff_hz) else low_pass(x, cutoff_hz, rate, order=3, kind="zero-phase")


def _derivatives(run, cutoff_hz):
    """qd, qdd (n,) after the low pass, from five points: three would err by 1 % at 20 samples a period."""
    x = _smooth(run.angles[:, -1], cutoff_hz, run.rate)
    x = np.pad(x, 2, mode="reflect", reflect_type="odd")
    first = np.convolve(x, (-1, 8, 0, -8, 1), "valid") * run.rate / 12
    if run.angles.shape[1] == 2:
        return x[2:-2], first
    return first, np.convolve(x, (-1, 16, -30, 16, -1), "valid") * run.rate**2 / 12


def _table(runs, cutoff_hz, sign_hz, slow):
    """The signals of the regression, all after one low pass, at samples faster than slow (rad/s), as a namespace.

    columns (m, 6), in the order of _COLUMNS; u, slopes (m, 2): u held and measured, and its rate of change; limits
    (m, 2): low-passed, 1 where u is at its smallest, at its largest value, else 0; q, v (m,): angle, speed; snap (m,):
    d2(qdd)/dt2, which a flexible joint adds; of (m,): number of the recording. The sign of the speed is taken after a
    low pass at sign_hz: a smoother speed changes its sign too early or too late.
    """
    every = np.concatenate([run.u[:, 0] for run in runs])
    near = min(
        max(1e-3 * np.ptp(every), _SCATTER * _noise(np.concatenate([run.u[:, 1] for run in runs]))),
        _NEAR_LIMIT * np.ptp(every),
    )
    low, high = every.min() + near, every.max() - near
    names = ("columns", "u", "slopes", "limits", "q", "v", "snap", "of")
    parts = []
    for run in runs:
        n, edge = len(run.u), math.ceil(_EDGE * run.rate / cutoff_hz)
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
        parts.append([x[kept] for x in (columns, plain[:, 6:], slopes, plain[:, 4:6], q, v, snap, np.full(n, run.of))])
    joined = [np.concatenate(x) for x in zip(*parts, strict=True)] or [np.empty(0)] * len(names)
    return SimpleNamespace(cutoff_hz=cutoff_hz, **dict(zip(names, joined, strict=True)))


def _fits(runs, names, cutoff_hz, sign_hz, slow):
    """Fits of u held and of u measured, as namespaces; [] if too few samples move.

    Each has the fields of `_table`, and y, slope (m,): u and its rate of change; A (m, p): the columns `names`; left:
    LeastSquares; misfit: residual over spread of u.
    """
    table = _table(runs, cutoff_hz, sign_hz, slow)
    if len(table.q) < recording_checks.FEWEST // 2:
        return []
    A = table.columns[:, [_COLUMNS.index(name) for name in names]]
    fits = []
    for y, slope in zip(table.u.T, table.slopes.T, strict=True):
        left = least_squares(A, y, tolerance=_OWN_SHARE)
        misfit = left.rms / max(float(np.std(y)), 1e-300)
        fits.append(SimpleNamespace(**vars(table), A=A, y=y, slope=slope, left=left, misfit=misfit))
    return fits


def _others(found, lower):
    """{name: LeastSquares} of fits with one effect more that may be there, as last columns.

    lower: the fit at a lower cut-off, where noise of the acceleration hides a delay or a spring less.
    """
    more = {"late": (lower, lower.slope)}
    if len(lower.y) >= 6 * found.A.shape[1] + 12:
        more["spring"] = lower, lower.snap
        more["bent"] = found, found.v * np.abs(found.v)
        more["dead zone"] = found, np.sign(found.A @ found.left.x)
        more["gravity"] = found, found.columns[:, 1:3]
        for k in np.unique(found.of) if np.ptp(found.of) else ():
            more[f"alone {k}"] = found, (found.of != k)[:, None] * found.A
    return {
        name: least_squares(np.column_stack([one.A, columns]), one.y, tolerance=_OWN_SHARE)
        for name, (one, columns) in more.items()
    }


def _widened(names, found, others, period):
    """Standard errors (p,), widened by how far other fits of the same data lie away, beyond their own error."""
    x, stderr = found.left.x, found.left.stderr
    moved = np.zeros(len(x))  # squared
    for name, other in others.items():
        sigma = other.stderr[: len(x)]
        known = np.isfinite(stderr + sigma) & np.isin(names, _WIDENS.get(name, names))
        moved = np.maximum(moved, np.where(known, (x - other.x[: len(x)]) ** 2 - np.where(known, sigma, 0.0) ** 2, 0.0))
    late, unsure = others["late"], _UNSURE * period
    share = unsure**2 / (unsure**2 + late.stderr[-1] ** 2)  # how much of the delay the data tell, 0..1
    delay = math.hypot(share * late.x[-1], unsure * math.sqrt(1 - share))
    moved += (delay * least_squares(found.A, found.slope, tolerance=_OWN_SHARE).x) ** 2
    return np.sqrt(stderr**2 + moved + (_EXACT * x) ** 2)


def _check_fit(warned, found, others, with_gravity, with_speed):
    """Refuse, or warn of, what the residual shows."""
    left, gravity = found.left, others.get("gravity", found.left).rms / found.left.rms
    explained = 1 - (found.misfit * gravity) ** 2
    F = explained / 5 / max((1 - explained) / max(left.independent - 6, 1), 1e-300)
    if found.misfit > _POOR and (sentence := recording_checks.without_sign(found, with_speed)):
        warned.refuse(sentence)
    elif explained < _EXPLAINED or (F < _F and explained < 0.5):
        share = f"{max(explained, 0):.1%} of it (F = {F:.1f}, needed {_F:.0f}; too few independent samples?)"
        warned.refuse(f"u does not belong to this motion, which explains {share}: another joint or clock? A spring?")
    elif F < _F:
        warned.add(f"only {left.independent:.0f} independent samples: record longer, with more reversals")
    if found.misfit > _POOR:
        warned.add(f"the model explains little of u (fit {1 - found.misfit:.0%}): do not use it; look at q, u and load")
    if not with_gravity and 1 - gravity**2 > _GRAVITY[0] and found.misfit > _GRAVITY[1]:
        warned.add(f"sin q, cos q explain {1 - gravity**2:.0%} of the residual: add terms=(..., 'gravity')")
    if found.misfit > _MISSING[0] and left.correlation > _MISSING[1]:
        warned.add(f"residuals are far from white ({left.correlation:.2f}): something is missing (backlash, a spring)")


def _check_parameters(warned, parameters, found, lower, others):
    """Warn of parameters that are negative, smaller than twice their error, or depend on the cut-off."""
    negative = [name for name, (x, sigma) in parameters.items() if name in _PHYSICAL and x < -3 * sigma]
    if {"viscous", "coulomb"} <= set(negative):
        warned.refuse("viscous and Coulomb friction come out negative: is the sign of u or q reversed?")
    if "viscous" in parameters and "bent" in others:
        bent, k = others["bent"], list(parameters).index("viscous")
        much = abs(bent.x[k] - found.left.x[k]) > _BENT[0] * abs(found.left.x[k])
        if much and abs(bent.x[-1]) > _BENT[1] * bent.stderr[-1]:
            warned.add("friction depends on the speed, not in proportion (Stribeck?): fit slow and fast motion apart")
    x, sigma = found.left.x, np.hypot(found.left.stderr, lower.left.stderr)
    depends = np.abs(x - lower.left.x) > np.maximum(_DEPENDS[0] * np.abs(x), _DEPENDS[1] * sigma)
    for k, (name, (x, sigma)) in enumerate(parameters.items()):
        said, value = _SAID.get(name, name), f"({x:.3g} +- {sigma:.2g})"
        if math.isinf(sigma):
            warned.add(f"{said} cannot be told from these data: record several speeds to both sides, faster reversals")
        elif name in negative:
            warned.add(f"{said} is negative {value}: is u late or early (delay=), or its sign reversed?")
        elif name in _PHYSICAL and sigma > 0.5 * abs(x):
            warned.add(f"{said} is lost in its error {value}: record faster reversals, several speeds")
        elif name in _PHYSICAL and depends[k]:
            half = f"{x * lower.left.x[k] / found.left.x[k]:.3g} at half of {found.cutoff_hz:.3g} Hz"
            warned.add(f"{said} depends on the cut-off: {value}, {half} (flexibility, backlash?)")


def _check_timing(warned, lower, others, period):
    """Warn of a u that is late or early, or of a spring between motor and load, which looks the same."""
    late = others["late"]
    delay, left = float(late.x[-1]), late.rms / lower.left.rms
    if not any(left < share and abs(delay) > n * late.stderr[-1] for share, n in _LATE):
        return
    if others.get("spring", late).rms < late.rms:
        warned.add("inertia depends on the frequency, as in a flexible joint: try a lower cutoff_hz")
    elif abs(delay) > _TOLD * period:
        said = f"{abs(delay):.2g} s {'later' if delay > 0 else 'earlier'} than delay= says"
        warned.add(f"u seems to act about {said}: shift q or u by it (backlash or a filter looks the same)")
