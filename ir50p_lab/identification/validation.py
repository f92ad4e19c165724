"""How good an identified model is on data it has not seen: as Table 4.4 on raw PWM, simulated, and by its residuals."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.columns import columns_of, sampling_period
from ir50p_lab.identification.processing import process
from ir50p_lab.inputs import check_controller, check_reference, choice, number, numbers, switch
from ir50p_lab.modelling.dynamics import as_theta


@dataclass(frozen=True, kw_only=True, eq=False)
class Validation:
    """Measured against predicted, joint by joint.

    ========== ================================================================================== ======
    rms        of measured - predicted; unit of u, or rad for q                                   (3,)
    fit        100 (1 - |measured - predicted|/|measured - mean|) %, the fit of Table 4.4         (3,)
    spread     standard deviation of what was measured: rms/(1 - fit/100)                         (3,)
    t          of the samples compared, s                                                         (n,)
    measured   u of the recording as it stands, or q                                              (n, 3)
    predicted  by the model                                                                       (n, 3)
    of         "u" or "q"
    ========== ================================================================================== ======
    """

    rms: np.ndarray
    fit: np.ndarray
    spread: np.ndarray
    t: np.ndarray
    measured: np.ndarray
    predicted: np.ndarray
    of: str

    @property
    def residuals(self):
        """measured - predicted, (n, 3)."""
        return self.measured - self.predicted

    def __str__(self):
        rms, fit = (" / ".join(f"{x:.3g}" for x in values) for values in (self.rms, self.fit))
        return f"{self.of}: RMS {rms}, fit {fit} %"


def nrmse_fit(measured, predicted):
    """RMS error and fit of each column    (Table 4.4).

    fit = 100 (1 - |y - y_p|/|y - mean y|): 100 is perfect, 0 no better than the mean, below 0 worse than that. It is
    not R^2: a fit of 70 % leaves 30 % of the amplitude, which is 9 % of the variance.

    Args: measured, predicted: (n,) or (n, k). Returns: (rms, fit), numbers or (k,). Raises InputError on shapes that
    differ, numbers that are not finite, or a measured column that never changes.
    """
    y, p = (numbers(name, x) for name, x in (("measured", measured), ("predicted", predicted)))
    if y.shape != p.shape or y.ndim not in (1, 2) or len(y) < 2:
        raise InputError(f"measured {y.shape} and predicted {p.shape}: give two arrays of one shape, (n,) or (n, k)")
    for name, x in (("measured", y), ("predicted", p)):
        if not np.isfinite(x).all():
            raise InputError(f"{name} holds numbers that are not finite: remove those samples from both")
    spread = np.sqrt(np.mean((y - y.mean(axis=0)) ** 2, axis=0))
    if np.any(spread <= 1e-12 * np.abs(y).max(axis=0)):
        raise InputError("a measured column never changes: the fit has no meaning there; leave that joint out")
    rms = np.sqrt(np.mean((y - p) ** 2, axis=0))
    return rms, 100 * (1 - rms / spread)


def validate(estimate, recording, q=None, u=None, *, delay=0.0, held=True, sign=None, g=9.81, **steps):
    """Predict the u of another recording from its angles, one sample at a time    (4.5), Table 4.4.

    The u of the recording is taken raw, as it was sent. The prediction is made from q, qd and qdd as `process` finds
    them, and read at the time at which each u acted: its sample + delay (+ half a period while it is held).

    Args: estimate: Estimate or theta (3, 20); recording, or t, q, u; delay, held, and further steps (derivatives=,
    cutoff_hz=, order=, trim=, max_gap=): as in `process`; sign, g: as in `regressor`.
    Returns: Validation of "u". Raises InputError, IdentificationError as `process` does.
    """
    for name in ("decimate", "slow", "filter_u"):
        if name in steps:
            raise InputError(f"{name} is no step of a validation: every raw u counts; leave it out")
    theta, t, q, u = _inputs(estimate, recording, q, u)
    motion = process(t, q, u, held=False, **steps)
    Phi = regressor(motion.q, motion.qd, motion.qdd, g=g, sign=sign)
    predicted = np.einsum("nij,ij->ni", Phi, theta)
    later = switch("held", held) and steps.get("derivatives", "zero-phase") == "zero-phase"
    acts = t + _seconds("delay", delay) + (0.5 * np.diff(t, append=t[-1] + sampling_period(t)) if later else 0.0)
    kept, found = [], []
    for segment in np.unique(motion.segment):
        here = motion.segment == segment
        inside = (acts >= motion.t[here][0]) & (acts <= motion.t[here][-1])
        kept.append(np.flatnonzero(inside))
        found.append(np.column_stack([np.interp(acts[inside], motion.t[here], p) for p in predicted[here].T]))
    kept = np.concatenate(kept)
    return _result(t[kept], u[kept], np.concatenate(found), "u")


def validate_ahead(estimate, recording, q=None, u=None, *, horizon=1.0, delay=0.0, unit="PWM", g=9.81, **steps):
    """Simulate stretches of `horizon` seconds under the recorded u, from the measured state, and compare the angles.

    Errors add up as time goes on, as they do when a model is simulated; at each start they are put back to zero. A
    joint that integrates its errors cannot be simulated for a whole record without a controller: see
    `validate_closed_loop`.

    Args: horizon: s; unit: of u, 'PWM' or 'N m'; others as in `validate`. Returns: Validation of "q" against the
    measured angles. Raises InputError, IdentificationError as `process` does.
    """
    from ir50p_lab.simulation import simulate

    theta, t, q, u = _inputs(estimate, recording, q, u)
    choice("unit", unit, ("PWM", "N m"))
    g = number("g", g, ">= 0", unit="m/s^2")
    motion = process(t, q, u, delay=_seconds("delay", delay), held=True, **steps)
    period = 1 / motion.rate_hz
    count = round(_seconds("horizon", horizon) / period)
    if count < 2:
        raise InputError(f"horizon = {horizon} s is less than two samples of {period:.4g} s: give a longer one")
    times, measured, predicted = [], [], []
    for segment in np.unique(motion.segment):
        here = np.flatnonzero(motion.segment == segment)
        for first in range(here[0], here[-1] - count, count):
            start = motion.t[first] - delay
            drive = u[np.clip(np.searchsorted(t, start + period * np.arange(count + 1) + 1e-9) - 1, 0, None)]
            run = simulate(
                theta,
                _Replay(drive, period, unit),
                duration=count * period,
                period=period,
                step=period / max(1, round(period / 0.002)),
                q0=motion.q[first],
                qd0=motion.qd[first],
                unit=unit,
                g=g,
            )
            times.append(motion.t[first : first + count])
            measured.append(np.column_stack([np.interp(times[-1], t, x) for x in q.T]))
            predicted.append(run.q[:count])
    if not times:
        raise IdentificationError(f"no stretch of {horizon} s without a gap is left: give a shorter horizon")
    return _result(np.concatenate(times), np.concatenate(measured), np.concatenate(predicted), "q")


def validate_closed_loop(estimate, recording, controller, reference, *, delay=0.0, unit="PWM", g=9.81):
    """Simulate the whole closed loop with the model in place of the arm, and compare angles and commands.

    The strictest test: controller, reference, start and delay are those of the recording, nothing else is.

    Args:
        estimate: Estimate or theta (3, 20). recording: evenly sampled, with t, q, u.
        controller, reference: those of the run. delay: s from a sample to the moment its command acts; rounded to
        whole periods. unit: of u, 'PWM' or 'N m'. g: m/s^2.

    Returns: (Validation of "q", Validation of "u"). Raises InputError on bad input or uneven times, or if the
    simulated loop runs away.
    """
    from ir50p_lab.simulation import simulate

    theta, t, q, u = _inputs(estimate, recording, None, None)
    choice("unit", unit, ("PWM", "N m"))
    g = number("g", g, ">= 0", unit="m/s^2")
    check_controller(controller)
    check_reference(reference)
    period = sampling_period(t)
    if np.abs(np.diff(t) - period).max() > 0.1 * period:
        raise InputError("the times are uneven or have gaps: a loop must be compared without; cut the recording")
    late = round(_seconds("delay", delay) / period)
    run = simulate(
        theta,
        _Delayed(controller, late) if late else controller,
        _Shifted(reference, t[0]),
        duration=(len(t) - 1) * period,
        period=period,
        step=period / max(1, round(period / 0.001)),
        q0=q[0],
        unit=unit,
        g=g,
    )
    commands = run.u if not late else np.vstack([run.u[late:], np.tile(run.u[-1], (late, 1))])
    n = len(t) - late
    return _result(t, q, run.q[: len(t)], "q"), _result(t[:n], u[:n], commands[:n], "u")


class _Replay:
    """A controller that knows only what was sent."""

    def __init__(self, u, period, unit):
        self.u, self.period, self.unit = u, period, unit

    def step(self, t, measured, reference):
        return self.u[min(round(t / self.period), len(self.u) - 1)]


class _Delayed:
    """A controller whose commands come some periods late; before the first, nothing is driven."""

    def __init__(self, controller, periods):
        self.controller, self.periods = controller, periods
        self.unit = getattr(controller, "unit", "PWM")
        self.reset()

    def reset(self):
        if hasattr(self.controller, "reset"):
            self.controller.reset()
        self._queue = [np.zeros(3)] * self.periods

    def step(self, t, measured, reference):
        self._queue.append(np.array(self.controller.step(t, measured, reference), dtype=float))
        return self._queue.pop(0)


class _Shifted:
    """A reference as the recording saw it: its time began at t0."""

    def __init__(self, reference, t0):
        self.reference, self.t0 = reference, float(t0)

    def __call__(self, t):
        return self.reference(t + self.t0)


def _inputs(estimate, recording, q, u):
    theta, _ = as_theta(getattr(estimate, "theta", estimate) if not hasattr(estimate, "m") else estimate)
    t, q, u = columns_of(recording, q, u)
    if q.shape[1] != 3:
        raise InputError(f"q has {q.shape[1]} columns: validation needs the three joints, (n, 3)")
    return theta, t, q, u


def _seconds(name, value):
    return number(name, value, ">= 0", unit="s")


def _result(t, measured, predicted, of):
    rms, fit = nrmse_fit(measured, predicted)
    spread = measured.std(axis=0)
    return Validation(rms=rms, fit=fit, spread=spread, t=t, measured=measured, predicted=predicted, of=of)
