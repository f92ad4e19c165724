"""Will the motors follow? The command a motion needs, from the model alone, against the limit of the drive."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.controllers.model_based import LIMIT_PWM, model_in_unit
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.dynamics import inverse_dynamics
from ir50p_lab.signals.reference import per_joint

_SLOWEST = 1000.0  # times as slow: as good as standing


@dataclass(frozen=True)
class Saturation:
    """What a motion asks of the drives, if it were followed exactly.

    t (n,) s; u (n, 3) command needed; limit (3,), both in `unit`; use (3,): the largest share of the limit that each
    joint needs (above 1: it saturates); saturates; first: s of the first sample beyond the limit (None: none);
    stretch: how many times slower the same path must be for it to fit (below 1: it may be that much faster; inf:
    even holding its poses is too much).
    """

    t: np.ndarray
    u: np.ndarray
    limit: np.ndarray
    unit: str
    use: np.ndarray
    saturates: bool
    first: float | None
    stretch: float

    def __str__(self):
        shares = ", ".join(f"{100 * x:.0f} %" for x in self.use)
        if not self.saturates:
            return f"fits: joints 1 to 3 need {shares} of the limit; could run in {self.stretch:.2f} of the time"
        slower = f"{self.stretch:.2f} times slower it fits" if math.isfinite(self.stretch) else "not even slowly"
        return f"saturates from t = {self.first:.2f} s: joints 1 to 3 need {shares} of the limit; {slower}"


def check_saturation(model, reference, seconds=None, *, limit=None, period=0.01, g=None):
    """Predict from the motors' limits whether a motion can be followed    (4.4.2: 'the motors velocities are limited').

    The command needed is inverse dynamics along the reference; with back-EMF in the viscous terms of a model in PWM
    counts this holds the speed limit of the motors too. Slower by a factor c: qd/c and qdd/c^2 at the same poses.

    Args:
        model: Arm with actuators (in PWM counts, its own limit), Estimate (255 counts if in PWM), or a theta.
        reference: as from `signals`, with `sample`. seconds: how long to look; default its duration (if finite).
        limit: (3,) or one number, unit of the model; needed for a theta or a model in N m.
        period: s between samples. g: of a theta, m/s^2.

    Returns: Saturation. Raises InputError on bad arguments; ArmError for an Arm without actuators.
    """
    in_pwm = isinstance(model, Arm) and limit is None
    theta, gravity, unit, bound = model_in_unit(model, LIMIT_PWM if in_pwm else None, g=g)
    if in_pwm:
        limit = model.actuators.limit_pwm
    elif limit is None:
        limit = bound
    if limit is None:
        raise InputError("limit = None: say how much the drives can give, in the unit of the model")
    limit = np.array(per_joint("limit", limit, "> 0", unit=unit))
    if not hasattr(reference, "sample"):
        raise InputError(f"reference = {reference!r}: give a reference of `signals`, such as quintic(...)")
    seconds = reference.duration if seconds is None else seconds
    number("seconds", seconds, "> 0", unit="s", hint="a motion without end needs `seconds`")
    t = np.arange(math.floor(seconds / number("period", period, "> 0", unit="s") + 1e-9) + 1) * period
    q, qd, qdd = reference.sample(t).transpose(1, 0, 2)

    def needed(slower):
        return inverse_dynamics(theta, q, qd / slower, qdd / slower**2, g=gravity)

    u = needed(1.0)
    beyond = (np.abs(u) > limit).any(axis=1)
    quickest, slowest = 1 / _SLOWEST, _SLOWEST
    while slowest / quickest > 1 + 1e-6:
        middle = math.sqrt(quickest * slowest)
        if (np.abs(needed(middle)) <= limit).all():
            slowest = middle
        else:
            quickest = middle
    return Saturation(
        t=t,
        u=u,
        limit=limit,
        unit=unit,
        use=np.abs(u).max(axis=0) / limit,
        saturates=bool(beyond.any()),
        first=float(t[np.argmax(beyond)]) if beyond.any() else None,
        stretch=slowest if slowest < _SLOWEST else math.inf,
    )
