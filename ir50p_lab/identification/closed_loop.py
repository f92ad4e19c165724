"""The closed loop of a run, simulated with a model in place of the arm: what output-error fits compare with."""

import numpy as np

from ir50p_lab.controllers.base import check_reference, is_compiled
from ir50p_lab.errors import InputError
from ir50p_lab.identification.columns import columns_of, sampling_period
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.modelling.dynamics import STANDARD_GRAVITY
from ir50p_lab.simulation.loops import sampled_loop
from ir50p_lab.simulation.plant import DRY, FS, LIMIT, QS, make_plant
from ir50p_lab.simulation.simulate import sampled

_STILL = 5  # first samples, of which the mean is the start: the arm has hardly moved by then
_LIMIT = 255.0  # PWM counts, of |u|


class ClosedLoopRun:
    """A recording with what is needed to repeat it in simulation; arguments as in `output_error`.

    Attributes: t (m,), q, u (m, 3), the reference r (m, 3, 3), the pose at the start (3,), period, s.
    """

    def __init__(self, recording, controller, reference=None, *, delay=0.0, seconds=np.inf):
        t, q, u = columns_of(recording)
        period = sampling_period(t)
        n = int(min(len(t), np.round(number("seconds", seconds, "> 0 or inf", unit="s") / period)))
        if q.shape[1] != 3 or n < 50:
            raise InputError(f"{n} samples of {q.shape[1]} joint(s): give 50 or more of all three joints")
        if np.abs(np.diff(t) - period).max() > 0.1 * period:
            raise InputError("the times are uneven or have gaps: a loop is compared without; cut with between(t0, t1)")
        if not is_compiled(controller):
            raise InputError(f"controller is a {type(controller).__name__}: give the PID (or other) of the run")
        if reference is None:
            rows = _recorded_reference(recording, period)
        else:
            check_reference(reference, sampled=True)
            rows = sampled(reference, t)
        self.t, self.q, self.u, self.r = (x[:n] for x in (t, q, u, rows))
        self.start, self.period, self.controller = q[:_STILL].mean(axis=0), period, controller
        self.late = round(number("delay", delay, ">= 0", unit="s") / period)

    def simulate(self, theta, fs=None, qs=None, *, step=0.001):
        """q and u (PWM), (m, 3) each, of the loop with this model; fs, qs (3,): breakaway and Stribeck speed."""
        plant = make_plant(theta, unit="PWM", g=STANDARD_GRAVITY)
        plant.numbers[LIMIT : LIMIT + 3] = _LIMIT
        if fs is not None:
            plant.numbers[FS : FS + 3], plant.numbers[QS : QS + 3] = fs, qs
            plant.numbers[DRY] = 1.0
        law = self.controller.kind, self.controller.parameters, np.zeros_like(self.controller.state)
        x, (q, qd, u) = np.r_[self.start, 0.0, 0.0, 0.0], np.empty((3, *self.q.shape))
        steps = max(1, round(self.period / step))
        h = self.period / steps
        sampled_loop(plant.theta, plant.numbers, *law, self.t, self.r, x, self.late, h, steps, q, qd, u)
        return q, u


def _recorded_reference(recording, period):
    angles = getattr(recording, "reference", None)
    if angles is None:
        raise InputError("the recording holds no reference: give reference=, the motion that was asked for")
    angles = vectors3("reference of the recording", angles)
    qd = np.gradient(angles, period, axis=0)
    return np.ascontiguousarray(np.stack([angles, qd, np.gradient(qd, period, axis=0)], axis=1))


def runs_of(recordings, controller, references=None, **options):
    """ClosedLoopRuns of a recording or a list; a motion for all or each; options as of `ClosedLoopRun`."""
    recordings = list(recordings) if isinstance(recordings, (list, tuple)) else [recordings]
    if not isinstance(references, (list, tuple)):
        references = [references] * len(recordings)
    if not recordings or len(references) != len(recordings):
        raise InputError(f"{len(recordings)} recordings and {len(references)} references: give one for each")
    pairs = zip(recordings, references, strict=True)
    return [ClosedLoopRun(recording, controller, reference, **options) for recording, reference in pairs]
