"""A motion tried in simulation before the arm makes it: how much of u a rigid-body model can explain afterwards."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.validation import validate
from ir50p_lab.inputs import check_arm, check_controller, number, numbers
from ir50p_lab.modelling.dynamics import as_theta
from ir50p_lab.signals.fourier import heights

_SLOW = 0.1  # rad/s: about where a dry joint may stick


@dataclass(frozen=True, kw_only=True, eq=False)
class SimulatedIdentification:
    """What `simulate_identification` found, per joint (3,).

    fit: best fit in % of the commands that a model without sticking can reach on such a run; spread: standard deviation
    of u; standing: share of time near standstill, 1/(1 + (qd/0.1 rad/s)^2), 0 to 1; q: (n, 3) rad, as it was followed;
    room: (3,) rad to the nearer joint limit; height: m of elbow or tip over the table, whichever is lower.
    """

    fit: np.ndarray
    spread: np.ndarray
    standing: np.ndarray
    q: np.ndarray
    room: np.ndarray
    height: float

    def worth(self, floor=(90.0, 92.0, 93.0), *, room=0.05, height=0.03):
        """Least distance of any joint's fit from a floor, in %: the larger, the better the motion.

        -inf if the run comes nearer than `room` (rad) to a joint limit or `height` (m) to the table: there the bench
        cuts the drive, or the table pushes, and no model of the arm explains u.
        """
        if (self.room < room).any() or self.height < height:
            return -np.inf
        return float((self.fit - np.asarray(floor, dtype=float)).min())


def simulate_identification(
    reference, arm, controller, *, model=None, noise=5.0, seconds=None, table=0.0, cutoff_hz=1.2, sign=0.05
):
    """Simulate the closed loop on a motion, and say how much of u a rigid-body model could explain afterwards.

    An optimised motion is not the one that the arm makes: a weak controller lags and sags under gravity, and a joint
    that hardly moves sticks, where u may be anything up to the breakaway friction. The model may be rough: an Arm with
    assumed masses and friction, or a first estimate. No noise is drawn; `noise` is added to what is left as its root
    sum of squares.

    Args:
        reference: Fourier, or any Reference that begins at rest. arm: Arm with actuators; its lengths and limits count.
        controller: as for the run. model: Estimate or theta (3, 20) in PWM counts in place of the arm's masses.
        noise: PWM counts rms in u, one number or (3,). seconds: s, default two periods. table: its height, m.
        cutoff_hz, sign: as in `validate`.

    Returns: SimulatedIdentification. Raises InputError on bad input, or if the loop runs away.
    """
    from ir50p_lab.simulation import simulate

    if not hasattr(reference, "sample"):
        raise InputError(f"reference is a {type(reference).__name__}: give a motion such as `fourier` makes")
    noise = numbers("noise", noise, unit="PWM")
    check_arm(arm)
    check_controller(controller)
    theta = arm.theta_pwm if model is None else as_theta(getattr(model, "theta", model))[0]
    if seconds is None:
        seconds = 2 * getattr(reference, "period", 0.5 * getattr(reference, "duration", np.inf))
    if number("seconds", seconds, "> 0", unit="s") < 2:
        raise InputError(f"seconds = {seconds}: give a finite length of 2 s or more")
    run = simulate(
        arm if model is None else theta,
        controller,
        reference,
        duration=seconds,
        q0=reference.sample(np.zeros(1))[0, 0],
        unit="PWM",
    )
    found = validate(theta, run.t, run.q, run.u, sign=sign, cutoff_hz=cutoff_hz)
    return SimulatedIdentification(
        fit=100 * (1 - np.hypot(found.rms, noise) / found.spread),
        spread=found.spread,
        standing=np.mean(1 / (1 + (run.qd / _SLOW) ** 2), axis=0),
        q=run.q,
        room=np.minimum(run.q - arm.q_min, np.array(arm.q_max) - run.q).min(axis=0),
        height=float(np.min(heights(arm.l, run.q)) - table),
    )
