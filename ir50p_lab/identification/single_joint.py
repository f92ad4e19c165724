"""One joint of any machine: inertia, friction, offset and gravity from a recording of it."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from types import SimpleNamespace

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import checks
from ir50p_lab.identification.columns import columns_of, sampling_period
from ir50p_lab.identification.processing import acting_times, process
from ir50p_lab.identification.regression import LeastSquares, least_squares
from ir50p_lab.identification.response_fit import best_fit, by_name
from ir50p_lab.identification.spectrum import spectrum
from ir50p_lab.inputs import choice, number
from ir50p_lab.signals.low_pass import low_pass

TERMS = ("inertia", "viscous", "coulomb", "offset", "gravity", "stribeck")
_COLUMNS = ("offset", "gravity_sin", "gravity_cos", "viscous", "coulomb", "stribeck", "inertia")  # later ones go first
_OWN_SHARE = 1e-3  # of a column, that must stick out of those before it
_CLEARLY = 0.95  # of the residual of u held, below which u measured explains the data better
_ORDER = 3  # of the low passes, forward and again backward
_OWN = 4.0  # samples per cut-off period that are kept for the regression: more would say the same again
_DEAD = 0.1  # of the rms speed, below which a joint may stick and a filtered speed has lost its sign
_NOISY = 2e-3  # of the power of qd: more of its noise biases a fit that filters nothing
_ALL_NOISE = 0.3  # noise power over power of the acceleration from which on no inertia is given
_AGREE = 1.0  # standard errors of inertia and friction at a cut-off, by which half of it may move them
_FAR = 0.5  # of the inertia: as far from no lower cut-off that is sure of its own
_HUM = 0.5  # times the misfit: where a lower cut-off leaves less, what it takes away was no motion
_MATTERS = 0.1  # of the value: a change smaller than this is only put into the standard error
_COMPARED = ("inertia", "viscous", "coulomb")  # by these
_POLYNOMIAL = 6  # degree of a force of the position
_EXACT = 2e-3  # of a parameter: differences and interpolation are no better
_BETWEEN = 100  # periods put between two recordings that are fitted together
_PEAK = (0.02, 1.0)  # of the rms speed: where the Stribeck speed is looked for


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """u = inertia qdd + viscous qd + coulomb sgn(qd) + offset, per joint; u in its own unit (N m, A, PWM counts...).

    With the terms "gravity" and "stribeck" also

        + gravity_sin sin q + gravity_cos cos q + stribeck sgn(qd) exp(-(qd/stribeck_speed)^2)

    ======================= ==================================================== ================
    field                   meaning                                              unit
    ======================= ==================================================== ================
    inertia                                                                      u s^2/rad
    viscous                                                                      u s/rad
    coulomb, offset                                                              u
    gravity_sin, _cos       0 unless asked for                                   u
    stribeck                breakaway less Coulomb friction, 0 unless asked for  u
    stribeck_speed                                                               rad/s
    inertia_stderr ...      standard errors; inf: the data do not hold it, the   like the value
                            value is then 0; nan: not asked for
    rms                     of the residual                                      u
    fit                     100 (1 - |u - u_model|/|u - mean u|)                 %
    cutoff_hz               of the low pass on q and u; inf: none                Hz
    held                    as used                                              bool
    samples                 used in the regression
    warnings                tuple of str: what to mind about this fit
    ======================= ==================================================== ================
    """

    inertia: float = 0.0
    viscous: float = 0.0
    coulomb: float = 0.0
    offset: float = 0.0
    gravity_sin: float = 0.0
    gravity_cos: float = 0.0
    stribeck: float = 0.0
    stribeck_speed: float = math.nan
    inertia_stderr: float = math.nan
    viscous_stderr: float = math.nan
    coulomb_stderr: float = math.nan
    offset_stderr: float = math.nan
    gravity_sin_stderr: float = math.nan
    gravity_cos_stderr: float = math.nan
    stribeck_stderr: float = math.nan
    stribeck_speed_stderr: float = math.nan
    rms: float
    fit: float
    cutoff_hz: float
    held: bool
    samples: int
    warnings: tuple


def fit_joint(t, q=None, u=None, *, qd=None, terms=TERMS[:4], cutoff_hz=None, delay=0.0, held=None, anyway=False):
    """Inertia, viscous and Coulomb friction and offset of one joint from a recording of it    (2.48, one joint)

        u = inertia qdd + viscous qd + coulomb sgn(qd) + offset

    q and u pass the same zero-phase low pass, and so does sgn(qd): the equation stays true, only noise is lost.
    Samples of a joint that stands are left out (there u may be anything up to the breakaway friction). The cut-off is
    the highest that noise of q allows at which the parameters agree with those at half of it: above, flexibility and
    backlash make a rigid model wrong. Standard errors allow for residuals that are alike, and for what lower cut-offs,
    twice the least speed, any force of the position, friction that is no line in the speed, a flexible joint, a dead
    zone of the amplifier and half a period between q and u change, 0.3 of one if `held` is given (less, or more, where
    the data tell the delay). What a dead zone keeps of u counts as Coulomb friction.

    Args:
        t: (n,) s, at any rate, with gaps if need be; or a recording of one joint (t, q, u); or a list of recordings
            or of tuples (t, q, u), which are fitted together.
        q: (n,) rad. u: (n,), torque, current or command, any unit. Arrays, masked arrays, pandas Series.
        qd: (n,) rad/s, if it was measured too: then q is not differentiated.
        terms: of "inertia", "viscous", "coulomb", "offset", "gravity", "stribeck". Without inertia and with qd nothing
            needs a filter: ("viscous", "coulomb") is then the plain least squares of a friction sweep,
            unless qd is noisy.
        cutoff_hz: of the low pass; inf: none (with qd, without inertia).
        delay: s from a sample to the moment its u acts.
        held: True: u is held from its sample to the next; False: it is a measurement at the instant; None: held,
            unless the other explains the data clearly better.
        anyway: go on where the data are refused, and leave out what is no number; the reason is then in `warnings`.

    Returns: JointFit.
    Raises: InputError for NaN, times that do not increase, shapes that do not fit. IdentificationError, saying what to
    do next, if the record is too short or constant, the motion drowns in noise or has nothing to do with u, q or u were
    clipped or surely hung, angles jump by whole turns, or all friction is negative. Other flaws are in
    `warnings`, each with a number: what is without a warning is right within three standard errors.
    """
    names = _names_of(terms)
    warned = checks.Warnings(choice("anyway", anyway, (True, False)))
    held = held if held is None else choice("held", held, (True, False))
    t, q, u, v = _columns(t, q, u, qd, drop=anyway)
    new = checks.check_signals(warned, t, q, u)
    t, q, u, v = (x if x is None else x[new] for x in (t, q, u, v))
    if v is not None:
        checks.check_measured_speed(warned, t, q, v)
    plain = v is not None and "inertia" not in names and cutoff_hz in (None, math.inf)
    joint = _Joint.of(t, q, u, v, names, delay, None if plain else cutoff_hz)
    if plain and joint.band.unfiltered_noise**2 > _NOISY * np.mean(v**2):
        joint.band.unfiltered_noise = 0.0  # a table of speeds in any order looks like noise, but has no slow motion
        plain = cutoff_hz is not None or joint.fit(joint.band.cutoff_hz, fewest=joint.fit(math.inf)) is None
    found = joint.fit(math.inf if plain else joint.band.cutoff_hz, held is not False)
    if held is None and _is_measured([found, *joint.lower(found)]):
        found = joint.fit(found.cutoff_hz, False)
    checks.check_clipped_drive(warned, u, found)
    if not plain:
        checks.check_motion(warned, joint.band)
        found = found if cutoff_hz else joint.below_hum(found)
        found = _at_agreeing_cutoff(warned, joint, found, cutoff_hz is not None)
    fits = [found, *joint.lower(found)]
    found = _with_other_fits_in_errors(joint, found, fits, held is None)
    checks.check_model(warned, found, fits, joint.band, 1 / joint.rate, held is None)
    if found.value("inertia")[0] < 0:
        found = joint.fit(found.cutoff_hz, found.held, without="inertia")
    return JointFit(
        **by_name(found.names, found.x, found.stderr),
        rms=found.left.rms,
        fit=100 * (1 - found.misfit),
        cutoff_hz=found.cutoff_hz,
        held=found.held,
        samples=len(found.y),
        warnings=tuple(warned),
    )


def _columns(t, q=None, u=None, qd=None, *, drop=False):
    """t, q, u, qd (n,), qd None if not given; of several recordings one after the other, with gaps between."""
    if isinstance(t, (list, tuple)) and len(t) and q is None and u is None:
        if qd is not None:
            raise InputError("qd= beside several recordings: give each as (t, q, u, qd)")
        parts, end = [], 0.0
        for one in t:
            t, *rest = _columns(*one, drop=drop) if isinstance(one, (list, tuple)) else _columns(one, drop=drop)
            parts.append((t - t[0] + end, *rest))
            end = parts[-1][0][-1] + _BETWEEN * sampling_period(t)
        *columns, v = zip(*parts, strict=True)
        return *map(np.concatenate, columns), None if any(one is None for one in v) else np.concatenate(v)
    t, q, u, *v = columns_of(t, q, u, qd, drop=drop)
    if q.shape[1] != 1:
        raise InputError(f"q has {q.shape[1]} columns: fit_joint takes one joint; give q[:, i] and u[:, i]")
    return t, q[:, 0], u[:, 0], v[0][:, 0] if v else None


def _names_of(terms):
    """Names of the columns that these terms ask for, in the order of _COLUMNS."""
    terms = (terms,) if isinstance(terms, str) else tuple(terms)
    if not terms or not set(terms) <= set(TERMS):
        raise InputError(f"terms = {terms!r}: give some of {', '.join(TERMS)}")
    return tuple(name for name in _COLUMNS if name.split("_")[0] in terms)


def _is_measured(fits):
    """Whether u measured at the instant leaves clearly less of it than u held at any cut-off: noise may hide it."""
    left = np.array([[least_squares(one.A, u).rms for u in one.table.y.T] for one in fits])
    ratios = left[:, 1] / np.maximum(left[:, 0], 1e-300)
    return ratios.min() < min(_CLEARLY, 1 / ratios.max())


def _at_agreeing_cutoff(warned, joint, first, given):
    """The fit at the highest cut-off whose parameters agree with those at half of it; else a warning.

    first: Found at the highest; given: keep it, and only compare.
    """
    fits = [first, *joint.lower(first)]
    values, differing = [(one.x, one.stderr) for one in fits], None
    for k, (here, lower) in enumerate(pairwise(fits[:2] if given else fits)):
        moved = np.where(np.isfinite(here.stderr + lower.stderr), np.abs(here.x - lower.x), 0.0)
        wrong = moved > np.maximum(_AGREE * here.stderr, _MATTERS * np.abs(lower.x))
        far = [np.abs(here.x - x) > np.maximum(_FAR * np.abs(x), 3 * stderr) for x, stderr in values[k + 1 :]]
        wrong |= np.any(far, axis=0) & np.equal(here.names, "inertia")
        wrong &= [name in _COMPARED for name in here.names]
        if not wrong.any():
            return here if here is first else lower
        differing = here, lower, here.names[int(np.argmax(np.where(wrong, moved / here.stderr, 0.0)))]
    if differing is None:
        return first
    here, lower, name = differing
    each = ", ".join("{:.4g} +- {:.2g} at {:.3g} Hz".format(*one.value(name), one.cutoff_hz) for one in (here, lower))
    warned.add(f"{name} depends on the cut-off: {each} (flexibility, backlash, a late u); try a lower cutoff_hz")
    return first if given else lower


def _with_other_fits_in_errors(joint, found, fits, any_instant):
    """The same, its standard errors widened by what fits that are as good a choice change beyond their own errors.

    Lower cut-offs: flexibility, backlash. Twice the least speed: sticking, coarse angles. Any force of the position:
    gravity, ripple. The part of u that a dead zone of the amplifier keeps. Friction that is no line in the speed. Snap:
    flexibility in slow motion. A u that acts at another instant: by half a period with any_instant, else by 0.3, from
    which on a delay is warned of; less if the data tell.
    """
    faster = joint.fit(found.cutoff_hz, found.held, fewest=found, slower=2.0)
    pairs = [(one.x, one.stderr) for one in (*fits[1:], faster) if one is not None] + found.beside_forces(fits[-1])
    beyond = [np.where(np.isfinite(found.stderr + sigma), (found.x - x) ** 2 - sigma**2, 0.0) for x, sigma in pairs]
    moved = np.max([np.zeros(len(found.x)), *beyond], axis=0)  # squared
    periods, telling = (0.5, fits[-1:]) if any_instant else (0.3, fits[1:] or fits)
    late = found.moved_by_delay(periods / joint.rate, telling)
    return replace(found, stderr=np.sqrt(found.stderr**2 + moved + late**2 + (_EXACT * found.x) ** 2))


@dataclass(frozen=True)
class Found:
    """A fit at one cut-off: names, x and stderr (p,); the LeastSquares of A (m, r), the columns that the data hold.

    y (m,): u of the samples in the regression; table: their motion, as of `_Joint.table`.
    """

    names: tuple
    x: np.ndarray
    stderr: np.ndarray
    left: LeastSquares
    cutoff_hz: float
    held: bool
    table: SimpleNamespace
    y: np.ndarray
    A: np.ndarray

    @property
    def misfit(self):
        """Share of the amplitude of u that is left."""
        return self.left.rms / float(np.std(self.y))

    def value(self, name):
        """x and stderr of a parameter; 0 and inf where the data do not hold it, 0 and nan if it was not asked for."""
        known = by_name(self.names, self.x, self.stderr)
        return known.get(name, 0.0), known.get(f"{name}_stderr", math.nan)

    def beside(self, columns):
        """The same parameters beside more columns: x, stderr; of the last column value and error; the rms left."""
        known = np.isfinite(self.stderr)
        more = least_squares(np.column_stack([self.A, columns]), self.y, tolerance=_OWN_SHARE)
        x, stderr = np.zeros(len(known)), np.full(len(known), np.inf)
        x[known], stderr[known] = more.x[: known.sum()], more.stderr[: known.sum()]
        return x, stderr, float(more.x[-1]), float(more.stderr[-1]), more.rms

    @cached_property
    def late_column(self):
        """d(A x)/dt: what one second of delay adds to u, without the noise of du/dt."""
        terms = [(x, _COLUMNS.index(name)) for name, x in zip(self.names, self.x, strict=True) if name in _COLUMNS]
        return sum(x * self.table.rates[:, k] for x, k in terms)

    @cached_property
    def beside_delay(self):
        """`beside` a delay of u behind its record, s: u(t) is the model at t + delay, about A x + delay d(A x)/dt."""
        return self.beside(self.late_column)

    def moved_by_delay(self, unsure, fits):
        """(p,) by which a delay moves the parameters: 0 +- unsure s, and what the surest of `fits` tells of it.

        Noise of the acceleration hides a part of it, least at the lowest cut-off.
        """
        delay, sigma = min((one.beside_delay[2:4] for one in fits), key=lambda one: one[1])
        share = unsure**2 / (unsure**2 + sigma**2)
        size = math.hypot(share * delay, unsure * math.sqrt(1 - share))  # sigma may be inf
        moved = np.zeros(len(self.x))
        moved[np.isfinite(self.stderr)] = size * np.linalg.lstsq(self.A, self.late_column, rcond=None)[0]
        return moved

    def beside_forces(self, lowest):
        """[(x, stderr)] beside a polynomial of q, the sign of the u fitted, friction that bends, gravity, snap.

        Snap, the rate of the jerk, is what a flexible joint adds. Only in the `lowest` fit, at the lowest cut-off,
        it is not all noise. [] if there are too few samples.
        """
        if len(self.y) < 6 * (len(self.x) + _POLYNOMIAL):
            return []
        q, v = self.table.q - self.table.q.min(), self.table.v
        of_position = np.polynomial.legendre.legvander(2 * q / max(np.ptp(q), 1e-300) - 1, _POLYNOMIAL)[:, 1:]
        fitted = self.A @ self.left.x[np.isfinite(self.left.stderr)]  # the sign of u itself has its noise
        # Coulomb friction is like a dead zone; inertia has nothing of friction that bends
        fits = (of_position, _COMPARED), (np.sign(fitted), _COMPARED[:2]), (v * np.abs(v), _COMPARED[1:])
        fits = *fits, (self.table.columns[:, 1:3], (*_COMPARED, "offset"))
        pairs = [(*self.beside(columns)[:2], np.isin(self.names, names)) for columns, names in fits]
        pairs.append((*lowest.beside(lowest.table.snap)[:2], np.equal(self.names, "inertia")))
        return [(x, np.where(compared, stderr, np.inf)) for x, stderr, compared in pairs]


@dataclass(frozen=True)
class _Joint:
    """Evenly sampled runs of one joint, [(q or q and qd (n, 1 or 2), u held and u measured (n, 2))].

    band: what `spectrum` tells of its angle.
    """

    segments: list
    rate: float
    band: object
    terms: tuple

    @classmethod
    def of(cls, t, q, u, v, terms, delay, cutoff_hz):
        angles = np.column_stack([q] if v is None else [q, v])
        motion = process(t, angles, angles, cutoff_hz=None, trim=0.0, delay=delay)  # u: held and measured, below
        rate = motion.rate_hz
        if cutoff_hz is not None and number("cutoff_hz", cutoff_hz, "> 0", unit="Hz") >= rate / 2:
            raise InputError(f"cutoff_hz = {cutoff_hz!r}: give a number between 0 and half the rate, {rate / 2:.4g} Hz")
        drives = np.column_stack([np.interp(motion.t, acting_times(t, delay, held), u) for held in (True, False)])
        edges = np.flatnonzero(np.diff(motion.segment)) + 1
        segments = list(zip(np.split(motion.q, edges), np.split(drives, edges), strict=True))
        pieces = [x[:, -1] for x, _ in segments]
        return cls(segments, rate, spectrum(pieces, rate, cutoff_hz, of_speed=v is not None), terms)

    def lower(self, found):
        """Fits at half of its cut-off, a quarter and so on, as long as motion and samples last."""
        fits, cutoff_hz = [], found.cutoff_hz / 2
        while self.band.lowest_hz < cutoff_hz < math.inf:
            fits.append(self.fit(cutoff_hz, found.held, fewest=found))
            cutoff_hz /= 2
        return [one for one in fits if one is not None]

    def below_hum(self, found):
        """The same, or the fit at a lower cut-off that leaves far less of u: hum of the angle looks like motion."""
        if self.band.lowest_hz > found.cutoff_hz / 2:
            lower = self.fit(found.cutoff_hz / 2, found.held, fewest=found)
            if lower is not None and lower.misfit <= _HUM * found.misfit:
                return self.below_hum(lower)
        return found

    def fit(self, cutoff_hz, held=True, *, without=None, fewest=None, slower=1.0):
        """Found at this cut-off, of motion `slower` times as fast; None if not half of the time of `fewest` is left."""
        table = self.table(cutoff_hz, slower)
        m, least = len(table.q), checks.FEWEST // 2
        if fewest is not None and (m < least or m * fewest.cutoff_hz / cutoff_hz < 0.5 * len(fewest.y)):
            return None
        if m < least:
            raise IdentificationError(f"only {m} of {least} independent samples are in motion: record more of it")
        out = {without, "inertia"} if self.band.acceleration_share > _ALL_NOISE else {without}
        A = table.columns[:, [_COLUMNS.index(name) for name in self.terms]]
        A[:, [name in out for name in self.terms]] = 0.0  # an empty column: 0 +- inf
        solve = self._with_stribeck if "stribeck" in self.terms else self._solve
        return solve(table, 0 if held else 1, cutoff_hz, A)

    def _solve(self, table, column, cutoff_hz, A, more=()):
        """Found for u of this column of table.y; A: columns of the terms and of `more` names."""
        y = table.y[:, column]
        left = least_squares(A, y, tolerance=_OWN_SHARE)
        held_by_data = A[:, np.isfinite(left.stderr)]
        return Found((*self.terms, *more), left.x, left.stderr, left, cutoff_hz, column == 0, table, y, held_by_data)

    def _with_stribeck(self, table, column, cutoff_hz, A):
        """Least squares over all parameters and the Stribeck speed; its error from the slope of the column in it."""
        place = self.terms.index("stribeck")

        def columns(log_speed):
            A[:, place] = table.direction * np.exp(-((table.v / np.exp(log_speed)) ** 2))
            return A

        bounds = np.log(np.multiply(_PEAK, self.band.speed))
        starts = [[(start,)] for start in np.linspace(*bounds, 12)]
        (best,), c, _ = best_fit(lambda p: columns(*p), table.y[:, column], starts, bounds)
        A, speed = columns(best), math.exp(best)
        slope = c[place] * A[:, place] * 2 * table.v**2 / speed**3
        found = self._solve(table, column, cutoff_hz, np.column_stack([A, slope]), ["stribeck_speed"])
        return replace(found, x=np.where(np.equal(found.names, "stribeck_speed"), speed, found.x))

    def table(self, cutoff_hz, slower=1.0):
        """What goes into the regression, all through the same low pass.

        columns (m, 7), in the order of _COLUMNS, their rates of change (m, 7); y (m, 2): u held and measured; slopes
        (m, 2); extreme (m, 2): share of a sample's surroundings in which u has its smallest, its largest value; q (m,)
        rad; v (m,) rad/s; direction (m,).
        """
        slow = slower * max(4 * self.band.speed_noise, _DEAD * self.band.speed)
        every = np.concatenate([u[:, 0] for _, u in self.segments])
        low, high = every.min() + 1e-3 * np.ptp(every), every.max() - 1e-3 * np.ptp(every)
        edge = math.ceil(self.rate / cutoff_hz / 2)
        thin = max(1, int(self.rate / cutoff_hz / _OWN))
        parts = []
        for angles, drive in self.segments:
            n = len(drive)
            if n < 2 * edge + 20:  # too short for the filter
                continue
            v, a = self._derivatives(angles, cutoff_hz)
            turning, _ = self._derivatives(angles, max(cutoff_hz, self.band.sign_cutoff_hz))
            moving = np.abs(v) > (slow if edge or slower > 1 else 4 * self.band.unfiltered_noise)
            plain = [np.sign(turning), np.sin(angles[:, 0]), np.cos(angles[:, 0]), moving]
            plain = np.column_stack([*plain, drive, drive[:, 0] < low, drive[:, 0] > high]).astype(float)
            smooth = self._smooth(plain, cutoff_hz)
            direction, sin, cos, moving = smooth[:, :4].T
            columns = np.column_stack([np.ones(n), sin, cos, v, direction, np.zeros(n), a])  # as in _COLUMNS
            rates, slopes = (np.gradient(x, axis=0) * self.rate for x in (columns, smooth[:, 4:6]))
            snap = np.gradient(rates[:, -1]) * self.rate
            kept = np.arange(n)[edge : n - edge : thin]
            kept = kept[moving[kept] > 0.9]
            whole = columns, rates, smooth[:, 4:6], slopes, smooth[:, 6:], angles[:, 0], v, direction, snap
            parts.append([x[kept] for x in whole])
        names = ("columns", "rates", "y", "slopes", "extreme", "q", "v", "direction", "snap")
        joined = [np.concatenate(x) for x in zip(*parts, strict=True)] or [np.empty(0)] * len(names)
        return SimpleNamespace(**dict(zip(names, joined, strict=True)))

    def _smooth(self, x, cutoff_hz):
        return x if math.isinf(cutoff_hz) else low_pass(x, cutoff_hz, self.rate, order=_ORDER, kind="zero-phase")

    def _derivatives(self, angles, cutoff_hz):
        """qd, qdd (n,) behind the low pass, from five points: at 20 samples a second three are 1 % wrong."""
        x = self._smooth(angles[:, -1], cutoff_hz)  # q, or qd where it was measured
        x = np.pad(x, 2, mode="reflect", reflect_type="odd")
        back, before, here, after, ahead = (x[k : len(x) - 4 + k] for k in range(5))
        first = (8 * (after - before) - (ahead - back)) * (self.rate / 12)
        if angles.shape[1] == 2:
            return here, first
        return first, (16 * (after + before) - 30 * here - (ahead + back)) * (self.rate**2 / 12)
