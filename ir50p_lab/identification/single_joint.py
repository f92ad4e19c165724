"""One joint of any machine: inertia, viscous and Coulomb friction and offset from a recording."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import joint_checks as checks
from ir50p_lab.identification import signal_checks as signals
from ir50p_lab.identification.bandwidth import bandwidth
from ir50p_lab.identification.columns import columns_of, runs, sampling_period
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.regression import solve
from ir50p_lab.inputs import number
from ir50p_lab.signals.low_pass import low_pass

NAMES = ("inertia", "viscous", "coulomb", "offset")
_CLEARLY = 0.95  # of the residual of the other choice, below which u held or u measured explains the data better
_ORDER = 3  # of the low passes, forward and again backward
_OWN = 4.0  # samples per cut-off period that are kept for the regression: more would say the same again
_DEAD = 0.1  # of the rms speed, below which a joint may stick and a filtered speed has lost its sign
_ALL_NOISE = 0.3  # noise power over power of the acceleration from which on no inertia is given


@dataclass(frozen=True, kw_only=True)
class JointFit:
    """u = inertia qdd + viscous qd + coulomb sgn(qd) + offset, per joint; u in its own unit (N m, A, PWM counts...).

    ======================= ==================================================== ================
    field                   meaning                                              unit
    ======================= ==================================================== ================
    inertia                                                                      u s^2/rad
    viscous                                                                      u s/rad
    coulomb, offset                                                              u
    inertia_stderr ...      standard errors; inf: the data do not hold it, the   like the value
                            value is then 0
    rms                     of the residual                                      u
    fit                     100 (1 - |u - u_model|/|u - mean u|)                 %
    correlation             of neighbouring residuals: 0 for white noise
    cutoff_hz               of the low pass on q and u                           Hz
    delay, held             as used                                              s, bool
    samples                 used in the regression
    unidentifiable          names of parameters that the data do not hold
    warnings                tuple of str: what to mind about this fit
    ======================= ==================================================== ================
    """

    inertia: float
    viscous: float
    coulomb: float
    offset: float
    inertia_stderr: float
    viscous_stderr: float
    coulomb_stderr: float
    offset_stderr: float
    rms: float
    fit: float
    correlation: float
    cutoff_hz: float
    delay: float
    held: bool
    samples: int
    unidentifiable: tuple = ()
    warnings: tuple = ()

    @property
    def time_constant(self):
        """inertia/viscous, s: how fast the joint answers (nan unless both are positive)."""
        return self.inertia / self.viscous if self.inertia > 0 and self.viscous > 0 else math.nan


def fit_joint(t, q=None, u=None, *, cutoff_hz=None, delay=0.0, held=None):
    """Inertia, viscous and Coulomb friction and offset of one joint from a recording of it    (2.48, one joint)

        u = inertia qdd + viscous qd + coulomb sgn(qd) + offset

    q and u pass the same zero-phase low pass, and so does sgn(qd): the equation stays true, only noise is lost.
    Samples of a joint that stands are left out (there u may be anything up to the breakaway friction). Standard
    errors allow for residuals that are alike (Newey-West), and for half of what `held` makes of a parameter where the
    data do not tell which it is. They know nothing of a model that does not fit (`warnings` does, partly).

    Args:
        t: (n,) s, at any rate, with gaps if need be; or a recording of one joint (t, q, u).
        q: (n,) rad. u: (n,), torque, current or command, any unit.
        cutoff_hz: of the low pass; default: from the spectrum of q (`bandwidth`).
        delay: s from a sample to the moment its u acts.
        held: True: u is held from its sample to the next; False: it is a measurement at the instant; None: whichever
            explains the data better.

    Returns: JointFit.
    Raises: InputError for NaN, times that do not increase, shapes that do not fit. IdentificationError, saying what to
    do next, if the record is too short or constant, the motion drowns in noise or does not explain u, q or u were
    clipped, angles jump by whole turns, or inertia or all friction is negative. Other doubts are in `warnings`: angles
    that look like degrees, times that look like milliseconds, friction that falls with speed, a time constant below the
    sampling period, parameters that the motion does not show, gravity.
    """
    t, q, u = columns_of(t, q, u)
    if q.shape[1] != 1:
        raise InputError(f"q has {q.shape[1]} columns: fit_joint takes one joint; give q[:, i] and u[:, i]")
    if held is not None and not isinstance(held, (bool, np.bool_)):
        raise InputError(f"held = {held!r}: give True, False, or None to let the data choose")
    period = sampling_period(t)
    signals.refuse_bad_signals(t, q[:, 0], u[:, 0])
    band = _bandwidth(t, q[:, 0], period, cutoff_hz)
    checks.refuse_noise_only(band, q[:, 0])
    solution, table, held = _fitted(t, q, u, period, band, delay, held)
    checks.refuse_unexplained(solution, table)
    checks.refuse_clipped_drive(u[:, 0], table)
    checks.refuse_negative(solution, table, band, period)
    notes = [*signals.outliers("q", t, q[:, 0]), *signals.outliers("u", t, u[:, 0])]
    negative = (solution.x[0], solution.stderr[0]) if solution.x[0] < 0 else None
    if negative:
        solution = _solved(table, inertia=False)
    y = table.y
    spread = math.sqrt(np.mean((y - y.mean()) ** 2))
    values = dict(zip(NAMES, solution.x.tolist(), strict=True))
    errors = {f"{name}_stderr": value for name, value in zip(NAMES, solution.stderr.tolist(), strict=True)}
    return JointFit(
        **values,
        **errors,
        rms=solution.rms,
        fit=100 * (1 - solution.rms / spread),
        correlation=solution.correlation,
        cutoff_hz=band.cutoff_hz,
        delay=float(delay),
        held=held,
        samples=len(y),
        unidentifiable=tuple(NAMES[j] for j in solution.dropped),
        warnings=(*notes, *checks.doubts(q[:, 0], u[:, 0], solution, table, band, period, negative)),
    )


@dataclass(frozen=True)
class Table:
    """What goes into the regression, all through the same low pass.

    A (m, 4) and y (m,); slope (m,): of y, u/s; q (m,) rad; extreme (m, 2): share of the surroundings of a sample in
    which u has its smallest, its largest value; fastest: rad/s.
    """

    A: np.ndarray
    y: np.ndarray
    slope: np.ndarray
    q: np.ndarray
    extreme: np.ndarray
    fastest: float


def _bandwidth(t, q, period, cutoff_hz):
    """Bandwidth of the runs without a gap."""
    parts = runs(t, 3.5 * period)
    longest = max(last - first for first, last in parts)
    if longest < signals.FEWEST:
        raise IdentificationError(
            f"the longest of the runs without a gap has {longest} samples; at least {signals.FEWEST} are needed: "
            "record in one piece"
        )
    pieces = []
    for first, last in parts:
        grid = t[first] + period * np.arange(math.floor((t[last - 1] - t[first]) / period + 1e-6) + 1)
        pieces.append(np.interp(grid, t[first:last], q[first:last]))
    if cutoff_hz is not None and number("cutoff_hz", cutoff_hz, "> 0", unit="Hz") >= 0.5 / period:
        raise InputError(f"cutoff_hz = {cutoff_hz!r}: give a number between 0 and half the rate, {0.5 / period:.4g} Hz")
    return bandwidth(pieces, 1 / period, cutoff_hz)


def _fitted(t, q, u, period, band, delay, held):
    """(Solution, Table, held): where `held` is None, of the choice that explains the data better.

    Where neither clearly does, half of the difference between the two goes into the standard errors.
    """
    if held is not None:
        return *_fit(t, q, u, period, band, delay, bool(held)), bool(held)
    (one, as_held), (other, measured) = (_fit(t, q, u, period, band, delay, choice) for choice in (True, False))
    as_smooth = np.pad(u, ((1, 1), (0, 0)), mode="edge")  # taking u between two samples takes noise from it: so here
    as_smooth = (as_smooth[:-2] + 6 * as_smooth[1:-1] + as_smooth[2:]) / 8
    fair, _ = _fit(t, q, as_smooth, period, band, delay, False)
    if one.rms < _CLEARLY * fair.rms:
        return one, as_held, True
    if fair.rms < _CLEARLY * one.rms:
        return other, measured, False
    unsure = np.hypot(one.stderr, np.abs(one.x - other.x) / 2)
    return replace(one, stderr=unsure), as_held, True


def _fit(t, q, u, period, band, delay, held):
    """Filtered regression: (Solution, Table)."""
    whole = process(t, q, u, cutoff_hz=None, trim=0.0, delay=delay, held=held)  # even grid, u at its instant
    rate, cutoff = 1 / period, band.cutoff_hz
    slow = max(4 * band.speed_noise, _DEAD * band.speed)
    low, high = u.min() + 1e-3 * np.ptp(u), u.max() - 1e-3 * np.ptp(u)
    edge = math.ceil(rate / cutoff / 2)
    thin = max(1, int(rate / cutoff / _OWN))
    rows, fastest = [np.empty((0, 9))], 0.0
    for segment in np.unique(whole.segment):
        here = whole.segment == segment
        if here.sum() < 2 * edge + 30:  # too short for the filter
            continue
        angle, drive = whole.q[here, 0], whole.u[here, 0]
        v, a = _derivatives(angle, rate, cutoff)
        turning, _ = _derivatives(angle, rate, band.sign_cutoff_hz)
        plain = np.column_stack([np.sign(turning), np.abs(v) > slow, drive, drive < low, drive > high])
        smooth = low_pass(plain.astype(float), cutoff, rate, order=_ORDER, kind="zero-phase")
        direction, moving, y = smooth[:, 0], smooth[:, 1], smooth[:, 2]
        table = np.column_stack([a, v, direction, np.ones_like(v), y, np.gradient(y) * rate, angle, smooth[:, 3:]])
        inside = np.zeros(len(v), dtype=bool)
        inside[edge : len(v) - edge : thin] = True
        rows.append(table[inside & (moving > 0.9)])
        fastest = max(fastest, float(np.abs(v).max()))
    x = np.concatenate(rows)
    checks.refuse_too_little_motion(len(x), len(t))
    table = Table(A=x[:, :4], y=x[:, 4], slope=x[:, 5], q=x[:, 6], extreme=x[:, 7:], fastest=fastest)
    return _solved(table, inertia=band.acceleration_share <= _ALL_NOISE), table


def _solved(table, *, inertia=True):
    A = table.A if inertia else table.A * [0.0, 1.0, 1.0, 1.0]
    return solve(A, table.y, drop_first=(0, 2, 1))


def _derivatives(q, rate, cutoff_hz):
    """qd, qdd (n,) of q (n,) behind the low pass, from five points: at 20 samples a second three are 1 % wrong."""
    q = np.pad(low_pass(q, cutoff_hz, rate, order=_ORDER, kind="zero-phase"), 2, mode="reflect", reflect_type="odd")
    back, before, here, after, ahead = (q[k : len(q) - 4 + k] for k in range(5))
    qd = (8 * (after - before) - (ahead - back)) * (rate / 12)
    return qd, (16 * (after + before) - 30 * here - (ahead + back)) * (rate**2 / 12)
